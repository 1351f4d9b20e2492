// Joints as a draw list.
#pragma once

#include "app/render/draw_list.h"
#include "app/sandbox/draw/pose_blend.h"
#include "engine/scene/simulation.h"

#include <span>
#include <vector>

namespace plumb {

// What joints are drawn by, besides themselves.
struct JointSurroundings {
    std::span<const BodyState> poses; // of the bodies, as they are shown
    std::span<const double> reach;    // of each body's shape from its origin, m; 0: no matter
    glm::dvec3 gravity{0, -9.81, 0};
    double weight = 0; // N, by which forces are scaled; 0: they are not drawn
};

// The frame's, moved along with the bodies as they are shown.
[[nodiscard]] std::vector<JointView> joints_at(const Frame &frame,
                                               std::span<const BodyState> poses);

// Whether most of the bodies that move hang on joints that nothing shows but their signs (a rod, a
// rope or a spring is seen anyway): then these are what there is to see.
[[nodiscard]] bool is_about_joints(const Simulation &simulation);

// Rods, ropes and springs: part of the scene, whether or not joints are looked at.
void draw_links(DrawList &list, std::span<const JointView> joints,
                const JointSurroundings &surroundings);

// A coil from a to b as of a spring of that rest length, or a straight wire; m.
void draw_spring(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double rest_length);
void draw_wire(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double radius);

// How each joint holds its bodies: its anchors, and what the fields of its type add (the axis about
// which it turns and an arc, the rail along which it moves, a cross where nothing is free), with
// limits and motor; and the force on the body that it holds, at its anchor there, 0.3 m for the
// weight and growing with the square root, to 2 m at most.
void draw_joints(DrawList &list, std::span<const JointView> joints,
                 const JointSurroundings &surroundings);

} // namespace plumb
