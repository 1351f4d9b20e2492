// The vector part of batch.h, compiled once per instruction set.
//
// Only the numbers are checked here: each kernel returns whether all inputs were valid by the
// scalar function's rules (no NaN, no infinity, no negative radius).
#pragma once

#include "engine/geometry/batch.h"

namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

bool ray_interval(const AabbBatch &boxes, const Ray &ray, const IntervalBatch &out);
bool ray_interval(const Aabb &box, const RayBatch &rays, const IntervalBatch &out);
// Where `unsure` is set, ask the scalar function.
bool ray_interval(const SphereBatch &spheres, const Ray &ray, const IntervalBatch &out,
                  std::uint64_t *unsure);

bool overlaps(const AabbBatch &a, const AabbBatch &b, std::uint64_t *answers);
bool overlaps(const Aabb &box, const AabbBatch &boxes, std::uint64_t *answers);
bool overlaps(const Sphere &sphere, const SphereBatch &spheres, std::uint64_t *answers);

bool contains(const Sphere &sphere, const PointBatch &points, std::uint64_t *answers,
              std::uint64_t *unsure);
bool contains(const Aabb &box, const PointBatch &points, std::uint64_t *answers);
bool contains(const Box &box, const PointBatch &points, std::uint64_t *answers);

// Certain answers, except where `unsure` is set: ask the scalar function there.
struct Verdicts {
    std::uint64_t *not_outside;
    std::uint64_t *inside;
    std::uint64_t *unsure;
};
bool classify(const Frustum &frustum, const PointBatch &points, const Verdicts &out);
bool classify(const Frustum &frustum, const SphereBatch &spheres, const Verdicts &out);
bool classify(const Frustum &frustum, const AabbBatch &boxes, const Verdicts &out);

// Sets the bits of the triangles the ray's line may hit; it certainly misses the others.
bool may_meet(const TriangleBatch &triangles, const Ray &ray, std::uint64_t *answers);

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
