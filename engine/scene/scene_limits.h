// Limits on a scene as a whole, so that none takes more than a few gigabytes of memory; a scene
// beyond them is refused. Limits on single items are declared next to those.
#pragma once

#include <cstddef>

namespace plumb {

inline constexpr std::size_t max_scene_planes = 100;
// Broad-phase pairs in the first step (bodies whose bounding boxes touch), some 600 bytes each. 15
// per body at max_scene_bodies: more than a solid block of boxes has.
inline constexpr std::size_t max_scene_pairs = 3'000'000;

// Everything that moves evaluates every attractor, as it does every plane.
inline constexpr std::size_t max_scene_attractors = 100;

// Cloth included: some 200 bytes each, and 100 characters in a saved scene.
inline constexpr std::size_t max_scene_particles = 200'000;
inline constexpr std::size_t max_scene_springs = 2'000'000;

// Surface triangles of all bodies, each body counted separately: some 110 bytes per triangle.
inline constexpr std::size_t max_scene_triangles = 4'000'000;

// Totals over all probes of a scene.
inline constexpr std::size_t max_scene_probe_shapes = 50'000; // including parts of compounds
inline constexpr std::size_t max_scene_probe_triangles = 1'000'000;
inline constexpr std::size_t max_scene_probe_items = 200'000;
inline constexpr std::size_t max_scene_probe_questions =
    1'000'000; // shape pairs, or shape and point pairs

} // namespace plumb
