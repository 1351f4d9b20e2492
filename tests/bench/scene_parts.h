// What the scenes that engines are compared on are made of.
#pragma once

#include "engine/scene/scene_desc.h"

namespace plumb::parts {

// A name of its own, by what it is and how many bodies there are.
BodyDesc &add(SceneDesc &scene, const std::string &what, ShapeDesc shape,
              const glm::dvec3 &position);

// An empty scene above the plane y = 0, of the default material.
[[nodiscard]] SceneDesc on_ground();

// Its one material, which all bodies that are added later have.
void set_material(SceneDesc &scene, double friction, double restitution);

// Between bodies by their index, at a point of the world. A hinge turns about the world's z.
inline constexpr std::size_t the_world = ~std::size_t{0};
void add_joint(SceneDesc &scene, JointType type, std::size_t a, std::size_t b,
               const glm::dvec3 &at);

// Turns y to a direction of unit length.
[[nodiscard]] glm::dquat from_y_to(const glm::dvec3 &direction);

// A wall of boxes of 1 m along x.
void add_pyramid(SceneDesc &scene, int base, double z);

// side x side balls of 1 kg on arms of 0.5 m, level, hung up by one edge or by two corners.
void add_net(SceneDesc &scene, int side, bool by_edge);

// Eleven bodies and ten joints, 1.8 m tall, lying on its back with its feet at `at`.
void add_ragdoll(SceneDesc &scene, const glm::dvec3 &at);

} // namespace plumb::parts
