// Rays against mesh trees.

#include "engine/core/hash.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "engine/space/mesh_tree.h"
#include "tests/space/mesh_scenes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace meshes;

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

// The first t >= 0 on the closed triangle: from the point on its plane, or by clipping if there is
// none; not from the line's edge functions.
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
            const Whole point = t.under * o + t.over * d; // scaled by t.under
            for (int i = 0; i < 3; ++i)
                if (dot(n, cross(p[(i + 1) % 3] - p[i], point - t.under * p[i])) < 0)
                    return std::nullopt;
            return t;
        }
        if (over != 0)
            return std::nullopt;
        // Inside edge i where f0 + f1 t >= 0.
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
    if (m == zero) { // degenerate to a point, or parallel
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
            if (k % 5 == 0) // some components -0
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
            // Equal times may round differently for flat triangles.
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
            // The barycentric weights and the ray both give the point.
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

TEST(MeshTree, RaycastIsThatOfTheTrianglesOneByOne) {
    Random random(2);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        int hits = 0;
        const int count = trials(8'000);
        for (int k = 0; k < count; ++k) {
            const Ray ray = any_ray(random, scene, k);
            // The triangle's exact test decides hit or miss; the mesh's ray gives the time, bit for
            // bit.
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

// Against the plane equation in long double, unless the ray grazes.
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
            // Rounded once to Real, and shifted at most by the rounding of the boxes.
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
    EXPECT_EQ(std::unique(chosen.begin(), chosen.end()), chosen.end()); // all different
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
