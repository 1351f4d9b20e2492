// Residuals of the contact laws, where they are known in closed form.
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// A 2 kg box, friction 0.5 against the ground.
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

// A box sliding at v loses mu m g v, all the power that friction can take.
TEST_P(ContactLaw, ABoxThatSlidesLosesWhatFrictionTakes) {
    const auto simulation = box(GetParam(), "velocity = [2.4, 0, 1.8]\n");
    for (int i = 0; i < 60; ++i)
        simulation->step();
    const Measures now = simulation->measure();
    const double force = 0.5 * 2 * 9.81;
    const double speed = 3 - 0.5 * 9.81 * 0.25;
    EXPECT_NEAR(now.contact_power, -force * speed, 0.02 * force * speed);
    // soft_step's stored impulse anticipates what its next relaxation pass will change.
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

// Known failing: XPBD's friction is off by a few per cent (here 3.5 % of the power it can take).
// The forces it does have obey the laws, and at rest nothing is off.
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

// Known failing: gravity comes after naive impulses, so a box at rest falls in every step and is
// hit back, at some watts; its friction stays in the cone.
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
