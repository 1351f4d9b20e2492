// Limits of what a scene may ask for all in all, so that none takes more than a few gigabytes of
// memory: beyond these a scene is refused. Those of single things stand beside them.
#pragma once

#include <cstddef>

namespace plumb {

inline constexpr std::size_t max_scene_planes = 100;
// Pairs of bodies that the first step has to look at, as their bounding boxes touch: each takes
// some 600 bytes. 15 for each of max_scene_bodies, which is more than a solid block of boxes has.
inline constexpr std::size_t max_scene_pairs = 3'000'000;

// Each is asked by all that moves, as planes are.
inline constexpr std::size_t max_scene_attractors = 100;

// Those of cloth among them: of each some 200 bytes, and as a saved scene 100 characters.
inline constexpr std::size_t max_scene_particles = 200'000;
inline constexpr std::size_t max_scene_springs = 2'000'000;

// Of the surfaces of all bodies, each by itself: some 110 bytes a triangle.
inline constexpr std::size_t max_scene_triangles = 4'000'000;

// Of all probes of a scene together.
inline constexpr std::size_t max_scene_probe_shapes = 50'000; // with the parts of compounds
inline constexpr std::size_t max_scene_probe_triangles = 1'000'000;
inline constexpr std::size_t max_scene_probe_items = 200'000;
inline constexpr std::size_t max_scene_probe_questions =
    1'000'000; // of two shapes, or one and a point

} // namespace plumb
