// The inputs of charted queries, drawn at random: whole-numbered ones, whose truth is known
// exactly, and ones like a program's, to be timed.
#pragma once

#include "app/lab/queries/query_oracle.h"
#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

// Where a case lies and how large it is. All its coordinates are whole numbers times `unit`.
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

// A whole number from -reach to reach.
oracle::Int whole(Random &random, oracle::Int reach);

oracle::Point any_point(Random &random, const Lattice &lattice);
oracle::Block any_block(Random &random, const Lattice &lattice);
oracle::Ball any_ball(Random &random, const Lattice &lattice);
oracle::Corners any_corners(Random &random, const Lattice &lattice); // one in eight is flat
oracle::Line any_segment(Random &random, const Lattice &lattice);    // one in eight has no length

// A vector with many zeros, and not zero itself.
oracle::Point any_direction(Random &random, oracle::Int spread);

// A point on a face, an edge or a corner of a box, or within it; the end of an axis of a ball, or
// its middle.
oracle::Point any_place(Random &random, const oracle::Block &block);
oracle::Point any_place(Random &random, const oracle::Ball &ball);
// A corner, or the middle of an edge: triangles have even corners, so that it is whole.
oracle::Point any_place(Random &random, const oracle::Corners &triangle);

// Half of them through a place on the shape.
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

// Of half of them one end is on the shape, of a quarter both.
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

// The same in floats, exactly.
Segment real_segment(const oracle::Line &line, const Lattice &lattice);
Aabb real_aabb(const oracle::Block &block, const Lattice &lattice);
Sphere real_sphere(const oracle::Ball &ball, const Lattice &lattice);
Triangle real_triangle(const oracle::Corners &corners, const Lattice &lattice);
// An oriented box that is not turned. Halves of whole numbers are as exact.
Box real_box(const oracle::Block &block, const Lattice &lattice);
// Zeros of either sign, and lengths from 2^-20 to 2^20.
Ray real_ray(Random &random, const oracle::Line &line, const Lattice &lattice);

// Anywhere, within a reach of the origin.
Vec3 any_vector(Random &random, double reach);
Vec3 any_half(Random &random); // half extents from 0.1 to 1.1
Quat any_rotation(Random &random);
Box any_box(Random &random, double reach);

// To be timed. Rays hit about half of the time: towards a shape of a size of about one.
Ray timed_ray(Random &random);
Triangle timed_triangle(Random &random, double reach);
Aabb timed_aabb(Random &random, double reach);

} // namespace plumb
