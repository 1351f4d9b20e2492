// No ray leaks out of a closed mesh or into it.

#include "engine/geometry/raycast.h"
#include "engine/math/predicates.h"
#include "engine/space/mesh_tree.h"
#include "tests/space/meshes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using oracle::any_direction;
using oracle::any_rotation;
using oracle::any_vector;
using oracle::V;
using oracle::wide;

// A closed mesh, and points inside it by far more than its vertices' rounding.
struct Closed {
    const char *name;
    TriangleMesh mesh;
    std::vector<Vec3> inside;
    V middle;
    double size; // everything lies within this distance of the middle
};

std::vector<Closed> closed_meshes() {
    Random random(1);
    std::vector<Closed> all;
    const auto add = [&](const char *name, const TriangleMesh &mesh, std::vector<V> inside,
                         double size, bool is_turned, const V &position) {
        const Quat q = is_turned ? any_rotation(random) : identity_rotation;
        const glm::dquat rotation{double(q.w), double(q.x), double(q.y), double(q.z)};
        Closed closed{name, meshes::placed(mesh, rotation, position), {}, position, size};
        for (const V &p : inside)
            closed.inside.push_back(meshes::narrowed(rotation * p + position));
        all.push_back(closed);
    };
    const V here{0.0};
    const V far{1e5, -1e5, 1e5};
    std::vector<V> ring;
    for (int i = 0; i < 16; ++i)
        ring.push_back(
            {std::cos(i * std::numbers::pi / 8), 0.0, std::sin(i * std::numbers::pi / 8)});
    const std::vector<V> center{V{0.0}};
    const std::vector<V> around{V{0.0}, V{0.25, 0.1, -0.2}, V{-0.3, 0.0, 0.3}};
    add("sphere", meshes::sphere(40, 20, 1.0), around, 1.0, true, here);
    add("sphere along the axes", meshes::sphere(40, 20, 1.0), around, 1.0, false, here);
    add("far sphere", meshes::sphere(40, 20, 1.0), around, 1.0, true, far);
    add("torus", meshes::torus(60, 30, 1.0, 0.4), ring, 1.4, true, here);
    add("far torus", meshes::torus(60, 30, 1.0, 0.4), ring, 1.4, true, far);
    add("cube", meshes::cube(8, 1.0), around, 1.8, false, here);
    add("finely divided cube", meshes::cube(40, 1.0), around, 1.0, true, here);
    add("finely divided far cube", meshes::cube(40, 1.0), around, 1.0, true, far);
    add("finely divided far cube along the axes", meshes::cube(40, 1.0), around, 1.0, false, far);
    add("needles", meshes::sphere(100, 3, 1.0), around, 1.0, true, here);
    add("far needles", meshes::sphere(100, 3, 1.0), around, 1.0, true, far);
    std::vector<V> along;
    for (int i = -4; i <= 4; ++i)
        along.push_back({0.0, 0.0, 2e4 * i});
    TriangleMesh rod = meshes::cube(6, 1.0); // 200 km long, 2 m wide
    for (Vec3 &v : rod.vertices)
        v.z *= Real(1e5);
    add("rod", rod, along, 1e5, false, here);
    TriangleMesh sheet = meshes::cube(16, 1.0); // 2 mm thin
    for (Vec3 &v : sheet.vertices)
        v.y *= Real(1e-3);
    add("sheet", sheet, around, 1.0, false, here);
    for (Vec3 &p : all.back().inside)
        p.y = Real(0);
    return all;
}

// A vertex, a point on an edge, or a point on a triangle.
V any_target(Random &random, const TriangleMesh &mesh, int kind) {
    const Triangle t = triangle(mesh, random.next_index(std::uint32_t(mesh.triangles.size())));
    if (kind == 0)
        return wide(t.a);
    const double s = random.next_index(4) == 0 ? 0.5 : random.next_unit();
    const V on_edge = wide(t.a) + s * (wide(t.b) - wide(t.a));
    return kind == 1 ? on_edge : on_edge + random.next_unit() * (wide(t.c) - on_edge);
}

Vec3 stretched(Random &random, const V &direction) {
    return meshes::narrowed(
        direction * (random.next_index(4) == 0 ? std::pow(10.0, random.next_in(-6.0, 6.0)) : 1.0));
}

TEST(Watertight, EveryRayFromInsideHits) {
    Random random(2);
    const std::vector<Closed> all = closed_meshes();
    // Ten million in the two precisions together; exact signs take longer in double.
    const int total = sizeof(Real) == sizeof(float) ? 8'000'000 : 2'100'000;
    const int count = trials(total) / int(all.size());
    for (const Closed &closed : all) {
        SCOPED_TRACE(closed.name);
        ASSERT_TRUE(is_closed(closed.mesh));
        const MeshTree mesh(closed.mesh);
        for (const Vec3 &origin : closed.inside)
            ASSERT_TRUE(contains(mesh, origin));
        int misses = 0;
        for (int k = 0; k < count; ++k) {
            const Vec3 origin = closed.inside[std::size_t(k) % closed.inside.size()];
            V direction = any_target(random, closed.mesh, k % 4) - wide(origin);
            if (k % 16 == 3) // along an axis or in a coordinate plane
                direction[int(random.next_index(3))] = k % 32 == 3 ? 0.0 : -0.0;
            if (k % 64 == 3)
                direction[int(random.next_index(3))] = 0.0;
            Ray ray{origin, stretched(random, direction)};
            if (ray.direction == Vec3{Real(0)})
                ray.direction = Vec3{Real(0), Real(-1), Real(0)};
            misses += raycast(mesh, ray).has_value() ? 0 : 1;
            if (k % 8 == 0)
                misses += is_met(mesh, ray) ? 0 : 1;
        }
        EXPECT_EQ(misses, 0);
    }
}

TEST(Watertight, EveryWayInHits) {
    Random random(3);
    for (const Closed &closed : closed_meshes()) {
        SCOPED_TRACE(closed.name);
        const MeshTree mesh(closed.mesh);
        int misses = 0;
        for (int k = 0; k < trials(20'000); ++k) {
            const Vec3 inside = closed.inside[std::size_t(k) % closed.inside.size()];
            // Inwards through a vertex, an edge or a triangle.
            const V target = any_target(random, closed.mesh, k % 3);
            const V out = glm::normalize(target - wide(inside));
            const double far = closed.size * random.next_in(4.0, 20.0);
            const Vec3 outside = meshes::narrowed(wide(inside) + far * out);
            misses += raycast(mesh, {outside, inside - outside, Real(1)}).has_value() ? 0 : 1;
            misses += linetest(mesh, outside, inside) ? 0 : 1;
        }
        EXPECT_EQ(misses, 0);
    }
}

// A ray from outside enters as often as it leaves. Counted only where, by exact signs, its line
// misses every edge and corner.
TEST(Watertight, RaysFromOutsideCrossAnEvenNumberOfTimes) {
    Random random(4);
    for (const Closed &closed : closed_meshes()) {
        SCOPED_TRACE(closed.name);
        const int triangles = int(closed.mesh.triangles.size());
        const MeshTree mesh(closed.mesh);
        int counted = 0;
        const int count = std::max(20, trials(4'000'000) / triangles);
        for (int k = 0; k < count; ++k) {
            const V target = any_target(random, closed.mesh, k % 3);
            const V origin =
                closed.middle + closed.size * random.next_in(2.0, 9.0) * any_direction(random);
            const Ray ray{meshes::narrowed(origin), stretched(random, target - origin)};
            const WideRay prepared = wide_ray(ray, mesh.tree().bounds());
            int crossings = 0;
            bool is_clear = true;
            for (int i = 0; i < triangles; ++i) {
                const Triangle t = triangle(closed.mesh, std::size_t(i));
                Real time = Real(0);
                std::array<double, 3> edges{};
                if (!meets(prepared, t, time, edges))
                    continue;
                ++crossings;
                is_clear = is_clear && triple_sign(ray.direction, ray.origin, t.a, t.b) != 0 &&
                           triple_sign(ray.direction, ray.origin, t.b, t.c) != 0 &&
                           triple_sign(ray.direction, ray.origin, t.c, t.a) != 0;
            }
            ASSERT_EQ(raycast(mesh, ray).has_value(), crossings > 0);
            if (!is_clear)
                continue;
            ASSERT_EQ(crossings % 2, 0);
            ++counted;
        }
        EXPECT_GT(counted, count / 4);
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
