#include "engine/geometry/quickhull.h"

#include "engine/core/check.h"
#include "tests/geometry/hull_points.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <set>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
constexpr int no_limit = 1 << 20;

// --- What holds for every mesh, whatever the points --------------------------------------------

__extension__ typedef __float128 Big; // 113 bits: products of three floats are exact

struct BigVector {
    Big x, y, z;
    explicit BigVector(const Vec3 &v) : x(v.x), y(v.y), z(v.z) {}
    BigVector(Big px, Big py, Big pz) : x(px), y(py), z(pz) {}
    BigVector operator-(const BigVector &o) const { return {x - o.x, y - o.y, z - o.z}; }
};

BigVector cross(const BigVector &a, const BigVector &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Big dot(const BigVector &a, const BigVector &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Big magnitude(Big x) {
    return x < 0 ? -x : x;
}

Big size(const BigVector &v) {
    return magnitude(v.x) + magnitude(v.y) + magnitude(v.z);
}

struct Report {
    double greatest_height = 0.0; // of an input point above a face's plane
    double deepest_corner = 0.0;  // of a face, below its plane
};

// Closed, convex, made of input points, with consistent tables. Uses nothing from the engine.
Report check_mesh(const HullMesh &mesh, const std::vector<Vec3> &points) {
    Report report;
    const std::size_t v = mesh.vertices.size(), f = mesh.faces.size(), e = mesh.edges.size();
    EXPECT_EQ(v + f, e + 2) << v << " vertices, " << f << " faces, " << e << " edges"; // Euler
    EXPECT_EQ(mesh.planes.size(), f);
    EXPECT_EQ(mesh.face_corners.size(), f);
    EXPECT_EQ(mesh.vertex_indices.size(), 2 * e);

    const auto less = [](const Vec3 &a, const Vec3 &b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    };
    std::vector<Vec3> sorted = points;
    std::sort(sorted.begin(), sorted.end(), less);
    Aabb box;
    for (const Vec3 &vertex : mesh.vertices) {
        EXPECT_TRUE(std::binary_search(sorted.begin(), sorted.end(), vertex, less));
        box.min = glm::min(box.min, vertex);
        box.max = glm::max(box.max, vertex);
    }
    EXPECT_EQ(mesh.box.min, box.min);
    EXPECT_EQ(mesh.box.max, box.max);

    // Each directed edge of a loop is one side of exactly one edge.
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> face_at;
    for (std::uint32_t face = 0; face < f; ++face) {
        const HullMesh::Face &loop = mesh.faces[face];
        EXPECT_GE(loop.count, 3u);
        for (std::uint32_t i = 0; i < loop.count; ++i) {
            const std::uint32_t from = mesh.vertex_indices[loop.first + i];
            const std::uint32_t to = mesh.vertex_indices[loop.first + (i + 1) % loop.count];
            EXPECT_TRUE(face_at.insert({{from, to}, face}).second);
        }
    }
    EXPECT_EQ(face_at.size(), 2 * e);
    std::vector<std::set<std::uint32_t>> around(v);
    for (const HullMesh::Edge &edge : mesh.edges) {
        EXPECT_EQ((face_at[{edge.a, edge.b}]), edge.left_face);
        EXPECT_EQ((face_at[{edge.b, edge.a}]), edge.right_face);
        around[edge.a].insert(edge.b);
        around[edge.b].insert(edge.a);
    }
    for (std::uint32_t i = 0; i < v; ++i) {
        EXPECT_GE(around[i].size(), 3u);
        const auto *first = mesh.neighbors.data() + mesh.first_neighbor[i];
        const auto *last = mesh.neighbors.data() + mesh.first_neighbor[i + 1];
        EXPECT_EQ(std::set<std::uint32_t>(first, last), around[i]);
        EXPECT_EQ(static_cast<std::size_t>(last - first), around[i].size());
    }

    // Planes: unit normals pointing outwards, no vertex in front. Exactly so for the three corners.
    for (std::uint32_t face = 0; face < f; ++face) {
        const Plane &plane = mesh.planes[face];
        const BigVector normal(plane.normal);
        EXPECT_NEAR(double(dot(normal, normal)), 1.0, 4 * epsilon);
        Big nearest = -1e300;
        for (const Vec3 &vertex : mesh.vertices)
            nearest = std::max(nearest, dot(normal, BigVector(vertex)) - Big(plane.offset));
        EXPECT_LE(double(nearest), 0.0);
        const auto &[a, b, c] = mesh.face_corners[face];
        const BigVector base(mesh.vertices[a]);
        const BigVector to_b = BigVector(mesh.vertices[b]) - base;
        const BigVector to_c = BigVector(mesh.vertices[c]) - base;
        const BigVector across = cross(to_b, to_c);
        EXPECT_GT(double(dot(across, normal)), 0.0);
        for (const Vec3 &vertex : mesh.vertices) {
            const BigVector d = BigVector(vertex) - base;
            // Exact for floats; with doubles even __float128 rounds.
            const Big rounding = sizeof(Real) == sizeof(float)
                                     ? Big(0)
                                     : Big(0x1p-108) * size(to_b) * size(to_c) * size(d);
            EXPECT_LE(double(dot(across, d) - rounding), 0.0);
        }
        std::set<std::uint32_t> loop;
        for (std::uint32_t i = 0; i < mesh.faces[face].count; ++i) {
            loop.insert(mesh.vertex_indices[mesh.faces[face].first + i]);
            const Vec3 &corner = mesh.vertices[mesh.vertex_indices[mesh.faces[face].first + i]];
            report.deepest_corner = std::max(
                report.deepest_corner, double(Big(plane.offset) - dot(normal, BigVector(corner))));
        }
        EXPECT_EQ(loop.count(a) + loop.count(b) + loop.count(c), 3u);
    }
    for (const Vec3 &point : points)
        for (const Plane &plane : mesh.planes)
            report.greatest_height =
                std::max(report.greatest_height,
                         glm::dot(wide(plane.normal), wide(point)) - double(plane.offset));

    // Volume by the divergence theorem: a third of height times area for each face. A loop's area
    // is taken with its corners relative to the middle of the mesh.
    V middle{0.0};
    for (const Vec3 &vertex : mesh.vertices)
        middle += wide(vertex) / double(v);
    double volume = 0.0, surface = 0.0;
    const double reach = glm::length(glm::max(glm::abs(wide(box.min)), glm::abs(wide(box.max))));
    for (std::uint32_t face = 0; face < f; ++face) {
        const HullMesh::Face &loop = mesh.faces[face];
        V area{0.0};
        for (std::uint32_t i = 0; i < loop.count; ++i) {
            const V p = wide(mesh.vertices[mesh.vertex_indices[loop.first + i]]) - middle;
            const V q =
                wide(mesh.vertices[mesh.vertex_indices[loop.first + (i + 1) % loop.count]]) -
                middle;
            area += 0.5 * glm::cross(p, q);
        }
        const V corner = wide(mesh.vertices[mesh.face_corners[face][0]]) - middle;
        volume += glm::dot(corner, area) / 3.0;
        surface += glm::length(area);
    }
    // A product of three edges is rounded by some 1e-16 of their lengths, however small it is.
    const double extent = glm::length(wide(box.max) - wide(box.min));
    EXPECT_NEAR(double(mesh.volume), volume,
                epsilon * volume + surface * (report.deepest_corner + 1e-15 * reach) +
                    1e-16 * double(f) * extent * extent * extent);
    return report;
}

TEST(Quickhull, ExactOnTheLattice) {
    Random random(1);
    int solids = 0, flats = 0;
    const int count = trials(12000);
    for (int trial = 0; trial < count; ++trial) {
        const std::uint32_t reach = 1 + random.next_index(trial % 4 == 0 ? 10 : 3);
        const std::size_t size = 4 + random.next_index(9);
        const std::int64_t shift = trial % 5 == 0 ? 1000 : 0;
        std::vector<Lattice> lattice;
        std::vector<Vec3> points;
        for (std::size_t i = 0; i < size; ++i) {
            Lattice p;
            for (std::int64_t &x : p)
                x = std::int64_t(random.next_index(2 * reach + 1)) - reach;
            lattice.push_back(i > 0 && random.next_index(8) == 0 ? lattice.back() : p);
            // Now and then all points are in one slanting plane.
            if (trial % 50 == 0)
                lattice.back()[2] = lattice.back()[0] + 2 * lattice.back()[1];
            if (reach <= 4)
                for (std::int64_t &x : lattice.back())
                    x += i == 0 || lattice.back() != lattice[i - 1] ? shift : 0;
            points.push_back(
                {Real(lattice.back()[0]), Real(lattice.back()[1]), Real(lattice.back()[2])});
        }
        const ExactHull expected = exact_hull(lattice);
        const HullResult result = convex_hull(points, no_limit);
        if (expected.facets.empty()) {
            ++flats;
            ASSERT_FALSE(result.mesh) << "trial " << trial;
            ASSERT_NE(result.problem, HullProblem::none);
            continue;
        }
        ++solids;
        ASSERT_TRUE(result.mesh) << "trial " << trial << " problem " << int(result.problem);
        const HullMesh &mesh = *result.mesh;
        std::set<Lattice> vertices;
        const auto on_lattice = [](const Vec3 &v) {
            return Lattice{std::int64_t(v.x), std::int64_t(v.y), std::int64_t(v.z)};
        };
        for (const Vec3 &vertex : mesh.vertices)
            vertices.insert(on_lattice(vertex));
        ASSERT_EQ(vertices, expected.vertices) << "trial " << trial;
        ASSERT_EQ(vertices.size(), mesh.vertices.size());
        ASSERT_EQ(mesh.faces.size(), expected.facets.size()) << "trial " << trial;
        ASSERT_TRUE(mesh.has_flat_faces);
        std::set<std::set<Lattice>> faces, expected_faces;
        for (const HullMesh::Face &face : mesh.faces) {
            std::set<Lattice> corners;
            for (std::uint32_t i = face.first; i < face.first + face.count; ++i)
                corners.insert(on_lattice(mesh.vertices[mesh.vertex_indices[i]]));
            faces.insert(corners);
        }
        for (const auto &[facet, corners] : expected.facets)
            expected_faces.insert(corners);
        ASSERT_EQ(faces, expected_faces) << "trial " << trial;
        check_mesh(mesh, points);
        ASSERT_FALSE(HasFailure()) << "trial " << trial;
        ASSERT_LE(double(result.left_out), double(result.tolerance));
    }
    EXPECT_GT(solids, count / 2);
    EXPECT_GT(flats, count / 100);
}

// Up to eight points, as bits of an integer.
struct SmallHull {
    std::vector<std::uint32_t> facets; // their corners; none when all points are coplanar
    std::uint32_t vertices = 0;
};

// Like exact_hull(): a facet is in a plane through three points with none in front.
void find_small_hull(const std::vector<Lattice> &points, SmallHull &hull) {
    hull.facets.clear();
    hull.vertices = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                const Lattice &a = points[i], &b = points[j], &c = points[k];
                const std::int64_t u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
                const std::int64_t w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
                const std::int64_t n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                                           u[0] * w[1] - u[1] * w[0]};
                std::uint32_t on = 0, front = 0, behind = 0;
                for (std::size_t p = 0; p < points.size(); ++p) {
                    const std::int64_t height = n[0] * (points[p][0] - a[0]) +
                                                n[1] * (points[p][1] - a[1]) +
                                                n[2] * (points[p][2] - a[2]);
                    (height > 0 ? front : height < 0 ? behind : on) |= 1U << p;
                }
                if ((front == 0) == (behind == 0))
                    continue; // not supporting, or all points coplanar
                if (std::find(hull.facets.begin(), hull.facets.end(), on) == hull.facets.end())
                    hull.facets.push_back(on);
            }
    // A point on an edge of the hull is in two facets, a corner in at least three.
    for (std::size_t p = 0; p < points.size(); ++p) {
        int facets_at = 0;
        for (const std::uint32_t facet : hull.facets)
            facets_at += int(facet >> p & 1U);
        hull.vertices |= facets_at >= 3 ? 1U << p : 0U;
    }
    for (std::uint32_t &facet : hull.facets)
        facet &= hull.vertices;
}

// Six times the volume of the tetrahedron on three corners and the origin.
std::int64_t six_volumes(const Lattice &a, const Lattice &b, const Lattice &c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// The mesh of distinct points is closed and faces outward, with exactly these faces and this
// volume.
void expect_small_hull(const HullMesh &mesh, const std::vector<Lattice> &points,
                       const SmallHull &expected) {
    std::array<std::uint32_t, 8> index{};
    std::uint32_t vertices = 0;
    ASSERT_LE(mesh.vertices.size(), points.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3 &p = mesh.vertices[v];
        const Lattice place{std::int64_t(p.x), std::int64_t(p.y), std::int64_t(p.z)};
        const auto found = std::find(points.begin(), points.end(), place);
        ASSERT_NE(found, points.end());
        index[v] = std::uint32_t(found - points.begin());
        vertices |= 1U << index[v];
    }
    ASSERT_EQ(vertices, expected.vertices);
    ASSERT_EQ(std::size_t(std::popcount(vertices)), mesh.vertices.size());
    ASSERT_EQ(mesh.faces.size(), expected.facets.size());
    std::uint64_t sides = 0, turned = 0; // 8 x 8 bits: an edge from one vertex to another
    std::uint32_t faces_seen = 0;
    std::int64_t volume = 0;
    for (const HullMesh::Face &face : mesh.faces) {
        std::uint32_t corners = 0;
        const auto at = [&](std::uint32_t i) {
            return index[mesh.vertex_indices[face.first + i % face.count]];
        };
        for (std::uint32_t i = 0; i < face.count; ++i) {
            corners |= 1U << at(i);
            ASSERT_EQ(sides >> (8 * at(i) + at(i + 1)) & 1U, 0U) << "a side used twice";
            sides |= std::uint64_t(1) << (8 * at(i) + at(i + 1));
            turned |= std::uint64_t(1) << (8 * at(i + 1) + at(i));
            if (i >= 2)
                volume += six_volumes(points[at(0)], points[at(i - 1)], points[at(i)]);
        }
        ASSERT_EQ(std::uint32_t(std::popcount(corners)), face.count);
        const auto facet = std::find(expected.facets.begin(), expected.facets.end(), corners);
        ASSERT_NE(facet, expected.facets.end()) << "a face that is none";
        faces_seen |= 1U << (facet - expected.facets.begin());
    }
    ASSERT_EQ(std::size_t(std::popcount(faces_seen)), mesh.faces.size());
    ASSERT_EQ(sides, turned); // each edge has its opposite
    ASSERT_EQ(std::size_t(std::popcount(sides)), 2 * mesh.edges.size());
    ASSERT_GT(volume, 0);
    // As in check_mesh().
    const double exact = double(volume) / 6.0;
    const double extent = glm::length(wide(mesh.box.max) - wide(mesh.box.min));
    ASSERT_NEAR(double(mesh.volume), exact,
                epsilon * exact + 1e-16 * double(mesh.faces.size()) * extent * extent * extent);
}

TEST(Quickhull, AMillionSmallSetsAreExact) {
    Random random(7);
    int solids = 0, flats = 0;
    const int count = trials(1'000'000);
    std::vector<Lattice> lattice;
    std::vector<Vec3> points;
    SmallHull expected;
    for (int trial = 0; trial < count; ++trial) {
        const std::int64_t reach = 1 + random.next_index(trial % 4 == 0 ? 10 : 3);
        const std::size_t size = 4 + random.next_index(5);
        const std::int64_t shift = trial % 5 == 0 ? 1000 : 0;
        lattice.clear();
        points.clear();
        for (std::size_t i = 0; i < size; ++i) {
            Lattice p;
            for (std::int64_t &x : p)
                x = std::int64_t(random.next_index(std::uint32_t(2 * reach + 1))) - reach;
            if (trial % 50 == 0) // all in one slanting plane
                p[2] = p[0] + 2 * p[1];
            for (std::int64_t &x : p)
                x += shift;
            points.push_back({Real(p[0]), Real(p[1]), Real(p[2])});
            if (std::find(lattice.begin(), lattice.end(), p) == lattice.end())
                lattice.push_back(p); // the oracle needs distinct points
        }
        find_small_hull(lattice, expected);
        const HullResult result = convex_hull(points, no_limit);
        ASSERT_EQ(result.mesh.has_value(), !expected.facets.empty()) << "trial " << trial;
        if (!result.mesh) {
            ++flats;
            ASSERT_NE(result.problem, HullProblem::none);
            continue;
        }
        ++solids;
        expect_small_hull(*result.mesh, lattice, expected);
        ASSERT_FALSE(HasFatalFailure()) << "trial " << trial;
        ASSERT_LE(double(result.left_out), double(result.tolerance));
    }
    EXPECT_GT(solids, count / 2);
    EXPECT_GT(flats, count / 100);
}

TEST(Quickhull, AwkwardPoints) {
    Random random(2);
    double worst_height = 0.0, worst_corner = 0.0; // in tolerances
    int solids = 0;
    const int count = trials(600);
    for (int trial = 0; trial < count; ++trial) {
        const int family = trial % families;
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const double offset = random.next_index(2) == 0
                                  ? 0.0
                                  : std::min(1e5, size * std::pow(10.0, random.next_in(0.0, 8.0)));
        const std::vector<Vec3> points =
            placed_points(random, any_points(random, family), size, offset);
        const HullResult result = convex_hull(points, no_limit);
        if (!result.mesh) {
            // Flat up to rounding, seen from that far.
            const double thickness =
                size * (family == 3 || family == 4 || family == 6 || family == 8 ? 2e-3 : 1.0);
            ASSERT_LE(thickness, 8.0 * double(result.tolerance))
                << "trial " << trial << " problem " << int(result.problem);
            continue;
        }
        ++solids;
        const Report report = check_mesh(*result.mesh, points);
        ASSERT_FALSE(HasFailure()) << "trial " << trial << " family " << family;
        ASSERT_NEAR(double(result.left_out), report.greatest_height,
                    epsilon * (double(result.tolerance) + report.greatest_height));
        worst_height = std::max(worst_height, report.greatest_height / double(result.tolerance));
        worst_corner = std::max(worst_corner, report.deepest_corner / double(result.tolerance));
    }
    // Points left out, and vertices dropped where facets merged (quickhull.h).
    EXPECT_LE(worst_height, 3.0);
    // In double a needle's normal may turn by more than the points' rounding.
    if (sizeof(Real) == sizeof(float)) {
        EXPECT_LE(worst_corner, 2.0);
    }
    EXPECT_GT(solids, count / 2);
}

std::vector<Vec3> on_sphere(Random &random, int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const V p = any_direction(random);
        points.push_back({Real(p.x), Real(p.y), Real(p.z)});
    }
    return points;
}

TEST(Quickhull, LimitedVerticesStayInside) {
    Random random(3);
    for (int trial = 0; trial < trials(20); ++trial) {
        const std::vector<Vec3> points = on_sphere(random, 400);
        double last = 2.0;
        for (const int limit : {4, 8, 16, 32, 64, 128}) {
            const HullResult result = convex_hull(points, limit);
            ASSERT_TRUE(result.mesh);
            ASSERT_LE(result.mesh->vertices.size(), std::size_t(limit));
            const Report report = check_mesh(*result.mesh, points);
            ASSERT_FALSE(HasFailure());
            ASSERT_NEAR(double(result.left_out), report.greatest_height, 2 * epsilon);
            // Farthest first: the height of the points left out falls as the limit grows, though
            // not smoothly. A hull of n points in a sphere leaves out caps of at least about 2 / n.
            ASSERT_LT(double(result.left_out), std::min(1.2 * last, 24.0 / limit));
            last = double(result.left_out);
        }
    }
    const std::vector<Vec3> points = on_sphere(random, 10);
    EXPECT_THROW(convex_hull(points, 3), CheckFailure);
}

// A cube filled with a grid needs only its eight corners, and finds them first.
TEST(Quickhull, LimitDoesNotGoToPointsInFaces) {
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i)
        points.push_back({Real(i % 10), Real(i / 10 % 10), Real(i / 100)});
    const HullResult result = convex_hull(points, 8);
    ASSERT_TRUE(result.mesh);
    EXPECT_EQ(result.mesh->vertices.size(), 8u);
    EXPECT_EQ(result.mesh->faces.size(), 6u);
    EXPECT_EQ(result.mesh->edges.size(), 12u);
    EXPECT_EQ(result.mesh->volume, Real(729));
    EXPECT_EQ(result.mesh->center, Vec3{Real(4.5)});
    EXPECT_EQ(result.left_out, Real(0));
}

TEST(Quickhull, ManyPoints) {
    Random random(4);
    std::vector<Vec3> points = on_sphere(random, trials(5000));
    const HullResult sphere = convex_hull(points, no_limit);
    ASSERT_TRUE(sphere.mesh);
    EXPECT_LE(double(sphere.left_out), 3.0 * double(sphere.tolerance));
    // The same in a ball and in a rotated cube, where few points are vertices.
    for (Vec3 &point : points)
        point *= Real(std::cbrt(random.next_unit()));
    ASSERT_TRUE(convex_hull(points, no_limit).mesh);
    const Quat turn = any_rotation(random);
    points.clear();
    for (int i = 0; i < 100000; ++i) {
        Vec3 p = any_vector(random, 1.0);
        p[i % 3] = i % 2 == 0 ? Real(1) : Real(-1);
        if (i < 8)
            p = {Real((i & 1) * 2 - 1), Real((i & 2) - 1), Real((i & 4) / 2 - 1)};
        points.push_back(turn * p);
    }
    const HullResult cube = convex_hull(points, no_limit);
    ASSERT_TRUE(cube.mesh);
    EXPECT_EQ(cube.mesh->vertices.size(), 8u);
    EXPECT_EQ(cube.mesh->faces.size(), 6u);
    EXPECT_NEAR(double(cube.mesh->volume), 8.0, 32 * epsilon);
}

TEST(Quickhull, SameBitsEveryTime) {
    Random random(5);
    for (int family = 0; family < families; ++family) {
        const std::vector<Vec3> points =
            placed_points(random, any_points(random, family), 1.0, 2.0);
        const HullResult first = convex_hull(points, 40);
        const HullResult second = convex_hull(points, 40);
        ASSERT_TRUE(first.mesh && second.mesh);
        EXPECT_EQ(first.mesh->vertices, second.mesh->vertices);
        EXPECT_EQ(first.mesh->vertex_indices, second.mesh->vertex_indices);
        EXPECT_EQ(first.mesh->inertia, second.mesh->inertia);
        EXPECT_EQ(first.left_out, second.left_out);
    }
}

TEST(Quickhull, SaysWhyNot) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real infinity = std::numeric_limits<Real>::infinity();
    const Vec3 x{Real(1), Real(0), Real(0)}, y{Real(0), Real(1), Real(0)},
        z{Real(0), Real(0), Real(1)};
    const Vec3 o{Real(0)};
    const auto problem = [](const std::vector<Vec3> &points) {
        const HullResult result = convex_hull(points, 64);
        EXPECT_EQ(result.mesh.has_value(), result.problem == HullProblem::none);
        return result.problem;
    };
    EXPECT_EQ(problem({}), HullProblem::too_few_points);
    EXPECT_EQ(problem({o, x, y}), HullProblem::too_few_points);
    EXPECT_EQ(problem({o, x, y, z}), HullProblem::none);
    EXPECT_EQ(problem({o, x, y, Vec3{nan}}), HullProblem::not_finite);
    EXPECT_EQ(problem({o, x, y, z * infinity}), HullProblem::not_finite);
    EXPECT_EQ(problem({x, x, x, x, x}), HullProblem::all_in_one_point);
    EXPECT_EQ(problem({o, x, Real(2) * x, Real(-3) * x}), HullProblem::all_on_one_line);
    EXPECT_EQ(problem({o, x, y, x + y, x - y}), HullProblem::all_in_one_plane);
    // In one plane up to rounding.
    Random random(6);
    for (int trial = 0; trial < trials(10000); ++trial) {
        const Quat turn = any_rotation(random);
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 shift = any_vector(random, 10.0 * size);
        std::vector<Vec3> points;
        for (int i = 0; i < 20; ++i) {
            Vec3 p = any_vector(random, size);
            p.z = Real(0);
            points.push_back(shift + turn * p);
        }
        ASSERT_EQ(problem(points), HullProblem::all_in_one_plane) << "trial " << trial;
    }
    const Real huge = std::sqrt(std::sqrt(std::numeric_limits<Real>::max()));
    EXPECT_EQ(problem({o, huge * x, huge * y, huge * z}), HullProblem::out_of_range);
    const Real tiny = std::sqrt(std::sqrt(std::numeric_limits<Real>::min())) / Real(16);
    EXPECT_EQ(problem({o, tiny * x, tiny * y, tiny * z}), HullProblem::out_of_range);
}

// Including subnormal numbers, and a different exponent for every coordinate.
TEST(Quickhull, EndsForPointsOfAnySize) {
    using Limits = std::numeric_limits<Real>;
    const Real tiny = Real(1e6) * Limits::denorm_min();
    const std::vector<Vec3> corner = {Vec3{Real(0)},
                                      {Real(0), tiny, Real(0)},
                                      {tiny, Real(0), Real(0)},
                                      {Real(0), Real(0), Real(0x1p19) * tiny}};
    EXPECT_EQ(convex_hull(corner, 64).problem, sizeof(Real) == sizeof(float)
                                                   ? HullProblem::out_of_range
                                                   : HullProblem::all_in_one_point);
    Random random(8);
    for (int trial = 0; trial < trials(20000); ++trial) {
        std::vector<Vec3> points;
        for (int i = 0; i < 12; ++i) {
            Vec3 p{Real(0)};
            if (random.next_in(0.0, 1.0) > 0.3)
                for (int k = 0; k < 3; ++k)
                    p[k] = std::ldexp(Real(random.next_in(-1.0, 1.0)),
                                      static_cast<int>(random.next_in(Limits::min_exponent - 40,
                                                                      Limits::max_exponent)));
            points.push_back(p);
        }
        const HullResult result = convex_hull(points, 64);
        ASSERT_EQ(result.mesh.has_value(), result.problem == HullProblem::none)
            << "trial " << trial;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
