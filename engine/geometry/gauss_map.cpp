#include "engine/geometry/gauss_map.h"

#include "engine/geometry/gjk.h"
#include "engine/math/basis.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The Gauss map of a box with the given axes.
GaussMap box_map(const Mat3 &axes) {
    GaussMap map;
    for (int i = 0; i < 3; ++i) {
        map.normals.push_back(axes[i]);
        map.normals.push_back(-axes[i]);
    }
    for (std::uint32_t i = 0; i < 3; ++i)
        for (const std::uint32_t j : {0U, 1U})
            for (const std::uint32_t k : {0U, 1U})
                map.arcs.push_back(
                    {axes[static_cast<int>(i)], 2 * ((i + 1) % 3) + j, 2 * ((i + 2) % 3) + k});
    return map;
}

} // namespace

GaussMap gauss_map(const PointCore & /*point*/) {
    return {};
}

// A great circle, as four quarter arcs.
GaussMap gauss_map(const SegmentCore &segment) {
    const Vec3 edge = segment.b - segment.a;
    const Real length = glm::length(edge);
    if (!(length > Real(0)))
        return {};
    const TangentBasis basis = tangent_basis(edge / length);
    return {{basis.t1, basis.t2, -basis.t1, -basis.t2},
            {{edge, 0, 1}, {edge, 1, 2}, {edge, 2, 3}, {edge, 3, 0}}};
}

// From front to back across each edge, as quarter arcs.
GaussMap gauss_map(const TriangleCore &triangle) {
    const std::array<Vec3, 3> corners = {triangle.a, triangle.b, triangle.c};
    const Vec3 normal =
        triangle_normal(corners[1] - corners[0], corners[2] - corners[0], corners[2] - corners[1]);
    const Real length = glm::length(normal);
    GaussMap map;
    if (!(length >= std::sqrt(std::numeric_limits<Real>::min()))) { // flat: its longest edge
        Real longest = Real(0);
        for (std::size_t i = 0; i < 3; ++i) {
            const SegmentCore side{corners[i], corners[(i + 1) % 3]};
            if (glm::distance(side.a, side.b) > longest) {
                longest = glm::distance(side.a, side.b);
                map = gauss_map(side);
            }
        }
        return map;
    }
    map.normals = {normal / length, -normal / length};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = corners[(i + 1) % 3] - corners[i];
        const auto outward = static_cast<std::uint32_t>(map.normals.size());
        map.normals.push_back(glm::normalize(glm::cross(edge, map.normals[0])));
        map.arcs.push_back({edge, 0, outward});
        map.arcs.push_back({edge, outward, 1});
    }
    return map;
}

GaussMap gauss_map(const AabbCore & /*box*/) {
    return box_map(Mat3{Real(1)});
}

GaussMap gauss_map(const BoxCore &box) {
    return box_map(box.axes);
}

GaussMap gauss_map(const CylinderCore & /*cylinder*/) {
    return {};
}

GaussMap gauss_map(const HullCore &hull) {
    GaussMap map;
    for (const Plane &plane : hull.mesh->planes)
        map.normals.push_back(hull.rotation * plane.normal);
    for (const HullMesh::Edge &edge : hull.mesh->edges)
        map.arcs.push_back(
            {hull.rotation * (hull.mesh->vertices[edge.b] - hull.mesh->vertices[edge.a]),
             edge.left_face, edge.right_face});
    return map;
}

} // namespace plumb::inline PLUMB_PRECISION
