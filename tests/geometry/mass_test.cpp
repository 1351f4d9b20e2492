#include "engine/geometry/mass.h"

#include "engine/geometry/hull_queries.h"
#include "engine/geometry/quickhull.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

using L = long double;

// Three nodes and weights in [-1, 1] that integrate polynomials up to degree 5 exactly
// (Gauss-Legendre).
const std::array<std::pair<L, L>, 3> slices{
    {{-std::sqrt(0.6L), 5.0L / 9.0L}, {0.0L, 8.0L / 9.0L}, {std::sqrt(0.6L), 5.0L / 9.0L}}};

// The integral of term(x) dx from `low` to `high`.
template <typename Term> void slice(L low, L high, Term &&term) {
    for (const auto &[place, weight] : slices)
        term(0.5L * (low + high) + 0.5L * (high - low) * place, 0.5L * (high - low) * weight);
}

struct Moments {
    L volume = 0, along = 0, across = 0;
};

// Volume, and moments per unit volume, of a solid of revolution about y by slices. A disc of radius
// R at height y has the volume pi R^2 dy, and per unit volume the moments R^2 / 2 about y and
// R^2 / 4 + y^2 about x and z. R^2 is quadratic between consecutive `borders`.
template <typename Squared>
Moments by_slices(std::initializer_list<L> borders, Squared &&squared_radius_at) {
    Moments sum;
    for (const L *low = borders.begin(); low + 1 < borders.end(); ++low)
        slice(low[0], low[1], [&](L y, L dy) {
            const L squared = squared_radius_at(y);
            const L volume = std::numbers::pi_v<L> * squared * dy;
            sum.volume += volume;
            sum.along += volume * squared / 2.0L;
            sum.across += volume * (squared / 4.0L + y * y);
        });
    return {sum.volume, sum.along / sum.volume, sum.across / sum.volume};
}

// All terms are positive, so some ten roundings are ten roundings of the result.
constexpr double relative = 16 * double(std::numeric_limits<Real>::epsilon());

void expect_moments(Real volume, const Vec3 &inertia, double mass, const Moments &expected) {
    ASSERT_NEAR(double(volume), double(expected.volume), relative * double(expected.volume));
    const double along = mass * double(expected.along), across = mass * double(expected.across);
    ASSERT_NEAR(double(inertia.y), along, relative * along);
    ASSERT_NEAR(double(inertia.x), across, relative * across);
    ASSERT_EQ(inertia.x, inertia.z);
}

TEST(Mass, RoundSolidsAgainstSlices) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 a = any_vector(random, random.next_index(2) == 0 ? size : 1e5);
        const Vec3 b = trial % 10 == 0 ? a : a + any_vector(random, size);
        const Real radius = Real(size * std::pow(10.0, random.next_in(-3.0, 1.0)));
        const Real mass = Real(std::pow(10.0, random.next_in(-3.0, 3.0)));
        const L half = 0.5L * glm::length(glm::vec<3, L>(b) - glm::vec<3, L>(a));
        const L r = radius, end = half + r;
        const Capsule capsule{a, b, radius};
        expect_moments(volume(capsule), principal_inertia(capsule, mass), double(mass),
                       by_slices({-end, -half, half, end}, [&](L y) {
                           const L beyond = std::max(0.0L, std::abs(y) - half);
                           return r * r - beyond * beyond;
                       }));
        const Sphere sphere{a, radius};
        expect_moments(volume(sphere), principal_inertia(sphere, mass), double(mass),
                       by_slices({-r, r}, [&](L y) { return r * r - y * y; }));
        if (a != b) {
            const Cylinder cylinder{a, b, radius};
            expect_moments(volume(cylinder), principal_inertia(cylinder, mass), double(mass),
                           by_slices({-half, half}, [&](L) { return r * r; }));
        }
        ASSERT_FALSE(HasFatalFailure()) << "trial " << trial;
    }
}

TEST(Mass, BoxAgainstSlices) {
    Random random(5);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 half = glm::abs(any_vector(random, size)) + Vec3{Real(1e-3 * size)};
        const Box box{any_vector(random, size), awkward_rotation(random), half};
        const double mass = random.next_in(0.1, 9.0);
        // The means of x^2, y^2 and z^2.
        std::array<L, 3> squared{};
        L expected_volume = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const L reach = half[axis];
            slice(-reach, reach,
                  [&](L x, L dx) { squared[std::size_t(axis)] += x * x * dx / (2.0L * reach); });
            expected_volume *= 2.0L * reach;
        }
        ASSERT_NEAR(double(volume(box)), double(expected_volume),
                    relative * double(expected_volume));
        const Vec3 inertia = principal_inertia(box, Real(mass));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double expected =
                mass * double(squared[(axis + 1) % 3] + squared[(axis + 2) % 3]);
            ASSERT_NEAR(double(inertia[int(axis)]), expected, relative * expected);
        }
    }
}

TEST(Mass, LimitsOfTheCapsule) {
    const Vec3 a{Real(0)};
    const Vec3 b{Real(0), Real(3), Real(0)};
    // A sphere when the length is zero, a rod when the radius is.
    const Vec3 ball = principal_inertia(Capsule{a, a, Real(0.5)}, Real(1));
    const Vec3 sphere = principal_inertia(Sphere{a, Real(0.5)}, Real(1));
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(double(ball[i]), double(sphere[i]), relative);
    const Vec3 rod = principal_inertia(Capsule{a, b, Real(0)}, Real(1));
    EXPECT_NEAR(double(rod.x), 9.0 / 12.0, relative);
    EXPECT_EQ(rod.y, Real(0));
    EXPECT_EQ(principal_inertia(Capsule{a, a, Real(0)}, Real(1)), Vec3{Real(0)});
    EXPECT_EQ(volume(HalfSpace{}), std::numeric_limits<Real>::infinity());
}

// The surface of a box, two triangles per face.
std::vector<Triangle> box_surface(const V &center, const V &half, const glm::dquat &turn) {
    std::vector<Triangle> surface;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int j = (axis + 1) % 3, k = (axis + 2) % 3;
            const auto corner = [&](double u, double v) {
                V p{0.0};
                p[axis] = side * half[axis];
                p[j] = u * side * half[j]; // mirrored on the opposite side
                p[k] = v * half[k];
                return Vec3(center + turn * p);
            };
            surface.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
            surface.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
        }
    return surface;
}

TEST(Mass, SurfaceOfABox) {
    Random random(3);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 3.0));
        const V half =
            size * V{random.next_in(0.1, 1.0), random.next_in(0.1, 1.0), random.next_in(0.1, 1.0)};
        const V center = size * 4.0 * any_direction(random);
        const Quat q = any_rotation(random);
        const glm::dquat turn =
            glm::normalize(glm::dquat(double(q.w), double(q.x), double(q.y), double(q.z)));
        const MassProperties mass = mass_properties(box_surface(center, half, turn));
        // Corners are rounded by epsilon / 2 of up to 6 sizes; a side is at least a fifth of one.
        const double band = 32.0 * double(std::numeric_limits<Real>::epsilon());
        const double volume = 8.0 * half.x * half.y * half.z;
        ASSERT_NEAR(double(mass.volume), volume, 3.0 * 5.0 * band * volume);
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(double(mass.center[i]), center[i], band * size);
        const V squared = half * half;
        const glm::dmat3 principal(volume / 3.0 * (squared.y + squared.z), 0.0, 0.0, 0.0,
                                   volume / 3.0 * (squared.z + squared.x), 0.0, 0.0, 0.0,
                                   volume / 3.0 * (squared.x + squared.y));
        const glm::dmat3 rotation = glm::mat3_cast(turn);
        const glm::dmat3 expected = rotation * principal * glm::transpose(rotation);
        const double largest = volume * size * size;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                ASSERT_NEAR(double(mass.inertia[i][j]), expected[i][j], 5.0 * 5.0 * band * largest);

        const PrincipalFrame frame = principal_frame(mass.inertia);
        V sorted{principal[0][0], principal[1][1], principal[2][2]};
        std::sort(&sorted.x, &sorted.x + 3);
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(double(frame.moments[i]), sorted[i], 8.0 * 5.0 * band * largest);
        const Mat3 axes = glm::mat3_cast(frame.rotation);
        const Mat3 moments(frame.moments.x, Real(0), Real(0), Real(0), frame.moments.y, Real(0),
                           Real(0), Real(0), frame.moments.z);
        const Mat3 again = axes * moments * glm::transpose(axes);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                ASSERT_NEAR(double(again[i][j]), double(mass.inertia[i][j]), band * largest);
    }
}

// Any closed surface by the divergence theorem: the integral of x^k over the solid is that of
// x^(k + 1) / (k + 1) times the normal's x over the surface, and so on for products of two
// coordinates. Over a triangle, by a rule exact to degree five (Radon's seven points).
TEST(Mass, HullsAgainstTheDivergenceTheorem) {
    Random random(4);
    std::vector<Vec3> points;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        // One point in each octant, or in every other octant: never flat.
        points.clear();
        for (const int i : {0, 3, 5, 6, 1, 2, 4, 7})
            if (points.size() < 4 || trial % 8 == 0)
                points.push_back({any_real(random, 0.2, 1.0) * Real((i & 1) * 2 - 1),
                                  any_real(random, 0.2, 1.0) * Real((i & 2) - 1),
                                  any_real(random, 0.2, 1.0) * Real((i & 4) / 2 - 1)});
        const HullResult result = convex_hull(points, 64);
        ASSERT_TRUE(result.mesh);
        const HullMesh &mesh = *result.mesh;
        double volume = 0.0;
        V first{0.0};
        glm::dmat3 second(0.0);
        const double root = std::sqrt(15.0);
        const double near = (6.0 - root) / 21.0, far = (6.0 + root) / 21.0;
        const double near_weight = (155.0 - root) / 1200.0, far_weight = (155.0 + root) / 1200.0;
        for (const HullMesh::Face &face : mesh.faces)
            for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
                const V a = wide(mesh.vertices[mesh.vertex_indices[face.first]]);
                const V b = wide(mesh.vertices[mesh.vertex_indices[face.first + i]]);
                const V c = wide(mesh.vertices[mesh.vertex_indices[face.first + i + 1]]);
                const V area = 0.5 * glm::cross(b - a, c - a);
                const auto take = [&](double u, double v, double weight) {
                    const V p = (1.0 - u - v) * a + u * b + v * c;
                    volume += weight * p.x * area.x;
                    for (int k = 0; k < 3; ++k) {
                        first[k] += weight * p[k] * p[k] / 2.0 * area[k];
                        second[k][k] += weight * p[k] * p[k] * p[k] / 3.0 * area[k];
                        const int j = (k + 1) % 3;
                        second[k][j] += weight * p[k] * p[k] / 2.0 * p[j] * area[k];
                    }
                };
                take(1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0);
                for (const auto &[u, weight] :
                     {std::pair{near, near_weight}, std::pair{far, far_weight}}) {
                    take(u, u, weight);
                    take(1.0 - 2.0 * u, u, weight);
                    take(u, 1.0 - 2.0 * u, weight);
                }
            }
        const double band = 8.0 * double(std::numeric_limits<Real>::epsilon()) + 1e-14;
        ASSERT_NEAR(double(mesh.volume), volume, band);
        const V center = first / volume;
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(double(mesh.center[i]), center[i], band);
        for (int k = 0; k < 3; ++k) {
            const int j = (k + 1) % 3, l = (k + 2) % 3;
            const double along = second[j][j] + second[l][l] -
                                 volume * (center[j] * center[j] + center[l] * center[l]);
            const double off = volume * center[k] * center[j] - second[k][j];
            ASSERT_NEAR(double(mesh.inertia[k][k]), along, band);
            ASSERT_NEAR(double(mesh.inertia[k][j]), off, band);
            ASSERT_NEAR(double(mesh.inertia[j][k]), off, band);
        }
        const ConvexHull hull{&mesh, any_vector(random, 5.0), any_rotation(random)};
        ASSERT_EQ(plumb::volume(hull), mesh.volume);
        ASSERT_NEAR(double(inertia(hull, Real(2))[0][0]),
                    2.0 / double(mesh.volume) * double(mesh.inertia[0][0]), band * 8.0);
    }
}

TEST(Mass, SurfacesAroundNothing) {
    const MassProperties none = mass_properties(std::span<const Triangle>{});
    EXPECT_EQ(none.volume, Real(0));
    const Triangle t{{Real(1), Real(0), Real(0)}, {Real(0), Real(1), Real(0)}, Vec3{Real(0)}};
    const std::array sheet{t, Triangle{t.a, t.c, t.b}};
    EXPECT_EQ(mass_properties(sheet).volume, Real(0));
    // Already diagonal: no rotation, whatever the moments.
    const PrincipalFrame frame = principal_frame(Mat3(Real(2)));
    EXPECT_EQ(frame.moments, Vec3{Real(2)});
    EXPECT_EQ(frame.rotation, identity_rotation);
}

TEST(Mass, MisuseNamesTheValue) {
    says([] { principal_inertia(HalfSpace{}, Real(1)); }, "half-space");
    says([] { principal_inertia(Sphere{Vec3{Real(0)}, Real(1)}, Real(-4)); }, "-4");
    says([] { principal_inertia(Sphere{Vec3{Real(0)}, Real(-9)}, Real(1)); }, "-9");
    says([] { volume(Box{Vec3{Real(0)}, identity_rotation, Vec3{Real(-6)}}); }, "-6");
    says([] { principal_inertia(Cylinder{}, Real(-7)); }, "-7");
    says([] { volume(Cylinder{Vec3{Real(0)}, Vec3{Real(1)}, Real(-3)}); }, "-3");
    says([] { volume(ConvexHull{}); }, "none");
    says([] { principal_frame(Mat3(std::numeric_limits<Real>::quiet_NaN())); }, "nan");
    says([] { volume(Sphere{Vec3{Real(0)}, std::numeric_limits<Real>::quiet_NaN()}); }, "nan");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
