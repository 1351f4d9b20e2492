#include "engine/scene/shape_models.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// Triangulates a grid of points over [0, 1] x [0, 1]; a direction that closes wraps its last row to
// its first. Coincident points (a ball's poles) share one vertex.
template <typename Place>
MeshData grid(int rows, int columns, bool closes_u, bool closes_v, const Place &place) {
    MeshData mesh;
    const int points_u = closes_u ? rows : rows + 1;
    const int points_v = closes_v ? columns : columns + 1;
    std::vector<std::uint32_t> vertex;
    for (int u = 0; u < points_u; ++u)
        for (int v = 0; v < points_v; ++v) {
            const glm::dvec3 point =
                place(static_cast<double>(u) / rows, static_cast<double>(v) / columns);
            // Only neighbours within a row can coincide.
            const bool is_new = v == 0 || mesh.vertices.back() != point;
            if (is_new)
                mesh.vertices.push_back(point);
            vertex.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
        }
    const auto at = [&](int u, int v) {
        return vertex[static_cast<std::size_t>((u % points_u) * points_v + v % points_v)];
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a)
            mesh.triangles.push_back({a, b, c});
    };
    for (int u = 0; u < rows; ++u)
        for (int v = 0; v < columns; ++v) {
            add(at(u, v), at(u + 1, v), at(u + 1, v + 1));
            add(at(u, v), at(u + 1, v + 1), at(u, v + 1));
        }
    return mesh;
}

// Within [-1, 1] on each axis; fronts face outwards.
MeshData unit_model(MeshModel::Kind kind, int detail) {
    using enum MeshModel::Kind;
    const auto on_ball = [](double u, double v) {
        // Exact poles, so that their copies coincide.
        const double ring = u == 0 || u == 1 ? 0 : std::sin(std::numbers::pi * u);
        return glm::dvec3(ring * std::sin(2 * std::numbers::pi * v),
                          u == 1 ? -1 : std::cos(std::numbers::pi * u),
                          ring * std::cos(2 * std::numbers::pi * v));
    };
    if (kind == ball)
        return grid(detail, 2 * detail, false, true, on_ball);
    if (kind == bowl)
        return grid(detail, 2 * detail, false, true, [&](double u, double v) {
            return -on_ball(0.5 * u, v) * glm::dvec3(1, 1, -1);
        });
    if (kind == torus)
        return grid(2 * detail, detail, true, true, [](double u, double v) {
            const double ring = 0.7 + 0.3 * std::cos(2 * std::numbers::pi * v);
            return glm::dvec3(ring * std::sin(2 * std::numbers::pi * u),
                              std::sin(2 * std::numbers::pi * v),
                              ring * std::cos(2 * std::numbers::pi * u));
        });
    // A tube around a trefoil.
    const auto on_knot = [](double u) {
        const double t = 2 * std::numbers::pi * u;
        return glm::dvec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t),
                          -std::sin(3 * t)) /
               3.0;
    };
    return grid(8 * detail, detail, true, true, [&](double u, double v) {
        const glm::dvec3 along = glm::normalize(on_knot(u + 1e-4) - on_knot(u - 1e-4));
        const glm::dvec3 side = glm::normalize(glm::cross(along, glm::dvec3(0, 0, 1)));
        const glm::dvec3 up = glm::cross(side, along);
        return 0.85 * on_knot(u) + 0.14 * (std::cos(2 * std::numbers::pi * v) * side +
                                           std::sin(2 * std::numbers::pi * v) * up);
    });
}

double spacing_of(const HillsModel &hills) {
    return 2 * hills.half_extents.x / hills.detail;
}

double rows_of(const HillsModel &hills) {
    return std::max(2.0, std::round(2 * hills.half_extents.z / spacing_of(hills)) + 1);
}

} // namespace

MeshData make_mesh(const MeshModel &model) {
    MeshData mesh = unit_model(model.kind, model.detail);
    for (glm::dvec3 &vertex : mesh.vertices)
        vertex *= model.half_extents;
    return mesh;
}

double sample_count(const HillsModel &hills) {
    return rows_of(hills) * (hills.detail + 1);
}

void make_heights(HeightFieldDesc &field) {
    const HillsModel &hills = *field.hills;
    field.spacing = spacing_of(hills);
    field.columns = hills.detail + 1;
    field.rows = static_cast<int>(rows_of(hills));
    std::vector<double> heights;
    for (int row = 0; row < field.rows; ++row)
        for (int column = 0; column < field.columns; ++column) {
            const double x = column * field.spacing - hills.half_extents.x;
            const double z = row * field.spacing - hills.half_extents.z;
            heights.push_back(hills.half_extents.y *
                              (0.7 * std::sin(0.9 * x + 0.4 * z) * std::cos(0.8 * z) +
                               0.3 * std::sin(1.7 * z - 0.6 * x)));
        }
    field.heights = std::make_shared<const std::vector<double>>(std::move(heights));
}

} // namespace plumb
