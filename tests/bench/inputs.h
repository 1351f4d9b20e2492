// Random inputs for contests: about a metre in size, hitting each other about half of the time.
#pragma once

#include "engine/core/random.h"
#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <span>
#include <utility>
#include <vector>

namespace plumb::inputs {

inline constexpr std::size_t count = 1024;

Vec3 vector(Random &random, double reach);
Quat rotation(Random &random);
Sphere sphere(Random &random, double reach);
Aabb aabb(Random &random, double reach);
Box box(Random &random, double reach);
Capsule capsule(Random &random, double reach);
Cylinder cylinder(Random &random, double reach);
Triangle triangle(Random &random, double reach);
const HullMesh &rock(); // 32 points on a sphere
ConvexHull hull(Random &random, double reach);
Ray ray(Random &random); // from outside, roughly towards the origin; 8 m long

// `count` results of make(random).
template <typename Make> auto many(std::uint64_t seed, const Make &make) {
    Random random(seed);
    std::vector<decltype(make(random))> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(make(random));
    return result;
}

// The same, kept for the lifetime of the program.
template <typename Make> auto kept(std::uint64_t seed, const Make &make) {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): kept to the end on purpose
    static const auto *inputs = new auto(many(seed, make));
    return std::span(*inputs);
}

} // namespace plumb::inputs
