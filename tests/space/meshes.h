// Closed meshes and triangle soups for tests.
#pragma once

#include "engine/geometry/triangle_mesh.h"
#include "tests/geometry/oracle.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace plumb::inline PLUMB_PRECISION {
namespace meshes {

using oracle::V;

inline Vec3 narrowed(const V &v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}

// A grid of `columns` x `rows` points on a surface that closes in both directions; at(u, v) takes u
// and v in [0, 1). Faces outwards if u x v does.
inline TriangleMesh torus_of(int columns, int rows, const std::function<V(double, double)> &at) {
    TriangleMesh mesh;
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j)
            mesh.vertices.push_back(narrowed(at(double(i) / columns, double(j) / rows)));
    const auto index = [&](int i, int j) { return std::uint32_t((i % columns) * rows + j % rows); };
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    return mesh;
}

// Around y: a tube of radius `thin` along a circle of radius `wide`.
inline TriangleMesh torus(int columns, int rows, double wide, double thin) {
    constexpr double turn = 2.0 * std::numbers::pi;
    return torus_of(columns, rows, [=](double u, double v) {
        const double from_axis = wide + thin * std::cos(turn * v);
        return V{from_axis * std::cos(turn * u), -thin * std::sin(turn * v),
                 -from_axis * std::sin(turn * u)};
    });
}

// Poles on y, whose triangles are needles when there are many columns.
inline TriangleMesh sphere(int columns, int rows, double radius) {
    constexpr double half_turn = std::numbers::pi;
    TriangleMesh mesh;
    mesh.vertices.push_back(narrowed({0.0, radius, 0.0}));
    for (int j = 1; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double tilt = half_turn * j / rows;
            const double turn = 2.0 * half_turn * i / columns;
            mesh.vertices.push_back(
                narrowed(radius * V{std::sin(tilt) * std::cos(turn), std::cos(tilt),
                                    -std::sin(tilt) * std::sin(turn)}));
        }
    mesh.vertices.push_back(narrowed({0.0, -radius, 0.0}));
    const auto last = std::uint32_t(mesh.vertices.size() - 1);
    const auto index = [&](int i, int j) {
        return std::uint32_t(1 + (j - 1) * columns + i % columns);
    };
    for (int i = 0; i < columns; ++i) {
        mesh.triangles.push_back({0, index(i, 1), index(i + 1, 1)});
        for (int j = 1; j + 1 < rows; ++j) {
            mesh.triangles.push_back({index(i, j), index(i, j + 1), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i + 1, j)});
        }
        mesh.triangles.push_back({index(i, rows - 1), last, index(i + 1, rows - 1)});
    }
    return mesh;
}

// The cube from -half to half, each face of `count` x `count` squares; their corners are integer
// multiples of 2 half / count. Vertices are shared within and between faces.
inline TriangleMesh cube(int count, double half) {
    TriangleMesh mesh;
    std::vector<std::uint32_t> known(std::size_t((count + 1) * (count + 1) * (count + 1)),
                                     0xFFFF'FFFFU);
    const auto index = [&](const int(&at)[3]) {
        std::uint32_t &vertex =
            known[std::size_t((at[0] * (count + 1) + at[1]) * (count + 1) + at[2])];
        if (vertex == 0xFFFF'FFFFU) {
            vertex = std::uint32_t(mesh.vertices.size());
            const auto place = [&](int k) { return half * (2.0 * k / count - 1.0); };
            mesh.vertices.push_back(narrowed({place(at[0]), place(at[1]), place(at[2])}));
        }
        return vertex;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, count})
            for (int i = 0; i < count; ++i)
                for (int j = 0; j < count; ++j) {
                    std::uint32_t corners[4] = {};
                    for (int k = 0; k < 4; ++k) {
                        int at[3] = {};
                        at[axis] = side;
                        at[(axis + 1) % 3] = i + (k == 1 || k == 2 ? 1 : 0);
                        at[(axis + 2) % 3] = j + (k >= 2 ? 1 : 0);
                        corners[k] = index(at);
                    }
                    if (side == 0)
                        std::swap(corners[1], corners[3]);
                    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
                    mesh.triangles.push_back({corners[0], corners[2], corners[3]});
                }
    return mesh;
}

// Rotates and translates, rounding once.
inline TriangleMesh placed(TriangleMesh mesh, const glm::dquat &rotation, const V &position) {
    for (Vec3 &v : mesh.vertices)
        v = narrowed(rotation * oracle::wide(v) + position);
    return mesh;
}

} // namespace meshes
} // namespace plumb::inline PLUMB_PRECISION
