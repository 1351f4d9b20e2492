// A snapshot of a simulation's visible state, as flat arrays of plain values in double: what the
// app blends and draws, and the lab measures.
#pragma once

#include "engine/dynamics/kinds.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace plumb {

struct BodyState {
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
    glm::dvec3 velocity{0};
    glm::dvec3 angular_velocity{0}; // world
    bool asleep = false;            // at rest, and not stepped
};

struct ParticleState {
    glm::dvec3 position{0};
    glm::dvec3 velocity{0};
};

struct ContactView {
    std::size_t body_a = 0;
    std::size_t body_b = 0;
    std::size_t child_a = 0; // which collider of each body, as in BodyInfo
    std::size_t child_b = 0;
    // Index in the mesh or height field, if one of the colliders is one.
    std::optional<std::size_t> triangle;
    // Feature id: identifies the pair of features that made the point, for as long as they last.
    // Unique only within one contact.
    std::uint32_t feature = 0;
    bool is_sensor = false;       // either collider is: no forces
    glm::dvec3 position{0};       // world
    glm::dvec3 normal{0};         // from a to b
    double separation = 0;        // m
    double normal_force = 0;      // N, mean over the last substep
    glm::dvec3 friction_force{0}; // N, world, on b
};

struct JointView {
    std::size_t joint = 0; // see Simulation::joint_name
    JointType type = JointType::ball;
    std::optional<std::size_t> body_a, body_b; // empty: the world
    glm::dvec3 anchor_a{0}, anchor_b{0};       // world, now
    // World, now; the x axes are the hinge's or slider's axis. Fixed joints have frames too.
    glm::dquat frame_a{1, 0, 0, 0}, frame_b{1, 0, 0, 0};
    // Hinge angle (rad), slider position (m) or anchor distance of a distance joint (m), and its
    // rate; 0 for the others.
    double position = 0;
    double speed = 0;
    // Hinge or slider limits, if any; min and max length of a distance joint.
    std::optional<std::array<double, 2>> limits;
    std::optional<double> motor_speed; // rad/s or m/s
    double max_motor_force = 0;        // N m or N
    double motor_force = 0;            // now; N m or N
    double frequency = 0;              // Hz; 0: rigid
    double break_force = 0;            // N; 0: never
    bool broken = false;
    double drift = 0;       // m, position error of the anchors, limits included
    double angle_drift = 0; // rad, the same for the frames
    // Load on b from all rows, mean over the last substep: at its anchor (N) and about it (N m).
    // World.
    glm::dvec3 force{0};
    glm::dvec3 torque{0};
};

// A point of a body, or a particle, held to a target.
struct GrabView {
    std::size_t body = 0;
    glm::dvec3 local_point{0};
    glm::dvec3 target{0};                  // world
    double max_force = 0;                  // N
    std::optional<std::size_t> particle{}; // instead of the body
};

// A bounce, or a blow without one, during the last step.
struct ImpactView {
    std::size_t body_a = 0;
    std::size_t body_b = 0;
    glm::dvec3 position{0}; // world
    glm::dvec3 normal{0};   // from a to b
    double impulse = 0;     // N s
};

// What to read besides bodies, particles and springs; parts not asked for are not computed.
struct FrameParts {
    bool joints = false;
    bool contacts = false;
    bool impacts = false;
};

struct Frame {
    std::uint64_t step_count = 0;
    double time = 0;                      // s, since the start of the scene
    std::vector<BodyState> bodies;        // by index, holes included
    std::vector<ParticleState> particles; // by index, as in Simulation::soft_parts
    std::vector<std::uint8_t> torn;       // by spring: 1 if torn
    std::vector<JointView> joints;        // existing ones, ascending
    std::vector<ContactView> contacts;    // of the last step, one per point
    std::vector<ImpactView> impacts;      // of the last step
};

} // namespace plumb
