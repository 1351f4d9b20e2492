// A joint of a scene as plain values. SI units, radians.
#pragma once

#include "engine/dynamics/kinds.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// Most constraint rows a joint can have, and so most impulses the solver keeps for it.
inline constexpr std::size_t max_joint_rows = 8;

// Holds body b to body a. An empty body name means the world; its anchor and frame are then in
// world coordinates. Each type reads only the fields it needs.
struct JointDesc {
    std::string name;
    JointType type = JointType::ball;
    std::string body_a;
    std::string body_b;
    glm::dvec3 anchor_a_local{0};
    glm::dvec3 anchor_b_local{0};
    // Unit. Their x axes are the hinge's or slider's axis; its angle or position is 0 where the
    // frames (for a slider, the anchors too) coincide. A fixed joint keeps them aligned.
    glm::dquat frame_a_local{1, 0, 0, 0};
    glm::dquat frame_b_local{1, 0, 0, 0};
    // distance: between the anchors (m). A rod has min = max, a rope a min_length of 0.
    double min_length = 0;
    double max_length = 0;
    std::optional<std::array<double, 2>> limits; // hinge: rad, slider: m; lower <= upper
    // hinge: rad/s and N m, slider: m/s and N. The motor is on when it has a speed.
    std::optional<double> motor_speed;
    double max_motor_force = 0;
    // Makes the joint's own rows a spring (for a distance joint, at that rest length); limits and
    // motor are unaffected. Hz; 0: rigid.
    double frequency = 0;
    double damping_ratio = 1;
    double break_force = 0;         // N, on the rows that hold the anchors; 0: never breaks
    bool collide_connected = false; // whether the two bodies also collide with each other
    // State: accumulated impulses (N s, angular rows N m s), in row order.
    std::array<double, max_joint_rows> impulses{};
    // State: penalty stiffness of the same rows (N/m, N m/rad), for methods that keep penalties.
    std::array<double, max_joint_rows> penalties{};
    bool broken = false; // state: no longer holds anything
};

} // namespace plumb
