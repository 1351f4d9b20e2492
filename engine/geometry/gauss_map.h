// The Gauss map of a polyhedron: each face as its normal on the unit sphere, each edge as the arc
// from the normal of the one of its faces to that of the other.
//
// The faces of the difference B - A of two polyhedra have the normals of B's faces, those of A's
// turned around, and those where an arc of B crosses one of A turned around: there the two edges
// span a face (Gregorius 2013, "The separating axis test between convex polyhedra", GDC).
#pragma once

#include "engine/geometry/support.h"

#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct GaussMap {
    struct Arc {
        Vec3 edge{Real(0)};     // its direction, of any length
        std::uint32_t from, to; // normals, less than half a turn apart
    };
    std::vector<Vec3> normals; // unit; some may be of no face, where an edge has a face on one side
    std::vector<Arc> arcs;
};

// A point, and a cylinder, which is no polyhedron, have none.
GaussMap gauss_map(const PointCore &point);
GaussMap gauss_map(const SegmentCore &segment);
GaussMap gauss_map(const TriangleCore &triangle);
GaussMap gauss_map(const AabbCore &box);
GaussMap gauss_map(const BoxCore &box);
GaussMap gauss_map(const CylinderCore &cylinder);
GaussMap gauss_map(const HullCore &hull);

// All directions that a face of the difference B - A can have, and some more.
template <typename Visit>
void for_each_face_normal(const GaussMap &a, const GaussMap &b, const Visit &visit) {
    for (const Vec3 &normal : b.normals)
        visit(normal);
    for (const Vec3 &normal : a.normals)
        visit(-normal);
    std::vector<Real> along(b.normals.size()); // of B's normals along an edge of A
    for (const GaussMap::Arc &of_a : a.arcs) {
        for (std::size_t i = 0; i < along.size(); ++i)
            along[i] = glm::dot(b.normals[i], of_a.edge);
        const Vec3 from = -a.normals[of_a.from], to = -a.normals[of_a.to];
        for (const GaussMap::Arc &of_b : b.arcs) {
            // The ends of each on different sides of the other's great circle; and of the two
            // points where these cross, both arcs pass the same one.
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
