#include "engine/scene/real/hull_measures.h"

#include "engine/geometry/quickhull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Whether the arcs a-b and c-d on the Gauss sphere cross; all unit vectors (Gregorius 2013, "The
// Separating Axis Test between Convex Polyhedra").
bool arcs_cross(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c,
                const glm::dvec3 &d) {
    const glm::dvec3 ab = glm::cross(a, b);
    const glm::dvec3 cd = glm::cross(c, d);
    const double c_side = glm::dot(c, ab);
    const double d_side = glm::dot(d, ab);
    const double a_side = glm::dot(a, cd);
    const double b_side = glm::dot(b, cd);
    return c_side * d_side < 0 && a_side * b_side < 0 && c_side * b_side > 0;
}

double extent_along(const HullMesh &hull, const glm::dvec3 &direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3 &vertex : hull.vertices) {
        const double height = glm::dot(direction, glm::dvec3{vertex});
        low = std::min(low, height);
        high = std::max(high, height);
    }
    return high - low;
}

// The width is attained between a face and a vertex, or between two edges whose parallel planes
// enclose the hull (Houle, Toussaint 1988, "Computing the width of a set").
double width_of(const HullMesh &hull) {
    double width = std::numeric_limits<double>::infinity();
    for (const Plane &plane : hull.planes)
        width = std::min(width, extent_along(hull, glm::dvec3{plane.normal}));
    for (std::size_t i = 0; i < hull.edges.size(); ++i) {
        const HullMesh::Edge &e = hull.edges[i];
        const glm::dvec3 e_a{hull.vertices[e.a]};
        const glm::dvec3 e_along = glm::dvec3{hull.vertices[e.b]} - e_a;
        const glm::dvec3 e_left{hull.planes[e.left_face].normal};
        const glm::dvec3 e_right{hull.planes[e.right_face].normal};
        for (std::size_t j = 0; j < i; ++j) {
            const HullMesh::Edge &f = hull.edges[j];
            const glm::dvec3 f_left{hull.planes[f.left_face].normal};
            const glm::dvec3 f_right{hull.planes[f.right_face].normal};
            if (!arcs_cross(e_left, e_right, -f_left, -f_right))
                continue;
            const glm::dvec3 f_a{hull.vertices[f.a]};
            const glm::dvec3 across = glm::cross(e_along, glm::dvec3{hull.vertices[f.b]} - f_a);
            const double length = glm::length(across);
            // Measure over all vertices before it counts: rounding may let nearly parallel arcs
            // cross.
            if (length > 0 && std::abs(glm::dot(across / length, f_a - e_a)) < width)
                width = std::min(width, extent_along(hull, across / length));
        }
    }
    return width;
}

} // namespace

HullMeasures measure_hull(std::span<const glm::dvec3> points) {
    const std::vector<Vec3> rounded(points.begin(), points.end());
    const HullResult hull = convex_hull(rounded, max_hull_vertices);
    if (!hull.mesh)
        return {};
    return {true, static_cast<double>(hull.mesh->volume), width_of(*hull.mesh)};
}

} // namespace plumb::inline PLUMB_PRECISION
