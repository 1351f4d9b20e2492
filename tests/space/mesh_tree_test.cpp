#include "engine/space/mesh_tree.h"

#include "engine/core/check.h"
#include "engine/core/hash.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "tests/space/meshes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using oracle::any_direction;
using oracle::any_rotation;
using oracle::any_vector;
using oracle::V;
using oracle::wide;

constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr Real epsilon = std::numeric_limits<Real>::epsilon();

// --- An oracle in whole numbers ------------------------------------------------------------------

struct Whole {
    long long x, y, z;
    friend Whole operator+(Whole a, Whole b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Whole operator-(Whole a, Whole b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Whole operator*(long long s, Whole v) { return {s * v.x, s * v.y, s * v.z}; }
    friend bool operator==(Whole, Whole) = default;
};

long long dot(Whole a, Whole b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Whole cross(Whole a, Whole b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Whole whole(const Vec3 &v) {
    return {static_cast<long long>(v.x), static_cast<long long>(v.y), static_cast<long long>(v.z)};
}

struct Fraction {
    long long over, under; // under > 0
    Fraction(long long o, long long u) : over(u < 0 ? -o : o), under(u < 0 ? -u : u) {}
    friend bool operator<(Fraction a, Fraction b) { return a.over * b.under < b.over * a.under; }
    friend bool operator==(Fraction a, Fraction b) { return a.over * b.under == b.over * a.under; }
    double value() const { return double(over) / double(under); }
};

// The first t >= 0 on the closed triangle: by the point on its plane, and where there is none by
// clipping; not by edge functions of the line.
std::optional<Fraction> whole_hit(Whole o, Whole d, const Whole (&p)[3]) {
    const Whole zero{0, 0, 0};
    const Whole n = cross(p[1] - p[0], p[2] - p[0]);
    if (!(n == zero)) {
        const long long under = dot(n, d);
        const long long over = dot(n, p[0] - o);
        if (under != 0) {
            const Fraction t(over, under);
            if (t.over < 0)
                return std::nullopt;
            const Whole point = t.under * o + t.over * d; // times t.under
            for (int i = 0; i < 3; ++i)
                if (dot(n, cross(p[(i + 1) % 3] - p[i], point - t.under * p[i])) < 0)
                    return std::nullopt;
            return t;
        }
        if (over != 0)
            return std::nullopt;
        // Inside of edge i where f0 + f1 t >= 0.
        Fraction enter(0, 1);
        std::optional<Fraction> leave;
        for (int i = 0; i < 3; ++i) {
            const long long f0 = dot(n, cross(p[(i + 1) % 3] - p[i], o - p[i]));
            const long long f1 = dot(n, cross(p[(i + 1) % 3] - p[i], d));
            if (f1 == 0) {
                if (f0 < 0)
                    return std::nullopt;
                continue;
            }
            const Fraction t(-f0, f1);
            if (f1 > 0)
                enter = enter < t ? t : enter;
            else
                leave = !leave || t < *leave ? t : *leave;
        }
        if (leave && *leave < enter)
            return std::nullopt;
        return enter;
    }
    Whole a = p[0];
    Whole along = p[1] - p[0];
    for (int i = 1; i < 3; ++i)
        if (const Whole e = p[(i + 1) % 3] - p[i]; dot(e, e) > dot(along, along)) {
            a = p[i];
            along = e;
        }
    const Whole m = cross(along, d);
    if (m == zero) { // a point, or on a parallel
        if (!(cross(a - o, d) == zero))
            return std::nullopt;
        const Fraction one(dot(a - o, d), dot(d, d));
        const Fraction other(dot(a + along - o, d), dot(d, d));
        const Fraction first = one < other ? one : other;
        const Fraction last = one < other ? other : one;
        if (last.over < 0)
            return std::nullopt;
        return first.over < 0 ? Fraction(0, 1) : first;
    }
    if (dot(a - o, m) != 0)
        return std::nullopt;
    const Fraction t(dot(cross(a - o, along), cross(d, along)), dot(m, m));
    const Fraction s(dot(cross(a - o, d), cross(d, along)), dot(m, m));
    if (t.over < 0 || s.over < 0 || Fraction(1, 1) < s)
        return std::nullopt;
    return t;
}

Vec3 whole_vector(Random &random, int reach) {
    const auto component = [&] {
        return Real(int(random.next_index(std::uint32_t(2 * reach + 1))) - reach);
    };
    const Real x = component();
    const Real y = component();
    return {x, y, component()};
}

// Few places for the vertices, so that triangles are often flat, coplanar, or share corners.
TriangleMesh whole_soup(Random &random, int count, int reach) {
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

TEST(MeshTree, RaycastIsExactInWholeNumbers) {
    Random random(1);
    int hits = 0;
    int plane_hits = 0;
    for (int mesh_count = 0; mesh_count < trials(10'000); ++mesh_count) {
        const int reach = 1 + mesh_count % 6;
        const MeshTree mesh(whole_soup(random, 1 + int(random.next_index(24)), reach));
        for (int k = 0; k < 100; ++k) {
            Ray ray;
            ray.origin = whole_vector(random, reach + 1);
            do
                ray.direction = k % 2 == 0 ? whole_vector(random, 3)
                                           : mesh.mesh().vertices[random.next_index(
                                                 std::uint32_t(mesh.mesh().vertices.size()))] -
                                                 ray.origin;
            while (ray.direction == Vec3{Real(0)} && random.next_index(8) != 0);
            if (ray.direction == Vec3{Real(0)})
                continue;
            if (k % 3 == 0)
                ray.direction = -ray.direction;
            if (k % 5 == 0) // and some components -0
                ray.direction = Real(-1) * (Real(-1) * ray.direction);
            if (k % 4 == 0)
                ray.max_t = Real(random.next_index(5)) / Real(2);
            std::optional<Fraction> first;
            std::vector<std::uint32_t> firsts;
            for (std::uint32_t i = 0; i < mesh.mesh().triangles.size(); ++i) {
                const Triangle t = triangle(mesh.mesh(), i);
                const std::optional<Fraction> hit = whole_hit(
                    whole(ray.origin), whole(ray.direction), {whole(t.a), whole(t.b), whole(t.c)});
                if (!hit || hit->value() > double(ray.max_t))
                    continue;
                if (!first || *hit < *first) {
                    first = hit;
                    firsts.clear();
                }
                if (*hit == *first)
                    firsts.push_back(i);
            }
            const std::optional<MeshHit> found = raycast(mesh, ray);
            ASSERT_EQ(found.has_value(), first.has_value());
            ASSERT_EQ(is_met(mesh, ray), first.has_value());
            if (!found)
                continue;
            ++hits;
            ASSERT_NEAR(double(found->t), first->value(), 2.0 * epsilon * first->value());
            // Equal times may be rounded differently for flat triangles.
            ASSERT_NE(std::find(firsts.begin(), firsts.end(), found->triangle), firsts.end());
            const Triangle t = triangle(mesh.mesh(), found->triangle);
            const Whole n = cross(whole(t.b) - whole(t.a), whole(t.c) - whole(t.a));
            const long long with_front = dot(n, whole(ray.direction));
            plane_hits += with_front == 0 ? 1 : 0;
            if (with_front != 0 && firsts.size() == 1) {
                const long long side = dot(n, whole(ray.origin) - whole(t.a));
                const V front = glm::normalize(V{double(n.x), double(n.y), double(n.z)});
                ASSERT_LT(glm::length(wide(found->normal) - (side < 0 ? -front : front)),
                          4.0 * epsilon);
            }
            // The weights give the point, and the point is that on the ray.
            const Vec3 &w = found->barycentric;
            ASSERT_GE(std::min({w.x, w.y, w.z}), Real(0));
            ASSERT_NEAR(double(w.x + w.y + w.z), 1.0, 4.0 * epsilon);
            const V of_weights =
                double(w.x) * wide(t.a) + double(w.y) * wide(t.b) + double(w.z) * wide(t.c);
            const V of_ray = wide(ray.origin) + double(found->t) * wide(ray.direction);
            ASSERT_LT(glm::length(of_weights - wide(found->point)), 40.0 * epsilon);
            ASSERT_LT(glm::length(of_ray - wide(found->point)), 200.0 * epsilon);
        }
    }
    EXPECT_GT(hits, trials(1'000'000) / 10);
    EXPECT_GT(plane_hits, hits / 100);
}

// --- Against the triangles one by one ------------------------------------------------------------

struct Scene {
    const char *name;
    TriangleMesh mesh;
    double size;
    V middle;
};

std::vector<Scene> scenes() {
    Random random(77);
    std::vector<Scene> all;
    const V far{1e5, -1e5, 1e5};
    const auto turned = [&](const TriangleMesh &mesh, const V &position) {
        const Quat q = any_rotation(random);
        return meshes::placed(mesh, {double(q.w), double(q.x), double(q.y), double(q.z)}, position);
    };
    all.push_back({"torus", turned(meshes::torus(24, 12, 1.0, 0.4), V{0.0}), 1.4, V{0.0}});
    all.push_back({"far torus", turned(meshes::torus(24, 12, 10.0, 4.0), far), 14.0, far});
    all.push_back({"large sphere", meshes::sphere(20, 12, 1e5), 1e5, V{0.0}});
    all.push_back({"small sphere", meshes::sphere(20, 12, 1e-3), 1e-3, V{0.0}});
    all.push_back({"cube", meshes::cube(6, 3.0), 3.0, V{0.0}});
    all.push_back({"needles", turned(meshes::sphere(90, 3, 2.0), V{3.0}), 2.0, V{3.0}});
    TriangleMesh soup; // large, small, long and flat ones
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

// From anywhere, to anywhere, and to vertices and edges; along axes; of any length.
Ray any_ray(Random &random, const Scene &scene, int k) {
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
    Ray ray{meshes::narrowed(origin), meshes::narrowed(length * direction)};
    if (ray.direction == Vec3{Real(0)})
        ray.direction = Vec3{Real(0), Real(0), Real(1)};
    if (k % 6 == 0)
        ray.max_t = Real(random.next_in(0.0, 2.0) / length);
    return ray;
}

TEST(MeshTree, RaycastIsThatOfTheTrianglesOneByOne) {
    Random random(2);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        int hits = 0;
        const int count = trials(8'000);
        for (int k = 0; k < count; ++k) {
            const Ray ray = any_ray(random, scene, k);
            // By the triangle's own exact test: hit or not. By the mesh's: when, to the bit.
            const WideRay prepared = wide_ray(ray, mesh.tree().bounds());
            Real best = infinity;
            std::uint32_t best_triangle = 0;
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i) {
                const Triangle t = triangle(scene.mesh, i);
                Real time = Real(0);
                std::array<double, 3> edges{};
                const bool is_hit = meets(prepared, t, time, edges);
                ASSERT_EQ(is_hit, raycast(t, Ray{ray.origin, ray.direction, infinity}).has_value());
                if (is_hit && time <= prepared.max_time && time < best) {
                    best = time;
                    best_triangle = i;
                }
            }
            const std::optional<MeshHit> found = raycast(mesh, ray);
            ASSERT_EQ(found.has_value(), best < infinity);
            ASSERT_EQ(is_met(mesh, ray), best < infinity);
            if (!found)
                continue;
            ++hits;
            ASSERT_EQ(found->triangle, best_triangle);
            ASSERT_EQ(found->t, Real(double(best) * prepared.time_scale));
        }
        EXPECT_GT(hits, count / 4);
    }
}

// Against the plane's equation in long double, where the ray does not graze.
TEST(MeshTree, TimesAreRight) {
    Random random(3);
    using L = glm::vec<3, long double>;
    double worst = 0.0;
    for (const Scene &scene : scenes()) {
        const MeshTree mesh(scene.mesh);
        for (int k = 0; k < trials(150'000); ++k) {
            const Ray ray = any_ray(random, scene, k);
            const std::optional<MeshHit> found = raycast(mesh, ray);
            if (!found)
                continue;
            const Triangle t = triangle(scene.mesh, found->triangle);
            const L n = glm::cross(L(t.b) - L(t.a), L(t.c) - L(t.a));
            const L d(ray.direction);
            const long double steep =
                std::abs(glm::dot(n, d)) / (glm::length(n) * glm::length(d) + 1e-300L);
            if (!(steep > 0.02L))
                continue;
            const long double expected = glm::dot(n, L(t.a) - L(ray.origin)) / glm::dot(n, d);
            const L away = L(found->point) - L(ray.origin) - expected * d;
            const double coordinate =
                std::max({std::abs(double(ray.origin.x)), std::abs(double(ray.origin.y)),
                          std::abs(double(ray.origin.z)), glm::length(wide(t.a))});
            // Rounded once to Real, and moved by rounding of the boxes at most.
            const double bound =
                (4.0 * glm::length(wide(t.a) - wide(ray.origin)) + coordinate) * double(epsilon);
            const double error =
                std::abs(double(found->t) - double(expected)) * double(glm::length(d));
            worst = std::max(worst, error * double(steep) / bound);
            ASSERT_LE(error * double(steep), 4.0 * bound) << scene.name;
            ASSERT_LE(double(glm::length(away)) * double(steep), 8.0 * bound) << scene.name;
        }
    }
    RecordProperty("worst", std::to_string(worst));
}

// --- The same answer at every width --------------------------------------------------------------

std::uint64_t hash_of_answers(const std::vector<Scene> &all, int count) {
    StateHash hash;
    Random random(4);
    for (const Scene &scene : all) {
        const MeshTree mesh(scene.mesh);
        for (int k = 0; k < count; ++k) {
            const Ray ray = any_ray(random, scene, k);
            const std::optional<MeshHit> found = raycast(mesh, ray);
            hash.add(std::uint64_t(found.has_value()) + 2 * std::uint64_t(is_met(mesh, ray)));
            if (!found)
                continue;
            hash.add(found->t);
            hash.add(std::uint64_t(found->triangle));
            for (int i = 0; i < 3; ++i) {
                hash.add(found->point[i]);
                hash.add(found->normal[i]);
                hash.add(found->barycentric[i]);
            }
        }
    }
    return hash.value();
}

TEST(MeshTree, AnswersAreTheSameForEveryKindOfVectors) {
    const std::vector<Scene> all = scenes();
    const int count = trials(25'000);
    const std::uint64_t best = hash_of_answers(all, count);
    std::vector<std::string> targets;
    std::vector<std::size_t> chosen;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        EXPECT_EQ(hash_of_answers(all, count), best) << hwy::TargetName(target);
        targets.emplace_back(hwy::TargetName(target));
        chosen.push_back(hwy::GetChosenTarget().GetIndex());
    }
    hwy::SetSupportedTargetsForTest(0);
    std::string names;
    for (const std::string &name : targets)
        names += name + ' ';
    RecordProperty("targets", names);
    EXPECT_GE(targets.size(), 1U);
    std::sort(chosen.begin(), chosen.end());
    EXPECT_EQ(std::unique(chosen.begin(), chosen.end()), chosen.end()); // each was another
}

// --- Segments, shapes, points --------------------------------------------------------------------

TEST(MeshTree, LinetestIsThatOfTheTrianglesOneByOne) {
    Random random(5);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        int met = 0;
        const int count = trials(8'000);
        for (int k = 0; k < count; ++k) {
            const Ray ray = any_ray(random, scene, 4 * k + 1);
            const Vec3 a = ray.origin;
            Vec3 b = ray.origin + Real(random.next_in(0.0, 1.5)) * ray.direction;
            if (k % 10 == 0)
                b = scene.mesh
                        .vertices[random.next_index(std::uint32_t(scene.mesh.vertices.size()))];
            if (k % 50 == 0)
                b = a;
            bool expected = false;
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size() && !expected; ++i)
                expected = linetest(triangle(scene.mesh, i), a, b);
            ASSERT_EQ(linetest(mesh, a, b), expected);
            met += expected ? 1 : 0;
        }
        EXPECT_GT(met, count / 10);
    }
}

template <typename Shape, typename Make> void expect_overlaps_as_triangles(Make &&make) {
    Random random(6);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        int met = 0;
        const int count = trials(4'000);
        for (int k = 0; k < count; ++k) {
            const Ray ray = any_ray(random, scene, 4 * k + 1);
            const double size = scene.size * std::pow(10.0, random.next_in(-3.0, 0.0));
            const Vec3 place = ray.origin + Real(random.next_in(0.0, 1.5)) * ray.direction;
            const Shape shape = make(random, place, size);
            bool expected = false;
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size() && !expected; ++i)
                expected = overlaps(triangle(scene.mesh, i), shape);
            ASSERT_EQ(overlaps(mesh, shape), expected);
            met += expected ? 1 : 0;
        }
        if (count >= 1'000) {
            EXPECT_GT(met, count / 50);
            EXPECT_LT(met, count);
        }
    }
}

TEST(MeshTree, OverlapsASphereAsItsTrianglesDo) {
    expect_overlaps_as_triangles<Sphere>([](Random &, const Vec3 &place, double size) {
        return Sphere{place, Real(size)};
    });
}

TEST(MeshTree, OverlapsAnAabbAsItsTrianglesDo) {
    expect_overlaps_as_triangles<Aabb>([](Random &random, const Vec3 &place, double size) {
        return Aabb{place, place + glm::abs(any_vector(random, size))};
    });
}

TEST(MeshTree, OverlapsABoxAsItsTrianglesDo) {
    expect_overlaps_as_triangles<Box>([](Random &random, const Vec3 &place, double size) {
        return Box{place, any_rotation(random), glm::abs(any_vector(random, size))};
    });
}

TEST(MeshTree, OverlapsAPlaneAsItsTrianglesDo) {
    expect_overlaps_as_triangles<Plane>([](Random &random, const Vec3 &place, double) {
        const Vec3 normal = meshes::narrowed(any_direction(random));
        return Plane{normal, glm::dot(normal, place)};
    });
}

TEST(MeshTree, OverlapsATriangleAsItsTrianglesDo) {
    expect_overlaps_as_triangles<Triangle>([](Random &random, const Vec3 &place, double size) {
        return Triangle{place, place + any_vector(random, size), place + any_vector(random, size)};
    });
}

TEST(MeshTree, VisitsTheTrianglesInABoxAndNoOthers) {
    Random random(7);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        for (int k = 0; k < trials(2'000); ++k) {
            const Vec3 place = any_ray(random, scene, 4 * k + 1).origin;
            const Aabb box{place, place + glm::abs(any_vector(random, scene.size))};
            std::vector<int> visits(scene.mesh.triangles.size(), 0);
            visit_triangles(mesh, box, [&](std::uint32_t i) {
                ++visits[i];
                return true;
            });
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i)
                ASSERT_EQ(visits[i], overlaps(triangle(scene.mesh, i), box) ? 1 : 0);
        }
    }
}

TEST(MeshTree, ClosestPointIsThatOfTheTrianglesOneByOne) {
    Random random(8);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        for (int k = 0; k < trials(3'000); ++k) {
            const Vec3 point = any_ray(random, scene, k).origin;
            Vec3 best{Real(0)};
            Real best_squared = infinity;
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i) {
                const Vec3 here = closest_point(triangle(scene.mesh, i), point);
                const Vec3 away = here - point;
                if (glm::dot(away, away) < best_squared) {
                    best = here;
                    best_squared = glm::dot(away, away);
                }
            }
            ASSERT_EQ(closest_point(mesh, point), best);
        }
    }
}

// --- Inside --------------------------------------------------------------------------------------

TEST(MeshTree, ContainsIsExactForACubeOfWholeNumbers) {
    const int half = 3;
    const MeshTree mesh(meshes::cube(2 * half, half));
    ASSERT_TRUE(is_closed(mesh.mesh()));
    for (int x = -9; x <= 9; ++x) // halves too
        for (int y = -9; y <= 9; ++y)
            for (int z = -9; z <= 9; ++z) {
                const bool expected = std::max({std::abs(x), std::abs(y), std::abs(z)}) <= 2 * half;
                const Vec3 point = Vec3{Real(x), Real(y), Real(z)} / Real(2);
                ASSERT_EQ(contains(mesh, point), expected) << x << ' ' << y << ' ' << z;
                // Next to a face the answer turns at once.
                const Vec3 nudged{std::nextafter(point.x, infinity), point.y, point.z};
                const bool nudged_expected = expected && nudged.x <= Real(half);
                ASSERT_EQ(contains(mesh, nudged), nudged_expected);
            }
}

// The solid angle of the triangles around a point (van Oosterom and Strackee 1983) is 4 pi inside,
// 0 outside.
TEST(MeshTree, ContainsWhatTheMeshGoesAround) {
    Random random(9);
    for (const Scene &scene : scenes()) {
        if (std::string(scene.name) == "soup")
            continue;
        SCOPED_TRACE(scene.name);
        ASSERT_TRUE(is_closed(scene.mesh));
        const MeshTree mesh(scene.mesh);
        int inside = 0;
        int open = 0;
        const int count = trials(4'000);
        for (int k = 0; k < count; ++k) {
            Vec3 point = meshes::narrowed(scene.middle) + any_vector(random, scene.size);
            const Vec3 vertex =
                scene.mesh.vertices[random.next_index(std::uint32_t(scene.mesh.vertices.size()))];
            if (k % 3 == 1) // on a line with a vertex along x
                point = {point.x, vertex.y, vertex.z};
            double angle = 0.0;
            bool is_on = false;
            for (std::uint32_t i = 0; i < scene.mesh.triangles.size(); ++i) {
                const Triangle t = triangle(scene.mesh, i);
                is_on = is_on || contains(t, point);
                const V a = wide(t.a) - wide(point);
                const V b = wide(t.b) - wide(point);
                const V c = wide(t.c) - wide(point);
                const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
                angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
                                              glm::dot(c, a) * lb);
            }
            const double turns = angle / (4.0 * std::numbers::pi);
            if (is_on) {
                ASSERT_TRUE(contains(mesh, point));
                continue;
            }
            if (std::abs(turns - std::round(turns)) > 1e-3) {
                ++open; // too near to the surface for this
                continue;
            }
            ASSERT_EQ(contains(mesh, point), std::lround(turns) != 0) << turns;
            inside += std::lround(turns) != 0 ? 1 : 0;
            ASSERT_TRUE(contains(mesh, vertex));
        }
        if (count >= 1'000) {
            EXPECT_GT(inside, count / 20);
        }
        EXPECT_LE(open, count / 50);
    }
}

// --- Change, and misuse --------------------------------------------------------------------------

TEST(MeshTree, MovedVerticesAnswerAsANewTreeDoes) {
    Random random(10);
    Scene scene = scenes()[0];
    MeshTree moved(scene.mesh);
    for (int k = 0; k < 20; ++k) {
        for (Vec3 &v : scene.mesh.vertices)
            v += any_vector(random, 0.05);
        moved.move_vertices(scene.mesh.vertices);
        const MeshTree fresh(scene.mesh);
        for (int i = 0; i < trials(5'000); ++i) {
            const Ray ray = any_ray(random, scene, i);
            const std::optional<MeshHit> one = raycast(moved, ray);
            const std::optional<MeshHit> other = raycast(fresh, ray);
            ASSERT_EQ(one.has_value(), other.has_value());
            if (one) {
                ASSERT_EQ(one->t, other->t);
                ASSERT_EQ(one->triangle, other->triangle);
            }
        }
    }
}

TEST(MeshTree, OfNothingIsMetByNothing) {
    const MeshTree mesh(TriangleMesh{});
    EXPECT_FALSE(raycast(mesh, {}));
    EXPECT_FALSE(is_met(mesh, {}));
    EXPECT_FALSE(linetest(mesh, Vec3{Real(0)}, Vec3{Real(1)}));
    EXPECT_FALSE(overlaps(mesh, Sphere{}));
    EXPECT_FALSE(overlaps(mesh, Plane{}));
    EXPECT_FALSE(contains(mesh, Vec3{Real(0)}));
    EXPECT_THROW(closest_point(mesh, Vec3{Real(0)}), CheckFailure);
}

template <typename Ask> std::string message_of(Ask &&ask) {
    try {
        ask();
    } catch (const CheckFailure &failure) {
        return failure.what();
    }
    return "nothing failed";
}

TEST(MeshTree, RefusesWhatIsNotValid) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    TriangleMesh bad{{Vec3{Real(0)}, Vec3{Real(1)}, Vec3{Real(2)}}, {{0, 1, 2}, {0, 1, 3}}};
    EXPECT_NE(message_of([&] { MeshTree{bad}; }).find("below 3, got 3"), std::string::npos);
    bad.triangles.pop_back();
    bad.vertices[1].y = nan;
    EXPECT_NE(message_of([&] { MeshTree{bad}; }).find("vertex 1"), std::string::npos);
    EXPECT_NE(message_of([&] { MeshTree{bad}; }).find("(1, nan, 1)"), std::string::npos);
    bad.vertices[1].y = Real(1.5e8);
    EXPECT_NE(message_of([&] { MeshTree{bad}; }).find("1.5e+08"), std::string::npos);
    bad.vertices[1].y = Real(1);
    MeshTree mesh(bad);
    EXPECT_THROW(mesh.move_vertices({}), CheckFailure);

    const auto asked = [&](const Vec3 &origin, const Vec3 &direction, Real max_t) {
        return message_of([&] { raycast(mesh, {origin, direction, max_t}); });
    };
    const Vec3 zero{Real(0)};
    const Vec3 one{Real(1)};
    EXPECT_NE(asked(zero, zero, infinity).find("got (0, 0, 0)"), std::string::npos);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 wrong = one;
        wrong[axis] = nan;
        EXPECT_NE(asked(wrong, one, infinity).find("origin"), std::string::npos);
        EXPECT_NE(asked(one, wrong, infinity).find("direction"), std::string::npos);
        wrong[axis] = -infinity;
        EXPECT_NE(asked(wrong, one, infinity).find("-inf"), std::string::npos);
        EXPECT_NE(asked(one, wrong, infinity).find("-inf"), std::string::npos);
        wrong[axis] = Real(-2e8);
        EXPECT_NE(asked(wrong, one, infinity).find("-2e+08"), std::string::npos);
    }
    EXPECT_NE(asked(zero, one, nan).find("max_t"), std::string::npos);
    EXPECT_FALSE(raycast(mesh, {zero, one, Real(-1)}));
    EXPECT_THROW(is_met(mesh, {zero, zero, Real(1)}), CheckFailure);
    EXPECT_THROW(linetest(mesh, zero, Vec3{nan}), CheckFailure);
    EXPECT_THROW(contains(mesh, Vec3{nan}), CheckFailure);
    EXPECT_THROW(closest_point(mesh, Vec3{infinity}), CheckFailure);
}

TEST(MeshTree, KnowsWhetherAMeshIsClosed) {
    EXPECT_TRUE(is_closed(TriangleMesh{}));
    TriangleMesh mesh = meshes::torus(5, 4, 1.0, 0.3);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_TRUE(is_closed(meshes::sphere(5, 4, 1.0)));
    EXPECT_TRUE(is_closed(meshes::cube(2, 1.0)));
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    EXPECT_FALSE(is_closed(mesh));
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    mesh.triangles.pop_back();
    EXPECT_FALSE(is_closed(mesh));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
