// Tests one ray against all boxes of a node, or all triangles of a leaf, at once.
//
// Compiled for each SIMD instruction set and selected at run time (Highway). Each lane does what
// scalar code would and nothing is fused, so answers are the same to the last bit at every width.
#pragma once

#include "engine/geometry/shapes.h"
#include "engine/space/bvh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

// The triangles of a leaf side by side, so that a ray tests them all at once. Unused lanes have
// size -infinity and are never hit.
struct alignas(64) TriangleBlock {
    Real corners[3][3][Bvh::leaf_size]; // by corner, axis, triangle
    Real sizes[Bvh::leaf_size];         // the greatest extent along an axis
    std::uint32_t triangles[Bvh::leaf_size];

    Triangle at(std::size_t lane) const {
        const auto corner = [this, lane](std::size_t k) {
            return Vec3{corners[k][0][lane], corners[k][1][lane], corners[k][2][lane]};
        };
        return {corner(0), corner(1), corner(2)};
    }
};

// A ray with the values its tests share. `direction` is scaled by a power of two so that its
// largest component is 1 to 2; times are along that. Members that wide_ray fills anyway are not
// initialised: for a ray that soon misses, that was a fifth of the work.
struct WideRay {
    Real origin[3];
    double direction[3];
    double time_scale = 1.0;         // the given ray's t per unit of time
    std::array<std::size_t, 3> axes; // the last is the largest component's

    // How far the ray can get in the mesh, along any axis and in time.
    Real reach = Real(0);

    // For boxes: (bound - origin) * inverse is never too late on entry, never too early on exit.
    Real enter_origin[3], leave_origin[3];
    Real inverse[3];
    std::size_t enter_side[3]; // 0: enters through the lowest bound

    Real max_time = Real(0);

    Ray given;
};

// A hit, in the ray's scaled time.
struct WideHit {
    Real time = Real(0);
    const TriangleBlock *block = nullptr;
    std::size_t lane = 0;
    // Proportional to the corners' weights, and positive if the line leaves through the triangle's
    // front; all zero if rounding left the signs undecided.
    std::array<double, 3> edges{};

    std::uint32_t triangle() const { return block->triangles[lane]; }
};

// Prepares a valid ray for triangles within `bounds`.
WideRay wide_ray(const Ray &ray, const Aabb &bounds);

// Whether the ray, extended to infinity, hits the triangle, decided exactly as in raycast(triangle,
// ray); and when, with WideHit's edges.
bool meets(const WideRay &ray, const Triangle &triangle, Real &time, std::array<double, 3> &edges);

// The tree's first hit; at equal times the lowest triangle wins. Returns whether there is one.
bool first_hit(std::span<const Bvh::Node> nodes, const TriangleBlock *blocks, const WideRay &ray,
               WideHit &hit);
bool any_hit(std::span<const Bvh::Node> nodes, const TriangleBlock *blocks, const WideRay &ray);

} // namespace plumb::inline PLUMB_PRECISION
