#include "engine/geometry/mass.h"

#include "engine/core/check.h"
#include "tests/geometry/oracle.h"

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
    says([] { volume(Sphere{Vec3{Real(0)}, std::numeric_limits<Real>::quiet_NaN()}); }, "nan");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
