#include "engine/space/mesh_tree.h"

#include "engine/core/check.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "tests/space/mesh_scenes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace meshes;
using oracle::any_direction;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

// --- Segments, shapes, points --------------------------------------------------------------------

// Calls ask(mesh, its tree, k) a million times: a hundred for each of many small meshes.
template <typename Ask> void for_a_million(Random &random, Ask &&ask) {
    for (int i = 0; i < trials(10'000); ++i) {
        const SmallMesh small = any_small_mesh(random);
        const MeshTree mesh(small.mesh);
        for (int k = 0; k < 100; ++k)
            ask(small, mesh, k);
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << "mesh " << i;
    }
}

template <typename Is> bool is_any(const TriangleMesh &mesh, Is &&is) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        if (is(triangle(mesh, i)))
            return true;
    return false;
}

TEST(MeshTree, AMillionLinetests) {
    Random random(11);
    int met = 0;
    for_a_million(random, [&](const SmallMesh &small, const MeshTree &mesh, int k) {
        const Vec3 a = any_place(random, small), b = k % 20 == 0 ? a : any_place(random, small);
        const bool expected =
            is_any(small.mesh, [&](const Triangle &t) { return linetest(t, a, b); });
        ASSERT_EQ(linetest(mesh, a, b), expected);
        met += expected ? 1 : 0;
    });
    EXPECT_GT(met, trials(1'000'000) / 10);
    EXPECT_LT(met, trials(1'000'000) / 10 * 9);
}

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
            const bool expected =
                is_any(scene.mesh, [&](const Triangle &t) { return linetest(t, a, b); });
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
            const bool expected =
                is_any(scene.mesh, [&](const Triangle &t) { return overlaps(t, shape); });
            ASSERT_EQ(overlaps(mesh, shape), expected);
            met += expected ? 1 : 0;
        }
        if (count >= 1'000) {
            EXPECT_GT(met, count / 50);
            EXPECT_LT(met, count);
        }
    }
    int met = 0;
    for_a_million(random, [&](const SmallMesh &small, const MeshTree &mesh, int) {
        const double size = any_length(random, small);
        const Shape shape = make(random, any_place(random, small), size);
        const bool expected =
            is_any(small.mesh, [&](const Triangle &t) { return overlaps(t, shape); });
        ASSERT_EQ(overlaps(mesh, shape), expected);
        met += expected ? 1 : 0;
    });
    EXPECT_GT(met, trials(1'000'000) / 10);
    EXPECT_LT(met, trials(1'000'000) / 10 * 9);
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

Vec3 closest_of_all(const TriangleMesh &mesh, const Vec3 &point) {
    Vec3 best{Real(0)};
    Real best_squared = infinity;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3 here = closest_point(triangle(mesh, i), point);
        const Vec3 away = here - point;
        if (glm::dot(away, away) < best_squared) {
            best = here;
            best_squared = glm::dot(away, away);
        }
    }
    return best;
}

TEST(MeshTree, ClosestPointIsThatOfTheTrianglesOneByOne) {
    Random random(8);
    for (const Scene &scene : scenes()) {
        SCOPED_TRACE(scene.name);
        const MeshTree mesh(scene.mesh);
        for (int k = 0; k < trials(3'000); ++k) {
            const Vec3 point = any_ray(random, scene, k).origin;
            ASSERT_EQ(closest_point(mesh, point), closest_of_all(scene.mesh, point));
        }
    }
}

TEST(MeshTree, AMillionClosestPoints) {
    Random random(12);
    for_a_million(random, [&](const SmallMesh &small, const MeshTree &mesh, int) {
        const Vec3 point = any_place(random, small) + any_vector(random, 0.5 * small.size);
        ASSERT_EQ(closest_point(mesh, point), closest_of_all(small.mesh, point));
    });
}

// --- Inside --------------------------------------------------------------------------------------

TEST(MeshTree, ContainsIsExactForACubeOfWholeNumbers) {
    const int half = 3;
    const MeshTree mesh(meshes::cube(2 * half, half));
    ASSERT_TRUE(is_closed(mesh.mesh()));
    for (int x = -9; x <= 9; ++x) // in half units
        for (int y = -9; y <= 9; ++y)
            for (int z = -9; z <= 9; ++z) {
                const bool expected = std::max({std::abs(x), std::abs(y), std::abs(z)}) <= 2 * half;
                const Vec3 point = Vec3{Real(x), Real(y), Real(z)} / Real(2);
                ASSERT_EQ(contains(mesh, point), expected) << x << ' ' << y << ' ' << z;
                // Just past a face the answer flips.
                const Vec3 nudged{std::nextafter(point.x, infinity), point.y, point.z};
                const bool nudged_expected = expected && nudged.x <= Real(half);
                ASSERT_EQ(contains(mesh, nudged), nudged_expected);
            }
}

// Whether a point is on a closed mesh, and the mesh's winding number around it: the triangles'
// solid angle (van Oosterom and Strackee 1983) is 4 pi inside, 0 outside.
struct Around {
    bool is_on = false;
    double turns = 0.0;
};

Around around(const TriangleMesh &mesh, const Vec3 &point) {
    Around result;
    double angle = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle t = triangle(mesh, i);
        result.is_on = result.is_on || contains(t, point);
        const V a = wide(t.a) - wide(point);
        const V b = wide(t.b) - wide(point);
        const V c = wide(t.c) - wide(point);
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
                                      glm::dot(c, a) * lb);
    }
    result.turns = angle / (4.0 * std::numbers::pi);
    return result;
}

TEST(MeshTree, AMillionPointsInsideOrNot) {
    Random random(13);
    const std::vector<TriangleMesh> kinds{meshes::cube(1, 1.0), meshes::sphere(3, 2, 1.0),
                                          meshes::sphere(4, 3, 1.0), meshes::torus(3, 3, 1.0, 0.4)};
    int inside = 0, open = 0;
    for (int i = 0; i < trials(10'000); ++i) {
        const double size = std::pow(10.0, random.next_in(-3.0, 4.0));
        TriangleMesh closed = kinds[random.next_index(4)];
        for (Vec3 &v : closed.vertices)
            v *= Real(size);
        const Quat q = oracle::awkward_rotation(random);
        const V middle = wide(any_vector(random, random.next_index(2) == 0 ? size : 100 * size));
        closed =
            meshes::placed(closed, {double(q.w), double(q.x), double(q.y), double(q.z)}, middle);
        const MeshTree mesh(closed);
        for (int k = 0; k < 100; ++k) {
            const Vec3 vertex =
                closed.vertices[random.next_index(std::uint32_t(closed.vertices.size()))];
            Vec3 point = meshes::narrowed(middle) + any_vector(random, size);
            if (k % 3 == 1) // level with a vertex along x
                point = {point.x, vertex.y, vertex.z};
            if (k % 20 == 2)
                point = vertex;
            const Around found = around(closed, point);
            const bool answer = contains(mesh, point);
            if (found.is_on) {
                ASSERT_TRUE(answer) << "mesh " << i;
            } else if (std::abs(found.turns - std::round(found.turns)) > 1e-3) {
                ++open; // too close to the surface to tell
            } else {
                ASSERT_EQ(answer, std::lround(found.turns) != 0) << "mesh " << i;
                inside += answer ? 1 : 0;
            }
        }
    }
    EXPECT_GT(inside, trials(1'000'000) / 20);
    EXPECT_LE(open, trials(1'000'000) / 50);
}

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
            if (k % 3 == 1) // level with a vertex along x
                point = {point.x, vertex.y, vertex.z};
            const auto [is_on, turns] = around(scene.mesh, point);
            if (is_on) {
                ASSERT_TRUE(contains(mesh, point));
                continue;
            }
            if (std::abs(turns - std::round(turns)) > 1e-3) {
                ++open; // too close to the surface to tell
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

TEST(MeshTree, VerticesMovedAMillionTimes) {
    Random random(11);
    TriangleMesh mesh{std::vector<Vec3>(4, Vec3{Real(0)}),
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    MeshTree moved(mesh);
    int hits = 0;
    const int count = trials(1'000'000);
    for (int k = 0; k < count; ++k) {
        for (Vec3 &v : mesh.vertices)
            v = any_vector(random, 1.0);
        moved.move_vertices(mesh.vertices);
        const MeshTree fresh(mesh);
        const Vec3 origin = any_vector(random, 2.0);
        const Ray ray{origin, any_vector(random, 0.5) - origin};
        const std::optional<MeshHit> one = raycast(moved, ray);
        const std::optional<MeshHit> other = raycast(fresh, ray);
        ASSERT_EQ(one.has_value(), other.has_value()) << "trial " << k;
        if (one) {
            ASSERT_EQ(one->t, other->t) << "trial " << k;
            ASSERT_EQ(one->triangle, other->triangle) << "trial " << k;
            ++hits;
        }
    }
    EXPECT_GT(hits, count / 20);
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
