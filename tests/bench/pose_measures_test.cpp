// Pose measures against values that follow from how the poses were made.
#include "app/lab/engines/pose_measures.h"
#include "tests/bench/scene_parts.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

using namespace parts;

std::vector<BodyState> states_at_start(const SceneDesc &scene) {
    std::vector<BodyState> states;
    for (const BodyDesc &body : scene.bodies)
        states.push_back({body.position, body.orientation, {}, {}});
    return states;
}

TEST(PoseMeasures, DepthsAreThoseOfThePoses) {
    SceneDesc desc = on_ground();
    add(desc, "low", BoxDesc{}, {0, 0.49, 0});          // four points 10 mm deep in the ground
    add(desc, "high", BoxDesc{}, {0, 1.49 - 0.002, 0}); // four 2 mm deep in the box below
    add(desc, "apart", SphereDesc{0.5}, {3, 0.501, 0});
    const EngineScene scene(desc);
    const Depth depth = PoseMeasures(scene).depth(states_at_start(desc));
    EXPECT_NEAR(depth.deepest, 0.01, 1e-12);
    EXPECT_NEAR(depth.mean, 0.006, 1e-12);
}

TEST(PoseMeasures, BodiesOfOneJointMayOverlap) {
    SceneDesc desc;
    add(desc, "a", SphereDesc{0.5}, {0, 0, 0});
    add(desc, "b", SphereDesc{0.5}, {0.5, 0, 0});
    add_joint(desc, JointType::ball, 0, 1, {0.25, 0, 0});
    const EngineScene scene(desc);
    const PoseMeasures measures(scene);
    std::vector<BodyState> states = states_at_start(desc);
    EXPECT_EQ(measures.depth(states).deepest, 0);
    EXPECT_EQ(measures.joint_drift(states), 0);
    states[1].position += glm::dvec3(0, 0.03, 0.04);
    EXPECT_NEAR(measures.joint_drift(states), 0.05, 1e-12);
}

TEST(PoseMeasures, KineticEnergyIsThatOfTheMotionBetweenTwoPoses) {
    SceneDesc desc;
    add(desc, "box", BoxDesc{}, {0, 0, 0}).mass = 6; // moment 1 kg m^2 about each axis
    const EngineScene scene(desc);
    const PoseMeasures measures(scene);
    const std::vector<BodyState> before = states_at_start(desc);
    std::vector<BodyState> after = before;
    constexpr double dt = 0.01;
    after[0].position = {3 * dt, 0, 0};
    after[0].orientation = glm::angleAxis(4 * dt, glm::dvec3(0, 0, 1));
    EXPECT_NEAR(measures.kinetic_energy(before, after, dt), 0.5 * 6 * 9 + 0.5 * 16, 1e-5);
    EXPECT_NEAR(measures.top_displacement(after), 0.03, 1e-12);
}

} // namespace
} // namespace plumb
