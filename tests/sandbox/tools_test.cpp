#include "app/sandbox/tools.h"

#include "app/sandbox/draw/world_draw.h"
#include "tests/sandbox/fake_simulation.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

using Kind = PointerEvent::Kind;

// Two balls seen from +z, the left one at the centre of an 800 x 600 viewport.
class ToolsTest : public testing::Test {
  protected:
    ToolsTest() : session({}, nullptr, make_fake()) {
        session.open(two_balls());
        camera = camera_of(session.scene().camera);
    }
    void send(Kind kind, glm::vec2 at, PointerButton button = PointerButton::left,
              bool ctrl = false, bool shift = false, bool over_panel = false) {
        PointerEvent event;
        event.kind = kind;
        event.button = button;
        event.position = at;
        event.ctrl = ctrl;
        event.shift = shift;
        event.over_panel = over_panel;
        tools.handle(event, {session, camera, selected, selected_particle, viewport});
    }
    FakeSimulation &fake() { return dynamic_cast<FakeSimulation &>(*session.simulation()); }

    static constexpr glm::vec2 viewport{800, 600};
    static constexpr glm::vec2 ball{400, 300};
    static constexpr glm::vec2 sky{100, 40};
    Session session;
    Camera camera;
    std::optional<std::size_t> selected;
    std::optional<std::size_t> selected_particle;
    Tools tools;
};

TEST_F(ToolsTest, AClickSelectsAndOneBesideLetsGo) {
    send(Kind::press, ball);
    send(Kind::release, ball);
    EXPECT_EQ(selected, 0u);
    send(Kind::press, sky);
    send(Kind::release, sky);
    EXPECT_FALSE(selected.has_value());
}

TEST_F(ToolsTest, ATremblingHandStillClicks) {
    const Camera before = camera;
    send(Kind::press, ball);
    send(Kind::move, ball + glm::vec2(2, -2));
    send(Kind::release, ball + glm::vec2(2, -2));
    EXPECT_EQ(selected, 0u);
    EXPECT_EQ(camera.yaw, before.yaw);
}

TEST_F(ToolsTest, ALeftDragOrbitsByTheWholeWayAndSelectsNothing) {
    Camera expected = camera;
    expected.orbit({60, 30}, viewport.y);
    send(Kind::press, sky);
    send(Kind::move, sky + glm::vec2(3, 0)); // still within a click's tolerance
    send(Kind::move, sky + glm::vec2(20, 10));
    send(Kind::move, sky + glm::vec2(60, 30));
    send(Kind::release, sky + glm::vec2(60, 30));
    EXPECT_NEAR(camera.yaw, expected.yaw, 1e-5f);
    EXPECT_NEAR(camera.pitch, expected.pitch, 1e-5f);
    EXPECT_FALSE(selected.has_value());
}

// The camera must not stay stuck to the pointer when the button is released over a panel.
TEST_F(ToolsTest, AReleaseOverAPanelEndsTheDrag) {
    for (const PointerButton button : {PointerButton::left, PointerButton::right}) {
        send(Kind::press, sky, button);
        send(Kind::move, sky + glm::vec2(50, 0), button);
        send(Kind::move, sky + glm::vec2(90, 0), button, false, false,
             true); // goes on over a panel
        EXPECT_NE(tools.drag(), Tools::Drag::none);
        send(Kind::release, sky + glm::vec2(90, 0), button, false, false, true);
        EXPECT_EQ(tools.drag(), Tools::Drag::none);
        const Camera let_go = camera;
        send(Kind::move, sky + glm::vec2(200, 100), button);
        EXPECT_EQ(camera.yaw, let_go.yaw);
        EXPECT_EQ(camera.target, let_go.target);
    }
}

TEST_F(ToolsTest, PressAndWheelOverAPanelAreThePanels) {
    const Camera before = camera;
    send(Kind::press, ball, PointerButton::left, false, false, true);
    send(Kind::move, ball + glm::vec2(50, 0));
    send(Kind::release, ball + glm::vec2(50, 0));
    EXPECT_EQ(camera.yaw, before.yaw);
    EXPECT_FALSE(selected.has_value());
    PointerEvent wheel;
    wheel.kind = Kind::wheel;
    wheel.notches = 3;
    wheel.over_panel = true;
    tools.handle(wheel, {session, camera, selected, selected_particle, viewport});
    EXPECT_EQ(camera.distance, before.distance);
    wheel.over_panel = false;
    tools.handle(wheel, {session, camera, selected, selected_particle, viewport});
    EXPECT_LT(camera.distance, before.distance);
}

TEST_F(ToolsTest, AnotherButtonsReleaseDoesNotEndADrag) {
    send(Kind::press, sky, PointerButton::right);
    send(Kind::press, sky, PointerButton::left);
    send(Kind::release, sky, PointerButton::left);
    EXPECT_EQ(tools.drag(), Tools::Drag::pan);
    send(Kind::release, sky, PointerButton::right);
    EXPECT_EQ(tools.drag(), Tools::Drag::none);
}

// The grabbed point stays in the camera-facing plane through it and follows the pointer there: here
// z = 1, the front of the ball as seen from +z.
TEST_F(ToolsTest, AGrabPullsEachStepTowardsThePointerInAPlane) {
    send(Kind::press, ball, PointerButton::left, true);
    EXPECT_EQ(tools.drag(), Tools::Drag::grab);
    EXPECT_EQ(selected, 0u);
    ASSERT_TRUE(session.grabbed().has_value());
    EXPECT_NEAR(session.grabbed()->local_point.z, 1, 1e-5);
    send(Kind::move, ball + glm::vec2(100, 50), PointerButton::left, true);
    const glm::dvec3 target = session.grabbed()->target;
    EXPECT_NEAR(target.z, 1, 1e-5);
    // Projected back through the camera, the target lies under the pointer. Pixels are floats of a
    // few hundred.
    const glm::vec3 pixel = camera.project(glm::vec3(target), viewport);
    EXPECT_NEAR(pixel.x, 500, 1e-2);
    EXPECT_NEAR(pixel.y, 350, 1e-2);
    session.step();
    const auto &grabbed = std::get<GrabBody>(fake().commands.at(0));
    EXPECT_EQ(grabbed.body, "left");
    EXPECT_EQ(grabbed.target, target);
    EXPECT_EQ(grabbed.max_force, tools.grab_strength); // for a mass of 1 kg
    session.step();
    EXPECT_EQ(fake().commands.size(), 1u); // the pointer does not move
    send(Kind::move, ball + glm::vec2(50, 50), PointerButton::left, true);
    session.step();
    EXPECT_EQ(std::get<MoveGrab>(fake().commands.at(1)).target, session.grabbed()->target);
    send(Kind::release, ball, PointerButton::left, false);
    EXPECT_FALSE(session.grabbed().has_value());
    session.step();
    ASSERT_EQ(fake().commands.size(), 3u);
    EXPECT_TRUE(std::holds_alternative<ReleaseGrab>(fake().commands[2]));
}

TEST_F(ToolsTest, ShiftClickShootsABallAlongTheRay) {
    send(Kind::press, ball, PointerButton::left, false, true);
    ASSERT_EQ(fake().body_count(), 3u);
    const BodyState shot = fake().read().bodies[2];
    EXPECT_NEAR(glm::length(shot.velocity), tools.shot_speed, 1e-4);
    EXPECT_NEAR(shot.velocity.z, -tools.shot_speed, 1e-4);
    EXPECT_LT(shot.position.z, static_cast<double>(camera.eye().z));
    EXPECT_FALSE(selected.has_value());
}

TEST_F(ToolsTest, AGrabEndsWhenTheSessionLetsGo) {
    session.step();
    send(Kind::press, ball, PointerButton::left, true);
    ASSERT_TRUE(session.step_back());
    const Camera before = camera;
    send(Kind::move, ball + glm::vec2(100, 50), PointerButton::left, true);
    EXPECT_EQ(tools.drag(), Tools::Drag::none);
    EXPECT_EQ(camera.yaw, before.yaw);
}

} // namespace
} // namespace plumb
