// The Gauss map of a polyhedron: each face becomes its normal on the unit sphere, each edge the arc
// between the normals of its two faces.
//
// The Minkowski difference B - A of two polyhedra has three kinds of face normals: those of B,
// those of A negated, and those where an arc of B crosses a negated arc of A, where the two edges
// span a face (Gregorius 2013, "The separating axis test between convex polyhedra", GDC).
#pragma once

#include "engine/geometry/support.h"

#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct GaussMap {
    struct Arc {
        Vec3 edge{Real(0)};     // direction, of any length
        std::uint32_t from, to; // indices of normals less than half a turn apart
    };
    std::vector<Vec3> normals; // unit; may include some of no face, at edges with only one face
    std::vector<Arc> arcs;
};

// Empty for a point, and for a cylinder, which is no polyhedron.
GaussMap gauss_map(const PointCore &point);
GaussMap gauss_map(const SegmentCore &segment);
GaussMap gauss_map(const TriangleCore &triangle);
GaussMap gauss_map(const AabbCore &box);
GaussMap gauss_map(const BoxCore &box);
GaussMap gauss_map(const CylinderCore &cylinder);
GaussMap gauss_map(const HullCore &hull);

// Visits every possible face normal of the Minkowski difference B - A, and some more.
template <typename Visit>
void for_each_face_normal(const GaussMap &a, const GaussMap &b, const Visit &visit) {
    for (const Vec3 &normal : b.normals)
        visit(normal);
    for (const Vec3 &normal : a.normals)
        visit(-normal);
    std::vector<Real> along(b.normals.size()); // B's normals projected on an edge of A
    for (const GaussMap::Arc &of_a : a.arcs) {
        for (std::size_t i = 0; i < along.size(); ++i)
            along[i] = glm::dot(b.normals[i], of_a.edge);
        const Vec3 from = -a.normals[of_a.from], to = -a.normals[of_a.to];
        for (const GaussMap::Arc &of_b : b.arcs) {
            // Each arc's ends must be on different sides of the other's great circle, and both arcs
            // must pass the same one of the two points where the great circles cross.
            if ((along[of_b.from] < Real(0)) == (along[of_b.to] < Real(0)) ||
                (glm::dot(from, of_b.edge) < Real(0)) == (glm::dot(to, of_b.edge) < Real(0)))
                continue;
            const Vec3 normal = glm::cross(of_a.edge, of_b.edge);
            const Real length = glm::length(normal);
            const Real on_a = glm::dot(normal, from + to);
            const Real on_b = glm::dot(normal, b.normals[of_b.from] + b.normals[of_b.to]);
            if (length >= std::sqrt(std::numeric_limits<Real>::min()) &&
                (on_a < Real(0)) == (on_b < Real(0)))
                visit(on_a < Real(0) ? -normal / length : normal / length);
        }
    }
}

} // namespace plumb::inline PLUMB_PRECISION
