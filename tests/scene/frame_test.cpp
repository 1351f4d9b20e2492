// Everything that is seen of a simulation comes from one call.
#include "engine/scene/simulation.h"

#include <gtest/gtest.h>

namespace plumb {

namespace {

// A ball on a floor, with a second one that hangs on it and a third that bounces.
std::unique_ptr<Simulation> three_balls() {
    SceneDesc scene;
    BodyDesc floor;
    floor.name = "floor";
    floor.kind = BodyKind::fixed;
    floor.colliders.emplace_back().shape = BoxDesc{{5, 0.5, 5}};
    floor.position = {0, -0.5, 0};
    scene.bodies.push_back(floor);
    MaterialDesc rubber;
    rubber.name = "rubber";
    rubber.restitution = 0.8;
    scene.materials.push_back(rubber);
    for (const double x : {0.0, 1.0, 3.0}) {
        BodyDesc ball;
        ball.name = "ball" + std::to_string(scene.bodies.size());
        ball.colliders.emplace_back().shape = SphereDesc{0.25};
        ball.position = {x, x == 3.0 ? 1.0 : 0.25, 0};
        ball.material = x == 3.0 ? "rubber" : "";
        scene.bodies.push_back(ball);
    }
    JointDesc joint;
    joint.name = "link";
    joint.type = JointType::ball;
    joint.body_a = "ball1";
    joint.body_b = "ball2";
    joint.anchor_a_local = {0.5, 0, 0};
    joint.anchor_b_local = {-0.5, 0, 0};
    scene.joints.push_back(joint);
    return Simulation::create(scene, {}, nullptr);
}

} // namespace

TEST(Frame, HoldsWhatIsAskedFor) {
    const auto simulation = three_balls();
    bool has_bounced = false;
    const double mass = simulation->body_info(3).mass;
    for (int i = 0; i < 60; ++i) {
        const double before = simulation->read().bodies[3].velocity.y;
        simulation->step();
        const Frame frame = simulation->read({.impacts = true});
        for (const ImpactView &impact : frame.impacts) {
            EXPECT_EQ(impact.body_a, 0u);
            EXPECT_EQ(impact.body_b, 3u);
            // All that changed the ball's momentum in this step, less gravity.
            const double change = frame.bodies[3].velocity.y - before + 9.81 / 60;
            EXPECT_NEAR(impact.impulse, mass * change, 1e-4 * mass);
            has_bounced = true;
        }
    }
    EXPECT_TRUE(has_bounced);

    const Frame bodies = simulation->read();
    EXPECT_EQ(bodies.step_count, 60u);
    EXPECT_DOUBLE_EQ(bodies.time, simulation->time());
    ASSERT_EQ(bodies.bodies.size(), simulation->body_count());
    EXPECT_NEAR(bodies.bodies[1].position.y, 0.25, 1e-3);
    EXPECT_TRUE(bodies.joints.empty());
    EXPECT_TRUE(bodies.contacts.empty());

    const Frame all = simulation->read({.joints = true, .contacts = true});
    ASSERT_EQ(all.joints.size(), 1u);
    EXPECT_EQ(simulation->joint_name(all.joints[0].joint), "link");
    EXPECT_EQ(all.joints[0].body_b, 2u);
    EXPECT_NEAR(all.joints[0].anchor_a.x, 0.5, 1e-3);
    double force = 0;
    for (const ContactView &contact : all.contacts)
        if (contact.body_b == 1 || contact.body_b == 2)
            force += contact.normal_force;
    const double weight = 9.81 * (simulation->body_info(1).mass + simulation->body_info(2).mass);
    EXPECT_NEAR(force, weight, 0.01 * weight);
}

// A frame that is read again keeps nothing of what it held.
TEST(Frame, IsReadAnew) {
    const auto simulation = three_balls();
    simulation->step();
    Frame frame = simulation->read({.joints = true, .contacts = true, .impacts = true});
    EXPECT_FALSE(frame.contacts.empty());
    simulation->remove_body(1); // with its contacts and its joint
    simulation->remove_body(2);
    simulation->read(frame, {.joints = true, .contacts = true});
    EXPECT_TRUE(frame.joints.empty());
    for (const ContactView &contact : frame.contacts)
        EXPECT_EQ(contact.body_b, 3u);
    EXPECT_EQ(frame.bodies.size(), 4u); // holes included
    simulation->read(frame, {});
    EXPECT_TRUE(frame.contacts.empty());
}

} // namespace plumb
