#include "engine/scene/shape_desc.h"

#include "engine/scene/real/hull_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

namespace plumb {

// The header above declares the f32 version; this is its f64 twin, compiled from the same source.
namespace f64 {
HullMeasures measure_hull(std::span<const glm::dvec3>);
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct ForgetFile {
    void operator()(SphereDesc &) const {}
    void operator()(BoxDesc &) const {}
    void operator()(CapsuleDesc &) const {}
    void operator()(CylinderDesc &) const {}
    void operator()(HullDesc &h) const { h.file.reset(); }
    void operator()(PlaneDesc &) const {}
    void operator()(MeshDesc &m) const {
        if (file_of(m) != nullptr)
            m.source = std::monostate{};
    }
    void operator()(HeightFieldDesc &) const {}
};

struct IsComplete {
    bool operator()(const SphereDesc &) const { return true; }
    bool operator()(const BoxDesc &) const { return true; }
    bool operator()(const CapsuleDesc &) const { return true; }
    bool operator()(const CylinderDesc &) const { return true; }
    bool operator()(const HullDesc &h) const { return h.points != nullptr; }
    bool operator()(const PlaneDesc &) const { return true; }
    bool operator()(const MeshDesc &m) const { return m.data != nullptr; }
    bool operator()(const HeightFieldDesc &f) const { return f.heights != nullptr; }
};

struct Volume {
    double operator()(const SphereDesc &s) const {
        return 4.0 / 3.0 * std::numbers::pi * std::pow(s.radius, 3);
    }
    double operator()(const BoxDesc &b) const {
        return 8 * b.half_extents.x * b.half_extents.y * b.half_extents.z;
    }
    double operator()(const CapsuleDesc &c) const {
        return std::numbers::pi * c.radius * c.radius * (2 * c.half_height + 4.0 / 3.0 * c.radius);
    }
    double operator()(const CylinderDesc &c) const {
        return std::numbers::pi * c.radius * c.radius * 2 * c.half_height;
    }
    double operator()(const HullDesc &h) const { return f64::measure_hull(*h.points).volume; }
    double operator()(const PlaneDesc &) const { return infinite; }
    double operator()(const MeshDesc &) const { return 0; }
    double operator()(const HeightFieldDesc &) const { return 0; }
};

struct SmallestWidth {
    double operator()(const SphereDesc &s) const { return 2 * s.radius; }
    double operator()(const BoxDesc &b) const {
        return 2 * std::min({b.half_extents.x, b.half_extents.y, b.half_extents.z});
    }
    double operator()(const CapsuleDesc &c) const { return 2 * c.radius; }
    double operator()(const CylinderDesc &c) const { return 2 * std::min(c.half_height, c.radius); }
    double operator()(const HullDesc &h) const {
        return f64::measure_hull(*h.points).smallest_width;
    }
    double operator()(const PlaneDesc &) const { return infinite; }
    double operator()(const MeshDesc &) const { return infinite; }
    double operator()(const HeightFieldDesc &) const { return infinite; }
};

struct BoundsOf {
    const glm::dvec3 &position;
    const glm::dquat &orientation;

    BoundsDesc operator()(const SphereDesc &s) const { return around(glm::dvec3(s.radius)); }
    BoundsDesc operator()(const BoxDesc &b) const {
        const glm::dmat3 axes = glm::mat3_cast(orientation);
        return around(glm::abs(axes[0]) * b.half_extents.x + glm::abs(axes[1]) * b.half_extents.y +
                      glm::abs(axes[2]) * b.half_extents.z);
    }
    BoundsDesc operator()(const CapsuleDesc &c) const {
        return around(glm::abs(orientation * glm::dvec3(0, c.half_height, 0)) + c.radius);
    }
    BoundsDesc operator()(const CylinderDesc &c) const {
        // A disc's extent along an axis is its radius times the sine of the angle to its normal.
        const glm::dvec3 up = orientation * glm::dvec3(0, 1, 0);
        return around(c.half_height * glm::abs(up) +
                      c.radius * glm::sqrt(glm::max(glm::dvec3(0), 1.0 - up * up)));
    }
    BoundsDesc operator()(const HullDesc &h) const { return around_all(*h.points); }
    BoundsDesc operator()(const PlaneDesc &) const {
        return {glm::dvec3(-infinite), glm::dvec3(infinite)};
    }
    BoundsDesc operator()(const MeshDesc &m) const { return around_all(m.data->vertices); }
    BoundsDesc operator()(const HeightFieldDesc &f) const {
        std::vector<glm::dvec3> points;
        for (int row = 0; row < f.rows; ++row)
            for (int column = 0; column < f.columns; ++column)
                points.push_back(sample_point(f, row, column));
        return around_all(points);
    }

  private:
    BoundsDesc around(const glm::dvec3 &half) const { return {position - half, position + half}; }
    BoundsDesc around_all(const std::vector<glm::dvec3> &points) const {
        BoundsDesc all{glm::dvec3(infinite), glm::dvec3(-infinite)};
        for (const glm::dvec3 &point : points) {
            const glm::dvec3 placed = position + orientation * point;
            all.min = glm::min(all.min, placed);
            all.max = glm::max(all.max, placed);
        }
        return all;
    }
};

} // namespace

void forget_file(ShapeDesc &shape) {
    std::visit(ForgetFile{}, shape);
}

bool is_complete(const ShapeDesc &shape) {
    return std::visit(IsComplete{}, shape);
}

double volume(const ShapeDesc &shape) {
    return std::visit(Volume{}, shape);
}

double smallest_width(const ShapeDesc &shape) {
    return std::visit(SmallestWidth{}, shape);
}

BoundsDesc bounds(const ShapeDesc &shape, const glm::dvec3 &position,
                  const glm::dquat &orientation) {
    return std::visit(BoundsOf{position, orientation}, shape);
}

glm::dvec3 sample_point(const HeightFieldDesc &field, int row, int column) {
    const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                       static_cast<std::size_t>(column);
    return {(column - 0.5 * (field.columns - 1)) * field.spacing, (*field.heights)[index],
            (row - 0.5 * (field.rows - 1)) * field.spacing};
}

} // namespace plumb
