// Bullet's queries, to time against ours.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace plumb::bullet {

using Work = std::function<std::uint64_t()>;

// btRayAabb2, the test in the inner loop of Bullet's trees. It takes the inverse direction;
// computing that counts as work, as it does for ours.
Work rays_aabbs(std::span<const Ray> rays, std::span<const Aabb> boxes);
// The same, one ray against all boxes: its inverse and the boxes in Bullet's types are precomputed.
Work ray_aabbs(const Ray &ray, std::span<const Aabb> boxes);

// btCollisionWorld::rayTestSingle: ray i against shape i.
template <typename Solid> Work rays(std::span<const Ray> rays, std::span<const Solid> solids);

// The collision algorithm that Bullet's dispatcher picks for the pair, as in its step: a manifold.
// A contact that is not separated counts as a yes.
template <typename A, typename B> Work contacts(std::span<const A> a, std::span<const B> b);

// btGjkPairDetector with btGjkEpaPenetrationDepthSolver: distance or depth, and closest points.
template <typename A, typename B> Work closest(std::span<const A> a, std::span<const B> b);

} // namespace plumb::bullet
