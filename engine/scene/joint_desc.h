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

// Rows of a joint at most, and so impulses that a solver remembers of it.
inline constexpr std::size_t max_joint_rows = 8;

// Holds body b to body a. An empty body name means the world; its anchor and frame are then in
// world coordinates. Each type reads what concerns it.
struct JointDesc {
    std::string name;
    JointType type = JointType::ball;
    std::string body_a;
    std::string body_b;
    glm::dvec3 anchor_a_local{0};
    glm::dvec3 anchor_b_local{0};
    // Unit. Their x axes are the hinge's or slider's axis; its angle or position is 0 where the
    // frames (and of a slider the anchors) agree. A fixed joint keeps them together.
    glm::dquat frame_a_local{1, 0, 0, 0};
    glm::dquat frame_b_local{1, 0, 0, 0};
    // distance: of the anchors (m). A rod has both the same, a rope a min_length of 0.
    double min_length = 0;
    double max_length = 0;
    std::optional<std::array<double, 2>> limits; // hinge: rad, slider: m; lower <= upper
    // hinge: rad/s and N m, slider: m/s and N. The motor is on when it has a speed.
    std::optional<double> motor_speed;
    double max_motor_force = 0;
    // The joint's own rows as a spring, of a distance joint with that rest length; limits and
    // motor stay what they are. Hz; 0: rigid.
    double frequency = 0;
    double damping_ratio = 1;
    double break_force = 0;         // N, of what holds the anchors together; 0: never breaks
    bool collide_connected = false; // whether the two bodies also collide with each other
    // State: what the solver remembers (N s, of angular rows N m s), in the order of the rows.
    std::array<double, max_joint_rows> impulses{};
    // State: how stiff the same rows have become (N/m, N m/rad), under a method that keeps
    // penalties.
    std::array<double, max_joint_rows> penalties{};
    bool broken = false; // state: holds nothing any more
};

} // namespace plumb
