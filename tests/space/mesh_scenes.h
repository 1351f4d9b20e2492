// Meshes and queries for the MeshTree tests.
#pragma once

#include "engine/geometry/triangle.h"
#include "tests/space/meshes.h"

#include <cmath>
#include <limits>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace meshes {

using oracle::any_rotation;
using oracle::any_vector;
using oracle::wide;

// --- Of whole numbers ----------------------------------------------------------------------------

inline Vec3 whole_vector(Random &random, int reach) {
    const auto component = [&] {
        return Real(int(random.next_index(std::uint32_t(2 * reach + 1))) - reach);
    };
    const Real x = component();
    const Real y = component();
    return {x, y, component()};
}

// Vertices in few places, so that triangles are often flat, coplanar, or share corners.
inline TriangleMesh whole_soup(Random &random, int count, int reach) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i)
        mesh.vertices.push_back(whole_vector(random, reach));
    for (int i = 0; i < count; ++i) {
        const auto any = [&] { return random.next_index(std::uint32_t(count)); };
        const std::uint32_t a = any();
        const std::uint32_t b = any();
        mesh.triangles.push_back({a, b, any()});
    }
    return mesh;
}

// --- Of all kinds --------------------------------------------------------------------------------

struct Scene {
    const char *name;
    TriangleMesh mesh;
    double size;
    V middle;
};

inline std::vector<Scene> scenes() {
    Random random(77);
    std::vector<Scene> all;
    const V far{1e5, -1e5, 1e5};
    const auto turned = [&](const TriangleMesh &mesh, const V &position) {
        const Quat q = any_rotation(random);
        return placed(mesh, {double(q.w), double(q.x), double(q.y), double(q.z)}, position);
    };
    all.push_back({"torus", turned(torus(24, 12, 1.0, 0.4), V{0.0}), 1.4, V{0.0}});
    all.push_back({"far torus", turned(torus(24, 12, 10.0, 4.0), far), 14.0, far});
    all.push_back({"large sphere", sphere(20, 12, 1e5), 1e5, V{0.0}});
    all.push_back({"small sphere", sphere(20, 12, 1e-3), 1e-3, V{0.0}});
    all.push_back({"cube", cube(6, 3.0), 3.0, V{0.0}});
    all.push_back({"needles", turned(sphere(90, 3, 2.0), V{3.0}), 2.0, V{3.0}});
    TriangleMesh soup; // large, small, long and flat triangles
    for (std::uint32_t i = 0; i < 400; ++i) {
        const Vec3 a = any_vector(random, 5.0);
        const double size = std::pow(10.0, random.next_in(-4.0, 1.0));
        soup.vertices.push_back(a);
        soup.vertices.push_back(a + any_vector(random, size));
        soup.vertices.push_back(i % 4 == 0 ? a : a + any_vector(random, size));
        soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    all.push_back({"soup", soup, 6.0, V{0.0}});
    return all;
}

// Rays from anywhere, to anywhere, to vertices and to edges; along axes; of any length.
inline Ray any_ray(Random &random, const Scene &scene, int k) {
    const auto &vertices = scene.mesh.vertices;
    const auto vertex = [&] {
        return wide(vertices[random.next_index(std::uint32_t(vertices.size()))]);
    };
    const double reach = scene.size * (k % 7 == 0 ? 100.0 : 1.5);
    V origin = scene.middle + wide(any_vector(random, reach));
    if (k % 11 == 0)
        origin = vertex();
    V target = scene.middle + wide(any_vector(random, scene.size));
    if (k % 3 == 1)
        target = vertex();
    if (k % 3 == 2) {
        const Triangle t =
            triangle(scene.mesh, random.next_index(std::uint32_t(scene.mesh.triangles.size())));
        const double part = random.next_index(4) == 0 ? 0.5 : random.next_unit();
        target = wide(t.a) + part * (wide(t.b) - wide(t.a));
    }
    V direction = target - origin;
    if (k % 5 == 0) {
        const int axis = int(random.next_index(3));
        direction = V{0.0};
        direction[axis] = random.next_index(2) == 0 ? 1.0 : -1.0;
        if (k % 2 == 0)
            direction[(axis + 1) % 3] = random.next_in(-1.0, 1.0);
        if (k % 10 == 0)
            direction[(axis + 2) % 3] = -0.0;
        origin = target - random.next_in(-1.0, 1.0) * scene.size * direction;
    }
    const double length = k % 4 == 0 ? std::pow(10.0, random.next_in(-6.0, 6.0)) : 1.0;
    Ray ray{narrowed(origin), narrowed(length * direction)};
    if (ray.direction == Vec3{Real(0)})
        ray.direction = Vec3{Real(0), Real(0), Real(1)};
    if (k % 6 == 0)
        ray.max_t = Real(random.next_in(0.0, 2.0) / length);
    return ray;
}

// --- Small, so that a million questions can be asked to each triangle ----------------------------

struct SmallMesh {
    TriangleMesh mesh;
    double size = 1.0;
    bool is_whole = false;
};

// Half have integer vertices, half any size and place.
inline SmallMesh any_small_mesh(Random &random) {
    const int count = 1 + int(random.next_index(12));
    if (random.next_index(2) == 0) {
        const int reach = 1 + int(random.next_index(4));
        return {whole_soup(random, count, reach), double(reach), true};
    }
    SmallMesh small;
    small.size = std::pow(10.0, random.next_in(-3.0, 5.0));
    const Vec3 middle = any_vector(random, random.next_index(2) == 0 ? small.size : 1e5);
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        const double reach = small.size * std::pow(10.0, random.next_in(-3.0, 0.0));
        const Vec3 a = middle + any_vector(random, small.size);
        small.mesh.vertices.push_back(a);
        small.mesh.vertices.push_back(a + any_vector(random, reach));
        small.mesh.vertices.push_back(i % 4 == 3 ? a : a + any_vector(random, reach));
        small.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return small;
}

// On a vertex or an edge, or near one.
inline Vec3 any_place(Random &random, const SmallMesh &small) {
    const std::uint32_t kind = random.next_index(4);
    if (small.is_whole && kind != 0)
        return whole_vector(random, int(small.size) + 1);
    const Triangle t =
        triangle(small.mesh, random.next_index(std::uint32_t(small.mesh.triangles.size())));
    const Vec3 on_edge = kind == 1 ? t.a : glm::mix(t.a, t.b, Real(random.next_unit()));
    return kind < 3 ? on_edge : on_edge + any_vector(random, small.size * random.next_in(0.0, 2.0));
}

// A length that is common in integer meshes.
inline double any_length(Random &random, const SmallMesh &small) {
    return small.is_whole ? double(random.next_index(4))
                          : small.size * std::pow(10.0, random.next_in(-3.0, 0.3));
}

} // namespace meshes
} // namespace plumb::inline PLUMB_PRECISION
