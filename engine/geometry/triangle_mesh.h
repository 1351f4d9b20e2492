// A triangle mesh, as plain data.
#pragma once

#include "engine/geometry/shapes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Corners are counter-clockwise seen from the front. Triangles may be flat, may cross, and need not
// share corners; the surface need not be closed.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles; // vertex indices
};

// Limit (m) for coordinates of a mesh and of queries against it: beyond it, products of four
// coordinates overflow in float.
inline constexpr Real mesh_reach = Real(1e8);

// Fails a check, naming the value, if a vertex is not finite or beyond `mesh_reach`, or an index is
// out of range.
void check_valid(const TriangleMesh &mesh);

// `index` must be below mesh.triangles.size().
inline Triangle triangle(const TriangleMesh &mesh, std::size_t index) {
    const std::array<std::uint32_t, 3> &corners = mesh.triangles[index];
    return {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
}

// The smallest axis-aligned box around the triangles; empty if there are none.
Aabb bounds(const TriangleMesh &mesh);

// For each vertex, the first in the same place.
std::vector<std::uint32_t> same_places(const std::vector<Vec3> &vertices);

// Whether each edge is used equally often in both directions, so that the surface has no border and
// consistent winding. Corners are the same only if they share an index.
bool is_closed(const TriangleMesh &mesh);

} // namespace plumb::inline PLUMB_PRECISION
