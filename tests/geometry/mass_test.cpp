#include "engine/geometry/mass.h"

#include "engine/core/check.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/quickhull.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

// Volume and moments of a solid of revolution about y by slices (midpoint rule): a disc of radius R
// at height y has the volume pi R^2 dy, and per unit of volume the moments R^2 / 2 about y and R^2
// / 4 + y^2 about x and z.
template <typename Profile> std::array<double, 3> by_slices(double reach, Profile &&radius_at) {
    const int slices = 20000;
    const double dy = 2.0 * reach / slices;
    double volume = 0.0, along = 0.0, across = 0.0;
    for (int i = 0; i < slices; ++i) {
        const double y = -reach + (i + 0.5) * dy;
        const double r = radius_at(y);
        const double slice = 3.14159265358979323846 * r * r * dy;
        volume += slice;
        along += slice * r * r / 2.0;
        across += slice * (r * r / 4.0 + y * y);
    }
    return {volume, along / volume, across / volume};
}

// The midpoint rule is off by the relative order of (1 / slices) where the profile ends: 1e-4 would
// be its first order; being symmetric it has second order, below 1e-7. The rest is rounding.
constexpr double relative = 1e-7 + 16 * double(std::numeric_limits<Real>::epsilon());

TEST(Mass, CapsuleAgainstSlices) {
    Random random(1);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 a = any_vector(random, 2.0);
        const Vec3 b = trial % 10 == 0 ? a : any_vector(random, 2.0);
        const Real r = any_real(random, 0.05, 1.0);
        const double half = 0.5 * glm::length(wide(b) - wide(a));
        const double radius = double(r);
        const auto expected = by_slices(half + radius, [&](double y) {
            const double beyond = std::max(0.0, std::abs(y) - half);
            return std::sqrt(std::max(0.0, radius * radius - beyond * beyond));
        });
        const Capsule capsule{a, b, r};
        const double mass = 3.0;
        const V inertia = wide(principal_inertia(capsule, Real(mass)));
        EXPECT_NEAR(double(volume(capsule)), expected[0], relative * expected[0]);
        EXPECT_NEAR(inertia.y, mass * expected[1], relative * mass * expected[1]);
        EXPECT_NEAR(inertia.x, mass * expected[2], relative * mass * expected[2]);
        EXPECT_EQ(inertia.x, inertia.z);
    }
}

TEST(Mass, SphereAgainstSlices) {
    const double radius = 0.7;
    const auto expected = by_slices(
        radius, [&](double y) { return std::sqrt(std::max(0.0, radius * radius - y * y)); });
    const Sphere sphere{Vec3{Real(5)}, Real(radius)};
    const V inertia = wide(principal_inertia(sphere, Real(2)));
    EXPECT_NEAR(double(volume(sphere)), expected[0], relative * expected[0]);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(inertia[i], 2.0 * expected[1], relative * 2.0 * expected[1]);
}

// 64^3 cells of the box, each as a point at its centre plus its own size: for a box the grid sum of
// y^2 is short of the integral by exactly (cell height)^2 / 12.
TEST(Mass, BoxAgainstCells) {
    const V half{0.3, 0.7, 1.1};
    const Box box{Vec3{Real(1)}, Quat{Real(0), Real(1), Real(0), Real(0)},
                  Vec3{Real(half.x), Real(half.y), Real(half.z)}};
    const int n = 64;
    V squared{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const double cell = 2.0 * half[axis] / n;
        for (int i = 0; i < n; ++i) {
            const double x = -half[axis] + (i + 0.5) * cell;
            squared[axis] += (x * x + cell * cell / 12.0) / n;
        }
    }
    const V inertia = wide(principal_inertia(box, Real(5)));
    EXPECT_NEAR(inertia.x, 5.0 * (squared.y + squared.z), 5.0 * relative * 2.0);
    EXPECT_NEAR(inertia.y, 5.0 * (squared.z + squared.x), 5.0 * relative * 2.0);
    EXPECT_NEAR(inertia.z, 5.0 * (squared.x + squared.y), 5.0 * relative * 2.0);
    EXPECT_NEAR(double(volume(box)), 8.0 * half.x * half.y * half.z, relative * 2.0);
}

TEST(Mass, LimitsOfTheCapsule) {
    const Vec3 a{Real(0)};
    const Vec3 b{Real(0), Real(3), Real(0)};
    // Without length a sphere, without radius a rod.
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

TEST(Mass, CylinderAgainstSlices) {
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const Cylinder cylinder{any_vector(random, 2.0), any_vector(random, 2.0),
                                any_real(random, 0.05, 1.0)};
        const double half = 0.5 * glm::length(wide(cylinder.b) - wide(cylinder.a));
        const double radius = double(cylinder.radius);
        const auto expected = by_slices(half, [&](double) { return radius; });
        const V inertia = wide(principal_inertia(cylinder, Real(3)));
        EXPECT_NEAR(double(volume(cylinder)), expected[0], relative * expected[0]);
        EXPECT_NEAR(inertia.y, 3.0 * expected[1], relative * 3.0 * expected[1]);
        EXPECT_NEAR(inertia.x, 3.0 * expected[2], relative * 3.0 * expected[2]);
        EXPECT_EQ(inertia.x, inertia.z);
    }
}

// The surface of a box, of two triangles a face.
std::vector<Triangle> box_surface(const V &center, const V &half, const glm::dquat &turn) {
    std::vector<Triangle> surface;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int j = (axis + 1) % 3, k = (axis + 2) % 3;
            const auto corner = [&](double u, double v) {
                V p{0.0};
                p[axis] = side * half[axis];
                p[j] = u * side * half[j]; // mirrored for the other side
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
    for (int trial = 0; trial < trials(20000); ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 3.0));
        const V half =
            size * V{random.next_in(0.1, 1.0), random.next_in(0.1, 1.0), random.next_in(0.1, 1.0)};
        const V center = size * 4.0 * any_direction(random);
        const Quat q = any_rotation(random);
        const glm::dquat turn =
            glm::normalize(glm::dquat(double(q.w), double(q.x), double(q.y), double(q.z)));
        const MassProperties mass = mass_properties(box_surface(center, half, turn));
        // Corners are rounded by epsilon / 2 of up to 6 sizes, a side is at least a fifth of one.
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
// x^(k + 1) / (k + 1) times the normal's x over the surface, and for products of two coordinates
// likewise; over a triangle by a rule that is exact to the fifth degree (Radon's seven points).
TEST(Mass, HullsAgainstTheDivergenceTheorem) {
    Random random(4);
    for (int trial = 0; trial < trials(3000); ++trial) {
        std::vector<Vec3> points;
        for (int i = 0; i < 12; ++i)
            points.push_back(any_vector(random, 1.0));
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
    const MassProperties none = mass_properties({});
    EXPECT_EQ(none.volume, Real(0));
    const Triangle t{{Real(1), Real(0), Real(0)}, {Real(0), Real(1), Real(0)}, Vec3{Real(0)}};
    const std::array sheet{t, Triangle{t.a, t.c, t.b}};
    EXPECT_EQ(mass_properties(sheet).volume, Real(0));
    // Already diagonal: no turning, whatever the moments.
    const PrincipalFrame frame = principal_frame(Mat3(Real(2)));
    EXPECT_EQ(frame.moments, Vec3{Real(2)});
    EXPECT_EQ(frame.rotation, identity_rotation);
}

TEST(Mass, MisuseNamesTheValue) {
    const auto says = [](auto &&call, const char *part) {
        try {
            call();
            ADD_FAILURE() << "nothing failed; wanted " << part;
        } catch (const CheckFailure &error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
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
