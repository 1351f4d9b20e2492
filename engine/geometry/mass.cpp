#include "engine/geometry/mass.h"

#include "engine/core/check.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr Real pi = Real(3.14159265358979323846L);

Real volume_of(const Sphere &sphere) {
    return Real(4) / Real(3) * pi * sphere.radius * sphere.radius * sphere.radius;
}

Real volume_of(const Box &box) {
    return Real(8) * box.half_extents.x * box.half_extents.y * box.half_extents.z;
}

Real volume_of(const Capsule &capsule) {
    const Real length = glm::length(capsule.b - capsule.a);
    return pi * capsule.radius * capsule.radius * (length + Real(4) / Real(3) * capsule.radius);
}

Real volume_of(const HalfSpace &) {
    return std::numeric_limits<Real>::infinity();
}

Vec3 inertia_of(const Sphere &sphere, Real mass) {
    return Vec3{Real(0.4) * mass * sphere.radius * sphere.radius};
}

Vec3 inertia_of(const Box &box, Real mass) {
    const Vec3 squared = box.half_extents * box.half_extents;
    return mass / Real(3) *
           Vec3{squared.y + squared.z, squared.z + squared.x, squared.x + squared.y};
}

Vec3 inertia_of(const Capsule &capsule, Real mass) {
    const Real r = capsule.radius;
    const Real length = glm::length(capsule.b - capsule.a);
    const Real equivalent = length + Real(4) / Real(3) * r; // volume / (pi r^2)
    if (equivalent <= Real(0))
        return Vec3{Real(0)}; // a point
    const Real cylinder = mass * (length / equivalent);
    const Real caps = mass - cylinder; // both half balls

    // A cylinder, and two half balls whose centres of mass lie 3/8 r beyond its ends. About the
    // middle, by the parallel axis theorem, per unit mass of the caps:
    //   (2/5 r^2 - (3/8 r)^2) + (L/2 + 3/8 r)^2 = 2/5 r^2 + L^2/4 + 3/8 L r.
    const Real along = cylinder * r * r / Real(2) + caps * Real(0.4) * r * r;
    const Real across =
        cylinder * (length * length / Real(12) + r * r / Real(4)) +
        caps * (Real(0.4) * r * r + length * length / Real(4) + Real(0.375) * length * r);
    return {across, along, across};
}

Vec3 inertia_of(const HalfSpace &half_space, Real mass) {
    PLUMB_CHECK(false, "a half-space has no inertia; its offset is "
                           << half_space.offset << " and the mass asked for " << mass);
}

} // namespace

Real volume(const Shape &shape) {
    check_valid(shape);
    return std::visit([](const auto &solid) { return volume_of(solid); }, shape);
}

Vec3 principal_inertia(const Shape &shape, Real mass) {
    PLUMB_CHECK(mass >= Real(0) && std::isfinite(mass),
                "mass must be finite and not negative, got " << mass);
    check_valid(shape);
    return std::visit([&](const auto &solid) { return inertia_of(solid, mass); }, shape);
}

} // namespace plumb::inline PLUMB_PRECISION
