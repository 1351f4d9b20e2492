// The solid shapes of the engine and the ray, as plain values.
//
// All sets are closed: a point on the surface is inside. Lengths in metres.
#pragma once

#include "engine/math/types.h"

#include <limits>
#include <variant>

namespace plumb::inline PLUMB_PRECISION {

struct Sphere {
    Vec3 center{Real(0)};
    Real radius = Real(0); // > 0; zero is a point and allowed in queries
};

// A box of any orientation (OBB).
struct Box {
    Vec3 center{Real(0)};
    Quat rotation = identity_rotation;
    Vec3 half_extents{Real(0)}; // >= 0 in each component
};

// All points within `radius` of the segment from a to b. a == b gives a sphere.
struct Capsule {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Real radius = Real(0);
};

// The solid half-space dot(normal, p) <= offset below a plane. `normal` has unit length.
struct HalfSpace {
    Vec3 normal{Real(0), Real(1), Real(0)};
    Real offset = Real(0);
};

using Shape = std::variant<Sphere, Box, Capsule, HalfSpace>;

// An axis-aligned box; empty when min > max in any component.
struct Aabb {
    Vec3 min{std::numeric_limits<Real>::max()};
    Vec3 max{std::numeric_limits<Real>::lowest()};
};

// The points origin + t * direction for 0 <= t <= max_t. `direction` has any length but zero, and t
// is in units of it, so the segment from a to b is Ray{a, b - a, 1}.
struct Ray {
    Vec3 origin{Real(0)};
    Vec3 direction{Real(0), Real(0), Real(1)};
    Real max_t = std::numeric_limits<Real>::infinity();
};

// The same shape, moved by `pose`.
Sphere placed(const Sphere &local, const Transform &pose);
Box placed(const Box &local, const Transform &pose);
Capsule placed(const Capsule &local, const Transform &pose);
HalfSpace placed(const HalfSpace &local, const Transform &pose);
Shape placed(const Shape &local, const Transform &pose);

// The smallest axis-aligned box around a shape. A half-space has no finite one: only its
// axis-aligned side is bounded, so callers treat half-spaces apart; asking fails a check.
Aabb bounds(const Sphere &sphere);
Aabb bounds(const Box &box);
Aabb bounds(const Capsule &capsule);
Aabb bounds(const Shape &shape);

// Fails a check, naming the value, when a member is NaN or infinite, a size is negative, a rotation
// or normal is not of unit length (within 1e-3).
void check_valid(const Shape &shape);

} // namespace plumb::inline PLUMB_PRECISION
