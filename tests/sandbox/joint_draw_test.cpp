#include "app/sandbox/draw/joint_draw.h"

#include "app/render/palette.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;
// A body 2 m to the right of the origin, with a reach of 1 m.
const std::array<BodyState, 1> one_pose{{{glm::dvec3(2, 0, 0), glm::dquat(1, 0, 0, 0)}}};
const std::array<double, 1> reach{1.0};
const JointSurroundings surroundings{one_pose, reach, {0, -9.81, 0}};
constexpr float sign_size = 0.5f; // half the body's size

JointView joint(JointType type) {
    JointView view;
    view.type = type;
    view.body_b = 0;
    return view;
}

DrawList links(const JointView &view) {
    DrawList list;
    draw_links(list, std::array{view}, surroundings);
    return list;
}
DrawList signs(const JointView &view) {
    DrawList list;
    draw_joints(list, std::array{view}, surroundings);
    return list;
}

bool near(const glm::vec3 &a, const glm::vec3 &b) {
    return glm::distance(a, b) < 1e-5f;
}
bool has_line(const DrawList &list, const glm::vec3 &a, const glm::vec3 &b) {
    for (const DrawLine &line : list.lines)
        if ((near(line.a, a) && near(line.b, b)) || (near(line.a, b) && near(line.b, a)))
            return true;
    return false;
}

// The frame's x axis along z: the angle turns in the xy plane.
const glm::dquat along_z = glm::angleAxis(-pi / 2, glm::dvec3(0, 1, 0));

TEST(JointDraw, EveryTypeShowsItsAnchors) {
    for (const JointType type : {JointType::ball, JointType::distance, JointType::hinge,
                                 JointType::slider, JointType::fixed})
        EXPECT_EQ(signs(joint(type)).points.size(), 2u);
    EXPECT_TRUE(links(joint(JointType::ball)).shapes.empty());
}

TEST(JointDraw, HingeHasItsAxisAnArcBetweenItsLimitsAndAHand) {
    JointView hinge = joint(JointType::hinge);
    hinge.frame_a = along_z;
    hinge.frame_b = glm::angleAxis(pi / 6, glm::dvec3(0, 0, 1)) * along_z;
    hinge.position = pi / 6;
    hinge.limits = {-pi / 3, pi / 2};
    const DrawList list = signs(hinge);
    EXPECT_TRUE(has_line(list, {0, 0, -sign_size}, {0, 0, sign_size})) << "axis";
    EXPECT_TRUE(has_line(list, {0, 0, 0}, {sign_size, 0, 0})) << "hand, to the body";
    // Angle 0 is 30 degrees before the hand; the limits' ticks count from there.
    for (const double limit : {-pi / 3, pi / 2}) {
        const double angle = limit - pi / 6;
        EXPECT_TRUE(has_line(list, {0, 0, 0},
                             1.15 * sign_size * glm::dvec3(std::cos(angle), std::sin(angle), 0)))
            << limit;
    }
}

TEST(JointDraw, HingeOfABodyAgainstTheWorldTurnsTheOtherWayRound) {
    JointView hinge = joint(JointType::hinge);
    std::swap(hinge.body_a, hinge.body_b);
    hinge.frame_a = hinge.frame_b = along_z;
    hinge.limits = {0, pi / 2}; // the world's angle relative to the body
    EXPECT_TRUE(has_line(signs(hinge), {0, 0, 0}, {0, -1.15f * sign_size, 0}));
}

TEST(JointDraw, SliderHasARailBetweenItsLimits) {
    JointView slider = joint(JointType::slider);
    slider.anchor_b = {1, 0, 0};
    slider.position = 1;
    slider.limits = {-0.5, 3};
    int along = 0;
    for (const DrawLine &line : signs(slider).lines)
        along += std::abs(line.a.x + 0.5f) < 1e-5f && std::abs(line.b.x - 3) < 1e-5f ? 1 : 0;
    EXPECT_EQ(along, 2);
}

TEST(JointDraw, FixedIsACross) {
    EXPECT_TRUE(
        has_line(signs(joint(JointType::fixed)), {-sign_size / 2, 0, 0}, {sign_size / 2, 0, 0}));
    EXPECT_TRUE(
        has_line(signs(joint(JointType::fixed)), {0, -sign_size / 2, 0}, {0, sign_size / 2, 0}));
}

TEST(JointDraw, RodRopeAndSpring) {
    JointView view = joint(JointType::distance);
    view.anchor_b = {2, 0, 0};
    view.position = 2;
    view.limits = {2, 2};
    EXPECT_EQ(links(view).shapes.size(), 1u);

    view.limits = {0, 3}; // slack: it sags below its ends and keeps its full length
    double length = 0;
    float lowest = 0;
    for (const DrawShape &shape : links(view).shapes)
        if (shape.kind == DrawKind::capsule) {
            length += 2 * shape.size.y;
            lowest = std::min(lowest, shape.position.y);
        }
    EXPECT_NEAR(length, 3, 1e-4);
    EXPECT_LT(lowest, -0.9f);

    view.limits = {0, 2}; // taut
    EXPECT_EQ(links(view).shapes.size(), 1u);

    view.limits = {2, 2};
    view.frequency = 1;
    EXPECT_GT(links(view).shapes.size(), 50u) << "a coil";
    view.broken = true;
    EXPECT_TRUE(links(view).shapes.empty());
}

TEST(JointDraw, ABrokenJointShowsItsEndsAlone) {
    JointView view = joint(JointType::fixed);
    view.broken = true;
    EXPECT_EQ(signs(view).lines.size(), 1u) << "from the body to its anchor";
    EXPECT_EQ(signs(view).points.at(0).colour, colours::contact);
}

// 0.3 m for the body's weight, twice as long for four times that; at the held body's anchor.
TEST(JointDraw, AnArrowIsTheForceOnWhatIsHeld) {
    const double weight = 20;
    const JointSurroundings scaled{one_pose, reach, {0, -9.81, 0}, weight};
    const auto arrows = [&](const JointView &view) {
        DrawList list;
        draw_joints(list, std::array{view}, scaled);
        return list;
    };
    JointView ball = joint(JointType::ball);
    ball.anchor_b = {1, 0, 0};
    ball.force = {0, weight, 0};
    EXPECT_TRUE(has_line(arrows(ball), {1, 0, 0}, {1, 0.3f, 0}));
    ball.force *= 4;
    EXPECT_TRUE(has_line(arrows(ball), {1, 0, 0}, {1, 0.6f, 0}));
    ball.force *= 1e4;
    EXPECT_TRUE(has_line(arrows(ball), {1, 0, 0}, {1, 2, 0}));
    // The world is the joint's second side here, so the force on it acts back on the body.
    JointView hung = joint(JointType::ball);
    std::swap(hung.body_a, hung.body_b);
    hung.anchor_a = {1, 0, 0};
    hung.force = {0, -weight, 0};
    EXPECT_TRUE(has_line(arrows(hung), {1, 0, 0}, {1, 0.3f, 0}));
    const std::size_t with = arrows(ball).lines.size();
    ball.force = {0, 0, 0};
    EXPECT_EQ(arrows(ball).lines.size() + 3, with) << "a shaft and two barbs";
    ball.force = {0, weight, 0};
    EXPECT_EQ(signs(ball).lines.size() + 3, with) << "nothing to scale it by";
}

TEST(JointDraw, NothingNotFiniteComesOfWhatIsDegenerate) {
    for (const JointType type : {JointType::ball, JointType::distance, JointType::hinge,
                                 JointType::slider, JointType::fixed}) {
        JointView view = joint(type);
        view.limits = {0, 0};
        view.motor_speed = 0;
        view.frequency = 1;
        DrawList list;
        const JointSurroundings nothing{{}, {}, {0, 0, 0}};
        draw_links(list, std::array{view}, nothing);
        draw_joints(list, std::array{view}, nothing);
        for (const DrawLine &line : list.lines)
            EXPECT_TRUE(finite(line.a) && finite(line.b));
        for (const DrawShape &shape : list.shapes)
            EXPECT_TRUE(finite(shape.position) && finite(shape.size));
    }
}

} // namespace
} // namespace plumb
