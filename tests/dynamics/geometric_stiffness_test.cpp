#include "engine/dynamics/joints/geometric_stiffness.h"

#include "tests/dynamics/worlds.h"

#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

struct Pull {
    V force, arm;
};

// Principal moments that a body can have: none exceeds the sum of the other two.
V any_inertia(Random &random) {
    const V sides{random.next_in(0.05, 1), random.next_in(0.05, 1), random.next_in(0.05, 1)};
    const V squares = sides * sides;
    return V{squares.y + squares.z, squares.x + squares.z, squares.x + squares.y};
}

// The second derivative of -F (R r) in the angle about an axis, by finite differences.
double stiffness_about(const V &axis, const std::vector<Pull> &pulls) {
    constexpr double small = 1e-4;
    const auto potential = [&](double angle) {
        double sum = 0;
        for (const Pull &pull : pulls)
            sum -= glm::dot(pull.force, glm::angleAxis(angle, axis) * pull.arm);
        return sum;
    };
    return (potential(small) - 2 * potential(0) + potential(-small)) / (small * small);
}

TEST(GeometricStiffness, IsTheSecondDerivativeOfThePotential) {
    Random random(1);
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<Pull> pulls;
        GeometricStiffness sum;
        for (int i = 0; i < 3; ++i) {
            pulls.push_back({any_vector(random, 10), any_vector(random, 1)});
            sum.add(narrow(pulls.back().force), narrow(pulls.back().arm));
        }
        const V axis = any_rotation(random) * V{1, 0, 0};
        const V turned = wide(sum.tensor * narrow(axis));
        EXPECT_NEAR(glm::dot(axis, turned), stiffness_about(axis, pulls), 1e-5 + 300 * epsilon);
    }
}

// A body with the bound for its inertia turns at 1 rad/s at most, about any axis.
TEST(GeometricStiffness, IsNowhereAboveItsBound) {
    Random random(2);
    for (int trial = 0; trial < 300; ++trial) {
        const V inertia = any_inertia(random);
        const glm::dquat rotation = any_rotation(random);
        std::vector<Pull> pulls;
        GeometricStiffness sum;
        Vec3 greatest{Real(0)};
        for (int i = 0; i < 2; ++i) {
            pulls.push_back({any_vector(random, 10), any_vector(random, 1)});
            const Pull &pull = pulls.back();
            sum.add(narrow(pull.force), narrow(pull.arm));
            greatest += Real(glm::length(pull.force)) *
                        greatest_axial_stiffness(narrow(glm::conjugate(rotation) * pull.arm),
                                                 narrow(inertia));
        }
        const V axial = wide(axial_stiffness(sum, narrow(inertia), narrow(rotation)));
        for (int turn = 0; turn < 20; ++turn) {
            const V axis = any_rotation(random) * V{1, 0, 0};
            const V local = glm::conjugate(rotation) * axis;
            const double stiffness = std::abs(stiffness_about(axis, pulls));
            const double slack = 1e-5 + 300 * epsilon;
            EXPECT_LE(stiffness, glm::dot(local * local, axial) + slack) << trial;
            EXPECT_LE(stiffness, glm::dot(local * local, wide(greatest)) + slack) << trial;
        }
    }
}

TEST(GeometricStiffness, OfAPullAlongAStickIsNoneAboutIt) {
    GeometricStiffness sum;
    sum.add(Vec3{100, 0, 0}, Vec3{Real(0.5), 0, 0});
    sum.add(Vec3{-100, 0, 0}, Vec3{Real(-0.5), 0, 0});
    const Vec3 inertia{Real(0.001), Real(0.1), Real(0.1)};
    const Vec3 axial = axial_stiffness(sum, inertia, identity_rotation);
    EXPECT_EQ(double(axial.x), 0);
    EXPECT_NEAR(double(axial.y), 100, 1e-4);
    EXPECT_NEAR(double(squared_rate(axial, inertia)), 1000, 1e-3);
}

// A ball has no axes.
TEST(GeometricStiffness, OfABallIsTheSumOfLengths) {
    GeometricStiffness sum;
    sum.add(Vec3{3, 4, 0}, Vec3{0, 0, 2});
    EXPECT_EQ(axial_stiffness(sum, Vec3{1}, identity_rotation), Vec3{10});
    EXPECT_EQ(greatest_axial_stiffness(Vec3{0, 3, 4}, Vec3{1}), Vec3{5});
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
