#include "engine/geometry/triangle_mesh.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

void check_valid(const TriangleMesh &mesh) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3 &v = mesh.vertices[i];
        const bool is_within = std::abs(v.x) <= mesh_reach && std::abs(v.y) <= mesh_reach &&
                               std::abs(v.z) <= mesh_reach;
        PLUMB_CHECK(is_within, "mesh vertex " << i << " must be finite and within " << mesh_reach
                                              << " m, got " << Printed{v});
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t corner : mesh.triangles[i])
            PLUMB_CHECK(corner < mesh.vertices.size(),
                        "mesh triangle " << i << " must have corners below " << mesh.vertices.size()
                                         << ", got " << corner);
}

Aabb bounds(const TriangleMesh &mesh) {
    check_valid(mesh);
    Aabb box;
    for (const std::array<std::uint32_t, 3> &corners : mesh.triangles)
        for (const std::uint32_t corner : corners) {
            box.min = glm::min(box.min, mesh.vertices[corner]);
            box.max = glm::max(box.max, mesh.vertices[corner]);
        }
    return box;
}

std::vector<std::uint32_t> same_places(const std::vector<Vec3> &vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    const auto key = [&](std::uint32_t i) {
        return std::tuple(vertices[i].x, vertices[i].y, vertices[i].z, i);
    };
    std::ranges::sort(order, {}, key);
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] =
            i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

bool is_closed(const TriangleMesh &mesh) {
    // An edge, keyed by its lower and higher corner index, and the direction in which it is used.
    struct Use {
        std::uint64_t edge;
        int direction;
    };
    std::vector<Use> uses;
    uses.reserve(3 * mesh.triangles.size());
    for (const std::array<std::uint32_t, 3> &corners : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t from = corners[i];
            const std::uint64_t to = corners[(i + 1) % 3];
            uses.push_back({std::min(from, to) << 32 | std::max(from, to), from < to ? 1 : -1});
        }
    std::sort(uses.begin(), uses.end(), [](Use a, Use b) { return a.edge < b.edge; });
    for (std::size_t i = 0; i < uses.size();) {
        const std::uint64_t edge = uses[i].edge;
        int sum = 0;
        for (; i < uses.size() && uses[i].edge == edge; ++i)
            sum += uses[i].direction;
        if (sum != 0 && edge >> 32 != (edge & 0xFFFF'FFFFU)) // a corner to itself is no edge
            return false;
    }
    return true;
}

} // namespace plumb::inline PLUMB_PRECISION
