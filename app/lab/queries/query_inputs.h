// Random inputs for charted queries: integer ones with exactly known answers, and realistic ones
// for timing.
#pragma once

#include "app/lab/queries/query_oracle.h"
#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

// A case's position and size. All its coordinates are integers times `unit`.
struct Lattice {
    oracle::Int spread = 4; // coordinates about the offset
    oracle::Point offset;
    float unit = 1;

    [[nodiscard]] Vec3 real(const oracle::Point &p) const {
        return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)} *
               unit;
    }
};

const std::vector<std::string> &lattice_families();
Lattice any_lattice(Random &random, std::uint8_t &family);

// An integer from -reach to reach.
oracle::Int whole(Random &random, oracle::Int reach);

oracle::Point any_point(Random &random, const Lattice &lattice);
oracle::Block any_block(Random &random, const Lattice &lattice);
oracle::Ball any_ball(Random &random, const Lattice &lattice);
oracle::Corners any_corners(Random &random, const Lattice &lattice); // one in eight is flat
oracle::Line any_segment(Random &random, const Lattice &lattice);    // one in eight has no length

// A nonzero vector, often with zero components.
oracle::Point any_direction(Random &random, oracle::Int spread);

// For a box, a point on a face, edge or corner, or inside; for a ball, an end of an axis or the
// centre.
oracle::Point any_place(Random &random, const oracle::Block &block);
oracle::Point any_place(Random &random, const oracle::Ball &ball);
// A corner or the midpoint of an edge, an integer point because triangle corners are even.
oracle::Point any_place(Random &random, const oracle::Corners &triangle);

// Half of the rays go through a point from any_place().
template <typename Solid>
oracle::Line any_ray(Random &random, const Lattice &lattice, const Solid &solid) {
    oracle::Line line{any_point(random, lattice), any_direction(random, lattice.spread)};
    if (random.next_index(2) == 0) {
        const oracle::Point target = any_place(random, solid);
        const auto steps = static_cast<oracle::Int>(random.next_index(4));
        line.origin = target - oracle::Point{steps * line.along.x, steps * line.along.y,
                                             steps * line.along.z};
    }
    return line;
}

// Half start at a point from any_place(); half of these also end at one.
template <typename Solid>
oracle::Line any_segment(Random &random, const Lattice &lattice, const Solid &solid) {
    const oracle::Line line = any_segment(random, lattice);
    if (random.next_index(2) == 0)
        return line;
    const oracle::Point start = any_place(random, solid);
    if (random.next_index(2) == 0)
        return {start, line.along, true};
    return {start, any_place(random, solid) - start, true};
}

// Exact conversions to floats.
Segment real_segment(const oracle::Line &line, const Lattice &lattice);
Aabb real_aabb(const oracle::Block &block, const Lattice &lattice);
Sphere real_sphere(const oracle::Ball &ball, const Lattice &lattice);
Triangle real_triangle(const oracle::Corners &corners, const Lattice &lattice);
// An oriented box without rotation. Halves of integers are exact too.
Box real_box(const oracle::Block &block, const Lattice &lattice);
// Zero components of either sign; direction scaled by 2^-20 to 2^20.
Ray real_ray(Random &random, const oracle::Line &line, const Lattice &lattice);

// Components from -reach to reach.
Vec3 any_vector(Random &random, double reach);
Vec3 any_half(Random &random); // half extents from 0.1 to 1.1
Quat any_rotation(Random &random);
Box any_box(Random &random, double reach);

// For timing. Rays hit about half of the time: they aim at a shape about 1 in size.
Ray timed_ray(Random &random);
Triangle timed_triangle(Random &random, double reach);
Aabb timed_aabb(Random &random, double reach);

} // namespace plumb
