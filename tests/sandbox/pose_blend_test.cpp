#include "app/sandbox/draw/pose_blend.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

glm::dquat about_y(double angle) {
    return {std::cos(angle / 2), 0, std::sin(angle / 2), 0};
}

TEST(PoseBlend, IsExactAtBothEnds) {
    const std::vector<BodyState> a{{{0.1, 0.2, 0.3}, about_y(0.7)}};
    const std::vector<BodyState> b{{{1.1, 2.2, 3.3}, about_y(1.9)}};
    for (const auto &[alpha, expected] : {std::pair{0.0, a}, std::pair{1.0, b}}) {
        const std::vector<BodyState> blended = blend(a, b, alpha);
        EXPECT_EQ(blended[0].position, expected[0].position);
        EXPECT_EQ(blended[0].orientation, expected[0].orientation);
    }
}

// Halfway, normalised linear and spherical interpolation agree.
TEST(PoseBlend, HalfwayIsHalfTheTurn) {
    const std::vector<BodyState> a{{{0, 0, 0}, about_y(0.2)}};
    const std::vector<BodyState> b{{{2, 4, 6}, about_y(1.4)}};
    const BodyState middle = blend(a, b, 0.5)[0];
    EXPECT_EQ(middle.position, glm::dvec3(1, 2, 3));
    const glm::dquat expected = about_y(0.8);
    EXPECT_NEAR(glm::dot(middle.orientation, expected), 1, 1e-15);
}

// q and -q are the same rotation; the blend must take the short way round.
TEST(PoseBlend, TakesTheShorterWay) {
    const std::vector<BodyState> a{{{0, 0, 0}, about_y(0.2)}};
    const std::vector<BodyState> b{{{0, 0, 0}, -about_y(0.4)}};
    const glm::dquat middle = blend(a, b, 0.5)[0].orientation;
    EXPECT_NEAR(std::abs(glm::dot(middle, about_y(0.3))), 1, 1e-15);
}

TEST(PoseBlend, ABodyThatIsNewAppearsAtOnce) {
    const std::vector<BodyState> a{{{0, 0, 0}, about_y(0)}};
    const std::vector<BodyState> b{{{1, 0, 0}, about_y(0)}, {{7, 7, 7}, about_y(1)}};
    const std::vector<BodyState> blended = blend(a, b, 0.25);
    ASSERT_EQ(blended.size(), 2u);
    EXPECT_EQ(blended[0].position, glm::dvec3(0.25, 0, 0));
    EXPECT_EQ(blended[1].position, glm::dvec3(7, 7, 7));
}

} // namespace
} // namespace plumb
