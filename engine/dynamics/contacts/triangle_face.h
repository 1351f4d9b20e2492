// A triangle of a surface as its contacts see it.
#pragma once

#include "engine/geometry/triangle.h"

#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

struct TriangleFace {
    std::array<Vec3, 3> corners{};
    Vec3 normal{Real(0)}; // unit, out of the front
    Real size = Real(0);  // the root of twice its area (m)

    // How far a point is beyond an edge, in the face's plane (m).
    Real beyond(const Vec3 &point, std::size_t edge) const {
        const Vec3 &from = corners[edge];
        const Vec3 along = corners[(edge + 1) % 3] - from;
        return glm::dot(glm::cross(along, normal), point - from) / glm::length(along);
    }
    // How far a point is in front of its plane (m).
    Real height(const Vec3 &point) const { return glm::dot(normal, point - corners[0]); }
};

// None for a triangle without an area.
inline std::optional<TriangleFace> face_of(const Triangle &triangle) {
    const Vec3 cross = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const Real doubled_area = glm::length(cross);
    if (!(doubled_area > Real(0)))
        return std::nullopt;
    return TriangleFace{
        {triangle.a, triangle.b, triangle.c}, cross / doubled_area, std::sqrt(doubled_area)};
}

} // namespace plumb::inline PLUMB_PRECISION
