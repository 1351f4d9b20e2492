// Building blocks for the scenes that engines are compared on.
#pragma once

#include "engine/scene/scene_desc.h"

namespace plumb::parts {

// Adds a body with a unique name made of `what` and the body count.
BodyDesc &add(SceneDesc &scene, const std::string &what, ShapeDesc shape,
              const glm::dvec3 &position);

// A scene with only the ground, the plane y = 0, in the default material.
[[nodiscard]] SceneDesc on_ground();

// Replaces the scene's materials with one, used by all its bodies and those added later.
void set_material(SceneDesc &scene, double friction, double restitution);

// Joins two bodies, given by index, at a point in the world. A hinge turns about the world's z
// axis.
inline constexpr std::size_t the_world = ~std::size_t{0};
void add_joint(SceneDesc &scene, JointType type, std::size_t a, std::size_t b,
               const glm::dvec3 &at);

// The rotation that takes y to a unit direction.
[[nodiscard]] glm::dquat from_y_to(const glm::dvec3 &direction);

// A pyramid of 1 m boxes along x, one box thick.
void add_pyramid(SceneDesc &scene, int base, double z);

// A level net of side x side 1 kg balls on 0.5 m arms, hung by one edge or two corners.
void add_net(SceneDesc &scene, int side, bool by_edge);

// Eleven bodies and ten joints, 1.8 m tall, lying on its back with its feet at `at`.
void add_ragdoll(SceneDesc &scene, const glm::dvec3 &at);

} // namespace plumb::parts
