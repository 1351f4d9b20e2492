// Geometric queries over many shapes at once, several per vector instruction.
//
// Shapes come in columns (SoA), one array per coordinate. Every answer is bit for bit that of the
// scalar function named beside it, at every vector width: the same operations in the same order,
// none fused. The widest instruction set the processor has is chosen at run time.
//
// All columns of a batch have the same length, and results need room for at least that many. Bit
// answer i is bit i % 64 of word i / 64; unused bits of the last word are zero. A length that does
// not fit, or any input the scalar function refuses, fails a check; the results are then
// unspecified.
#pragma once

#include "engine/geometry/frustum.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/shapes.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

struct PointBatch {
    std::span<const Real> x, y, z;
};

struct SphereBatch {
    std::span<const Real> x, y, z, radius;
};

struct AabbBatch {
    std::span<const Real> min_x, min_y, min_z, max_x, max_y, max_z;
};

struct TriangleBatch {
    std::span<const Real> ax, ay, az, bx, by, bz, cx, cy, cz;
};

struct RayBatch {
    std::span<const Real> origin_x, origin_y, origin_z;
    std::span<const Real> direction_x, direction_y, direction_z;
    std::span<const Real> max_t;
};

// Words needed for `count` bits.
constexpr std::size_t bit_words(std::size_t count) {
    return (count + 63) / 64;
}

constexpr bool bit_at(std::span<const std::uint64_t> bits, std::size_t i) {
    return ((bits[i / 64] >> (i % 64)) & 1U) != 0;
}

// Ray intervals inside solids; on a miss both ends are 0.
struct IntervalBatch {
    std::span<std::uint64_t> is_met;
    std::span<Real> t_enter, t_exit;
};

// --- ray_interval (raycast.h); for many boxes, the PreparedRay overload. No normals: ask the
// scalar function for those you need.
void ray_interval(const AabbBatch &boxes, const Ray &ray, const IntervalBatch &intervals);
void ray_interval(const Aabb &box, const RayBatch &rays, const IntervalBatch &intervals);
void ray_interval(const SphereBatch &spheres, const Ray &ray, const IntervalBatch &intervals);

// --- raycast (raycast.h): the first triangle the ray hits, the lowest index among hits at the same
// t.
struct BatchHit {
    std::size_t index = 0;
    RayHit hit;
};
std::optional<BatchHit> raycast(const TriangleBatch &triangles, const Ray &ray);

// --- overlaps (overlap.h): pair by pair, or one shape against many.
void overlaps(const AabbBatch &a, const AabbBatch &b, std::span<std::uint64_t> answers);
void overlaps(const Aabb &box, const AabbBatch &boxes, std::span<std::uint64_t> answers);
void overlaps(const Sphere &sphere, const SphereBatch &spheres, std::span<std::uint64_t> answers);

// --- contains (contains.h).
void contains(const Sphere &sphere, const PointBatch &points, std::span<std::uint64_t> answers);
void contains(const Aabb &box, const PointBatch &points, std::span<std::uint64_t> answers);
void contains(const Box &box, const PointBatch &points, std::span<std::uint64_t> answers);
void contains(const Frustum &frustum, const PointBatch &points, std::span<std::uint64_t> answers);

// --- classify (frustum.h), for culling: FrustumSide::inside sets both bits, across only the first,
// outside neither.
struct FrustumBits {
    std::span<std::uint64_t> not_outside;
    std::span<std::uint64_t> inside;
};
void classify(const Frustum &frustum, const SphereBatch &spheres, const FrustumBits &answers);
void classify(const Frustum &frustum, const AabbBatch &boxes, const FrustumBits &answers);

} // namespace plumb::inline PLUMB_PRECISION
