// Joints: how two bodies are held together.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/joints/grab_spring.h"

#include <array>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct JointId {
    std::uint32_t index = UINT32_MAX;
    std::uint32_t generation = 0;
    friend auto operator<=>(const JointId &, const JointId &) = default;
};

struct JointLimits {
    Real lower = Real(0); // rad or m
    Real upper = Real(0); // >= lower
};
// Drives towards `speed` with at most `max_force`.
struct JointMotor {
    Real speed = Real(0);     // rad/s or m/s
    Real max_force = Real(0); // N m or N, >= 0
};

// Accumulated impulses of a joint's rows (N s or N m s), in row order (joint_rows.h).
inline constexpr std::size_t joint_row_count = 8;
struct JointMemory {
    std::array<Real, joint_row_count> impulses{};
    bool broken = false; // holds nothing any more
};

// The same rows' penalty stiffness under an augmented Lagrangian method (penalty.h; N/m, N m/rad).
using JointPenalty = std::array<Real, joint_row_count>;

struct JointDef {
    JointType type = JointType::ball;
    BodyId a; // a default BodyId is the world itself; its anchor and frame are in world coordinates
    BodyId b;
    Vec3 anchor_a_local{Real(0)}; // in the bodies' own frames
    Vec3 anchor_b_local{Real(0)};
    // x is the axis of a hinge or slider, whose angle or position is 0 where the frames agree.
    Quat frame_a_local = identity_rotation;
    Quat frame_b_local = identity_rotation;
    Real min_length =
        Real(0); // m; distance joints: a rod has min == max, a rope has 0 and its length
    Real max_length = Real(0);         // > 0
    std::optional<JointLimits> limits; // hinge (within -pi..pi) and slider
    std::optional<JointMotor> motor;   // hinge and slider
    // Hz; above 0 the joint's own rows act as a spring and damper (Catto 2011, "Soft Constraints").
    Real frequency = Real(0);
    Real damping_ratio = Real(1);
    Real break_force = Real(0); // N, on the rows that hold the anchors; 0: never
    bool collide_connected = false;
    JointMemory memory;
    JointPenalty penalty{};
};

// A joint in the model. Anchors and frames are in the mass frames (Body).
struct Joint {
    static constexpr std::uint32_t world = UINT32_MAX;
    JointType type = JointType::ball;
    std::uint32_t a = world; // index of the body
    std::uint32_t b = world;
    Vec3 anchor_a_local{Real(0)};
    Vec3 anchor_b_local{Real(0)};
    Quat frame_a_local = identity_rotation;
    Quat frame_b_local = identity_rotation;
    Real min_length = Real(0);
    Real max_length = Real(0);
    std::optional<JointLimits> limits;
    std::optional<JointMotor> motor;
    Real frequency = Real(0);
    Real damping_ratio = Real(1);
    Real break_force = Real(0);
    bool collide_connected = false;
    std::uint32_t generation = 0;
    bool alive = false;
};

// A hand that pulls a body's point, or a particle, towards a target with a damped spring of at most
// `max_force`. Part of the state: only commands change it.
struct Grab {
    std::uint32_t body = UINT32_MAX;     // none: no body is held
    std::uint32_t particle = UINT32_MAX; // none: no particle is held
    Vec3 point_local{Real(0)};           // in the mass frame
    Vec3 target{Real(0)};                // world
    Real max_force = Real(0);            // N
    Real frequency = Real(0);            // of the GrabSpring (Hz)
    Real damping_ratio = Real(0);        // of the GrabSpring
    Vec3 impulse{Real(0)};               // accumulated by the solver (N s); bodies only
    // A held particle counts as the mass of everything its springs connect to (kg).
    Real held_mass = Real(0);

    bool is_holding() const { return body != UINT32_MAX; }
    bool holds_particle() const { return particle != UINT32_MAX; }
};

// A grab that holds nothing yet. Throws unless every value is finite and the spring is valid.
Grab grab_of(const Vec3 &target, Real max_force, const GrabSpring &spring);

} // namespace plumb::inline PLUMB_PRECISION
