#include "engine/scene/shape_desc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

namespace plumb {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

struct Volume {
    double operator()(const SphereDesc &s) const { return 4.0 / 3.0 * pi * std::pow(s.radius, 3); }
    double operator()(const BoxDesc &b) const {
        return 8 * b.half_extents.x * b.half_extents.y * b.half_extents.z;
    }
    double operator()(const CapsuleDesc &c) const {
        return pi * c.radius * c.radius * (2 * c.half_height + 4.0 / 3.0 * c.radius);
    }
    double operator()(const PlaneDesc &) const { return infinite; }
};

struct SmallestWidth {
    double operator()(const SphereDesc &s) const { return 2 * s.radius; }
    double operator()(const BoxDesc &b) const {
        return 2 * std::min({b.half_extents.x, b.half_extents.y, b.half_extents.z});
    }
    double operator()(const CapsuleDesc &c) const { return 2 * c.radius; }
    double operator()(const PlaneDesc &) const { return infinite; }
};

struct HalfBounds {
    const glm::dquat &orientation;

    glm::dvec3 operator()(const SphereDesc &s) const { return glm::dvec3(s.radius); }
    glm::dvec3 operator()(const BoxDesc &b) const {
        const glm::dmat3 axes = glm::mat3_cast(orientation);
        return glm::abs(axes[0]) * b.half_extents.x + glm::abs(axes[1]) * b.half_extents.y +
               glm::abs(axes[2]) * b.half_extents.z;
    }
    glm::dvec3 operator()(const CapsuleDesc &c) const {
        return glm::abs(orientation * glm::dvec3(0, c.half_height, 0)) + c.radius;
    }
    glm::dvec3 operator()(const PlaneDesc &) const { return glm::dvec3(infinite); }
};

} // namespace

double volume(const ShapeDesc &shape) {
    return std::visit(Volume{}, shape);
}

double smallest_width(const ShapeDesc &shape) {
    return std::visit(SmallestWidth{}, shape);
}

glm::dvec3 half_bounds(const ShapeDesc &shape, const glm::dquat &orientation) {
    return std::visit(HalfBounds{orientation}, shape);
}

} // namespace plumb
