// Joints as a draw list.
#pragma once

#include "app/render/draw_list.h"
#include "app/sandbox/draw/pose_blend.h"
#include "engine/scene/simulation.h"

#include <span>
#include <vector>

namespace plumb {

// What drawing joints needs besides the joints.
struct JointSurroundings {
    std::span<const BodyState> poses; // of the bodies, as shown
    std::span<const double> reach;    // of each body's shape from its origin, m; 0: ignored
    glm::dvec3 gravity{0, -9.81, 0};
    double weight = 0; // N, scale for force arrows; 0: none are drawn
};

// The frame's joints, moved along with the bodies as shown.
[[nodiscard]] std::vector<JointView> joints_at(const Frame &frame,
                                               std::span<const BodyState> poses);

// Whether most dynamic bodies hang on joints that only the joint symbols show (rods, ropes and
// springs are drawn anyway): then those symbols are what there is to see.
[[nodiscard]] bool is_about_joints(const Simulation &simulation);

// Rods, ropes and springs: part of the scene, drawn even when joints are not.
void draw_links(DrawList &list, std::span<const JointView> joints,
                const JointSurroundings &surroundings);

// A coil from a to b for a spring of that rest length, or a straight wire; m.
void draw_spring(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double rest_length);
void draw_wire(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double radius);

// Draws how each joint holds its bodies: its anchors, what its type adds (the hinge axis and an
// arc, the slider's rail, a cross where nothing is free), limits and motor; and the joint force on
// the held body, at its anchor: 0.3 m long for the weight, growing with the square root of the
// force, 2 m at most.
void draw_joints(DrawList &list, std::span<const JointView> joints,
                 const JointSurroundings &surroundings);

} // namespace plumb
