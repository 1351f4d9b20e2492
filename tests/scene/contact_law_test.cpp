// How far contacts are from the laws of contact, where that is known in closed form.
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// A box of 2 kg, friction 0.5 against the ground.
std::unique_ptr<Simulation> box(const std::string &method, const std::string &motion) {
    const SceneFileResult file = parse_scene(R"(
[world]
dt = "1/240"
precision = "double"
sleep_after = 0
method = ")" + method + R"("
[[body]]
name = "ground"
kind = "static"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.25, 0.5]
mass = 2
position = [0, 0.25, 0]
)" + motion,
                                             "scene.toml");
    EXPECT_TRUE(file.ok());
    return Simulation::create(file.scene, {}, nullptr);
}

class ContactLaw : public testing::TestWithParam<const char *> {};

// What slides at v loses mu m g v, all that there is to lose.
TEST_P(ContactLaw, ABoxThatSlidesLosesWhatFrictionTakes) {
    const auto simulation = box(GetParam(), "velocity = [2.4, 0, 1.8]\n");
    for (int i = 0; i < 60; ++i)
        simulation->step();
    const Measures now = simulation->measure();
    const double force = 0.5 * 2 * 9.81;
    const double speed = 3 - 0.5 * 9.81 * 0.25;
    EXPECT_NEAR(now.contact_power, -force * speed, 0.02 * force * speed);
    // What soft_step remembers of a push foresees what its next relaxing pass will change.
    const bool foresees = std::string(GetParam()) == "soft_step";
    EXPECT_LT(now.dissipation_residual, (foresees ? 2e-3 : 1e-3) * force * speed);
    EXPECT_LT(now.cone_residual, (foresees ? 2e-3 : 1e-9) * force);
    EXPECT_LT(now.signorini_residual, 1e-2);
}

TEST_P(ContactLaw, ABoxAtRestKeepsThemAll) {
    const auto simulation = box(GetParam(), "");
    for (int i = 0; i < 240; ++i)
        simulation->step();
    const Measures now = simulation->measure();
    EXPECT_LT(now.signorini_residual, 1e-4);
    EXPECT_LT(now.cone_residual, 1e-9);
    EXPECT_LT(now.dissipation_residual, 1e-4);
    EXPECT_NEAR(now.contact_power, 0, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, ContactLaw,
                         testing::Values("soft_step", "tgs_soft", "sequential_impulses", "nncg",
                                         "avbd"));

// A known failing: XPBD's friction is off by some per cent (here 3.5 % of what there is to lose).
// What it has of forces keeps the laws, and at rest nothing is off.
TEST(ContactLaw, XpbdsFrictionIsOff) {
    const auto simulation = box("xpbd", "velocity = [2.4, 0, 1.8]\n");
    for (int i = 0; i < 60; ++i)
        simulation->step();
    const Measures now = simulation->measure();
    const double power = 0.5 * 2 * 9.81 * (3 - 0.5 * 9.81 * 0.25);
    EXPECT_GT(std::abs(now.contact_power / -power - 1), 0.02);
    EXPECT_LT(std::abs(now.contact_power / -power - 1), 0.05);
    EXPECT_LT(now.dissipation_residual, 1e-3 * power);
    EXPECT_LT(now.cone_residual, 1e-9);
    EXPECT_LT(now.signorini_residual, 1e-2);
    const auto resting = box("xpbd", "");
    for (int i = 0; i < 240; ++i)
        resting->step();
    EXPECT_LT(resting->measure().signorini_residual, 1e-4);
    EXPECT_NEAR(resting->measure().contact_power, 0, 1e-4);
}

// A known failing: gravity comes after naive impulses, so a box at rest falls anew in each step and
// is struck back, at some watts; its friction stays in the cone.
TEST(ContactLaw, NaiveImpulsesPushWhatDoesNotRest) {
    for (const char *motion : {"velocity = [2.4, 0, 1.8]\n", ""}) {
        const auto simulation = box("naive_impulses", motion);
        for (int i = 0; i < 60; ++i)
            simulation->step();
        const Measures now = simulation->measure();
        EXPECT_GT(now.signorini_residual, 0.1);
        EXPECT_LT(now.signorini_residual, 2);
        EXPECT_LT(now.cone_residual, 1e-9);
        EXPECT_LT(now.dissipation_residual, 0.1);
    }
}

TEST(ContactLaw, WithoutContactsThereIsNothing) {
    const auto simulation = box("soft_step", "velocity = [0, 5, 0]\n");
    for (int i = 0; i < 60; ++i)
        simulation->step();
    const Measures now = simulation->measure();
    EXPECT_EQ(now.signorini_residual, 0);
    EXPECT_EQ(now.cone_residual, 0);
    EXPECT_EQ(now.dissipation_residual, 0);
    EXPECT_EQ(now.contact_power, 0);
}

} // namespace
} // namespace plumb
