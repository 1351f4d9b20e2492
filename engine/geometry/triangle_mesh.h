// A surface of triangles, as plain data.
#pragma once

#include "engine/geometry/shapes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Corners of a triangle are counter-clockwise from its front. Triangles may be flat, may share
// corners or not, may cross; nothing needs to be closed.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles; // indices of vertices
};

// Coordinates of a mesh, and of what is asked of it, in metres: beyond, products of four of them
// overflow in float.
inline constexpr Real mesh_reach = Real(1e8);

// Fails a check, naming the value, when a vertex is not finite or beyond `mesh_reach`, or an index
// is not that of a vertex.
void check_valid(const TriangleMesh &mesh);

// `index` must be below mesh.triangles.size().
inline Triangle triangle(const TriangleMesh &mesh, std::size_t index) {
    const std::array<std::uint32_t, 3> &corners = mesh.triangles[index];
    return {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
}

// The smallest axis-aligned box around the triangles; empty when there is none.
Aabb bounds(const TriangleMesh &mesh);

// Whether each edge is used as often in one direction as in the other, so that the triangles have
// no border and all turn the same way. Corners count as one when they have one index.
bool is_closed(const TriangleMesh &mesh);

} // namespace plumb::inline PLUMB_PRECISION
