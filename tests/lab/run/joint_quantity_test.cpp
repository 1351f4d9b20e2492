// Quantities of one joint or body, against closed forms.
#include "app/lab/run/quantity_probe.h"
#include "engine/scene/scene_file.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double standard_gravity = 9.81;

SceneDesc scene_with_joint(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "joint.toml");
    EXPECT_TRUE(result.ok()) << format_message("joint.toml", result.messages.front());
    return result.scene;
}

double value_now(const Simulation &simulation, const std::string &quantity,
                 const std::string &subject) {
    return QuantityProbe(simulation, {{quantity, subject}}).sample(simulation).front();
}

void run_for(Simulation &simulation, int steps) {
    for (int i = 0; i < steps; ++i)
        simulation.step();
}

TEST(JointQuantities, OfAHangingWeight) {
    const auto simulation = Simulation::create(scene_with_joint(R"(
[[body]]
name = "weight"
shape = "sphere"
radius = 0.1
mass = 2
[[joint]]
name = "rope"
type = "distance"
anchor_a = [0, 1.5, 0]
body_b = "weight"
)"),
                                               {}, nullptr);
    run_for(*simulation, 60);
    const auto value = [&](const char *quantity) {
        return value_now(*simulation, quantity, "rope");
    };
    EXPECT_NEAR(value("joint_force"), 2 * standard_gravity, 1e-3);
    EXPECT_NEAR(value("joint_force.y"), 2 * standard_gravity, 1e-3);
    EXPECT_NEAR(value("joint_force.x"), 0, 1e-6);
    EXPECT_NEAR(value("joint_extension"), 1.5, 1e-4);
    EXPECT_NEAR(value("joint_extension_rate"), 0, 1e-4);
    EXPECT_LT(value("joint_error"), 1e-4);
    EXPECT_EQ(value("joint_torque"), 0);
    EXPECT_THROW((void)value("joint_angle"), std::invalid_argument);
    EXPECT_THROW((void)value_now(*simulation, "joint_force", "weight"), std::invalid_argument);
}

// A beam held at one end: the force is m g, the torque m g times the arm.
TEST(JointQuantities, OfABeamHeldAtOneEnd) {
    const auto simulation = Simulation::create(scene_with_joint(R"(
[[body]]
name = "beam"
shape = "box"
half_extents = [0.5, 0.05, 0.05]
mass = 3
position = [0.5, 0, 0]
[[joint]]
name = "wall"
type = "fixed"
body_b = "beam"
anchor = [0, 0, 0]
)"),
                                               {}, nullptr);
    run_for(*simulation, 60);
    EXPECT_NEAR(value_now(*simulation, "joint_force.y", "wall"), 3 * standard_gravity, 0.01);
    EXPECT_NEAR(value_now(*simulation, "joint_torque.z", "wall"), 3 * standard_gravity * 0.5, 0.01);
    EXPECT_NEAR(value_now(*simulation, "joint_torque", "wall"), 3 * standard_gravity * 0.5, 0.01);
}

// A small swing: theta0 cos(w t) with w^2 = m g d / (m d^2 + 2/5 m r^2); the angle counts from the
// start.
TEST(JointQuantities, OfAHingedPendulum) {
    constexpr double small = 0.02, d = 1, r = 0.1;
    SceneDesc scene = scene_with_joint(R"(
[world]
precision = "double"
[[body]]
name = "bob"
shape = "sphere"
radius = 0.1
mass = 2
[[joint]]
name = "pivot"
type = "hinge"
body_b = "bob"
anchor = [0, 0, 0]
axis = [0, 0, 1]
)");
    scene.bodies.front().position = {d * std::sin(small), -d * std::cos(small), 0};
    scene.joints.front().anchor_b_local = -scene.bodies.front().position;
    const auto simulation = Simulation::create(scene, {}, nullptr);
    const double rate = std::sqrt(standard_gravity * d / (d * d + 0.4 * r * r));
    for (int i = 0; i < 60; ++i) {
        simulation->step();
        const double turned = rate * simulation->time();
        EXPECT_NEAR(value_now(*simulation, "joint_angle", "pivot"), small * (std::cos(turned) - 1),
                    1e-3 * small);
        EXPECT_NEAR(value_now(*simulation, "joint_angle_rate", "pivot"),
                    -small * rate * std::sin(turned), 2e-3 * small * rate);
    }
    const double speed = small * rate * std::sin(rate * simulation->time());
    EXPECT_NEAR(value_now(*simulation, "body_kinetic_energy", "bob"),
                (d * d + 0.4 * r * r) * speed * speed, 1e-2 * small * small * rate * rate);
}

// A slider falls freely along its axis.
TEST(JointQuantities, OfAFallingSlider) {
    const auto simulation = Simulation::create(scene_with_joint(R"(
[[body]]
name = "block"
shape = "box"
half_extents = [0.1, 0.1, 0.1]
[[joint]]
name = "rail"
type = "slider"
body_b = "block"
anchor = [0, 0, 0]
axis = [0, -1, 0]
)"),
                                               {}, nullptr);
    run_for(*simulation, 30);
    EXPECT_NEAR(value_now(*simulation, "joint_extension", "rail"), 0.5 * standard_gravity * 0.25,
                1e-4);
    EXPECT_NEAR(value_now(*simulation, "joint_extension_rate", "rail"), 0.5 * standard_gravity,
                1e-4);
}

// One body alone has all of the scene's, also if its principal axes are not its own; a particle has
// m v^2 / 2.
TEST(BodyQuantities, KineticEnergy) {
    const auto simulation = Simulation::create(scene_with_joint(R"(
[world]
gravity = [0, 0, 0]
precision = "double"
[[body]]
name = "skew"
shapes = [
    { shape = "box", half_extents = [0.5, 0.1, 0.1] },
    { shape = "sphere", radius = 0.2, position = [0.4, 0.5, 0.2] },
]
velocity = [1, 2, 3]
angular_velocity = [3, -1, 2]
rotation_deg = [10, 20, 30]
)"),
                                               {}, nullptr);
    run_for(*simulation, 10);
    const double whole = simulation->measure().kinetic_energy;
    EXPECT_GT(whole, 100);
    EXPECT_NEAR(value_now(*simulation, "body_kinetic_energy", "skew"), whole, 1e-9 * whole);

    const auto other = Simulation::create(scene_with_joint(R"(
[[particle]]
name = "mote"
mass = 0.5
velocity = [3, 4, 0]
)"),
                                          {}, nullptr);
    EXPECT_EQ(value_now(*other, "body_kinetic_energy", "mote"), 0.5 * 0.5 * 25);
}

} // namespace
} // namespace plumb
