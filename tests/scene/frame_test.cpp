// Everything shown of a simulation comes from one call.
#include "engine/scene/simulation.h"

#include <memory>
#include <set>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace plumb {

namespace {

// A ball on a floor, a second one jointed to it, and a third that bounces.
std::unique_ptr<Simulation> three_balls() {
    SceneDesc scene;
    BodyDesc floor;
    floor.name = "floor";
    floor.kind = BodyKind::static_body;
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

// A joint that moves nothing bears nothing, and can be read like any other.
TEST(Frame, HoldsAJointOfAStaticBodyToTheWorld) {
    for (const bool is_a : {true, false}) {
        SceneDesc scene;
        BodyDesc floor;
        floor.name = "floor";
        floor.kind = BodyKind::static_body;
        floor.colliders.emplace_back().shape = BoxDesc{{5, 0.5, 5}};
        scene.bodies.push_back(floor);
        JointDesc joint;
        joint.name = "link";
        joint.type = JointType::ball;
        (is_a ? joint.body_a : joint.body_b) = "floor";
        scene.joints.push_back(joint);
        const std::unique_ptr<Simulation> simulation = Simulation::create(scene, {}, nullptr);
        simulation->step();
        const Frame frame = simulation->read({.joints = true});
        ASSERT_EQ(frame.joints.size(), 1u);
        EXPECT_EQ(frame.joints[0].force, glm::dvec3{0});
    }
}

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
            // The whole change of the ball's momentum in this step, less gravity.
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

// Reading into a frame again keeps nothing of its old content.
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

// A hinge and a fixed joint to the world, with the body moved out of place: one error is in metres,
// the other in radians.
TEST(Frame, ErrorsOfAJointAreALengthAndAnAngle) {
    for (const JointType type : {JointType::hinge, JointType::fixed}) {
        SceneDesc scene;
        BodyDesc &body = scene.bodies.emplace_back();
        body.name = "door";
        body.colliders.emplace_back().shape = BoxDesc{{0.5, 0.5, 0.5}};
        JointDesc &joint = scene.joints.emplace_back();
        joint.name = "joint";
        joint.type = type;
        joint.body_b = "door";
        const auto simulation = Simulation::create(scene, {}, nullptr);
        const auto error_at = [&](const glm::dvec3 &place, const glm::dquat &turn) {
            simulation->apply(SetMotion{"door", place, turn, {}, {}});
            const JointView view = simulation->read({.joints = true}).joints.at(0);
            return std::pair{view.drift, view.angle_drift};
        };
        const double angle = 0.1;
        const glm::dquat tilt = glm::angleAxis(angle, glm::dvec3(0, 0.6, 0.8));
        const auto apart = error_at({0.03, 0, 0.04}, {1, 0, 0, 0});
        EXPECT_NEAR(apart.first, 0.05, 1e-6);
        EXPECT_NEAR(apart.second, 0, 1e-6);
        const auto tilted = error_at({0, 0, 0}, tilt);
        EXPECT_NEAR(tilted.first, 0, 1e-6);
        EXPECT_NEAR(tilted.second, angle, angle * angle * angle / 6 + 1e-6);
        const auto both = error_at({0.03, 0, 0.04}, tilt);
        EXPECT_NEAR(both.first, 0.05, 1e-6);
        EXPECT_NEAR(both.second, angle, angle * angle * angle / 6 + 1e-6);
        // A hinge turns about its own axis, x.
        const auto turned = error_at({0, 0, 0}, glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
        EXPECT_NEAR(turned.second, type == JointType::hinge ? 0 : angle, 2e-4);
        EXPECT_NEAR(simulation->measure().max_joint_drift, turned.second, 1e-6);
    }
}

// A dumbbell with a ball on each triangle of a mesh, one of them inside a sensor.
TEST(Frame, ContactsSayWhatTouches) {
    SceneDesc scene;
    BodyDesc &ground = scene.bodies.emplace_back();
    ground.name = "ground";
    ground.kind = BodyKind::static_body;
    MeshData quad; // two triangles, split along x = z
    quad.vertices = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    MeshDesc mesh;
    mesh.data = std::make_shared<const MeshData>(quad);
    ground.colliders.emplace_back().shape = mesh;
    BodyDesc &dumbbell = scene.bodies.emplace_back();
    dumbbell.name = "dumbbell";
    dumbbell.position = {0, 0.25, 0};
    for (const double side : {-1.0, 1.0}) {
        ColliderDesc &ball = dumbbell.colliders.emplace_back();
        ball.shape = SphereDesc{0.25};
        ball.position = {side, 0, -0.5 * side};
    }
    BodyDesc &gate = scene.bodies.emplace_back();
    gate.name = "gate";
    gate.kind = BodyKind::static_body;
    gate.position = {1, 0.5, -0.5};
    gate.colliders.emplace_back().shape = BoxDesc{{0.3, 0.3, 0.3}};
    gate.colliders.front().sensor = true;
    const auto simulation = Simulation::create(scene, {}, nullptr);
    for (int i = 0; i < 10; ++i)
        simulation->step();
    int on_ground = 0;
    int in_gate = 0;
    for (const ContactView &contact : simulation->read({.contacts = true}).contacts) {
        if (contact.is_sensor) {
            EXPECT_EQ(contact.body_a, 1u);
            EXPECT_EQ(contact.body_b, 2u);
            EXPECT_EQ(contact.child_a, 1u);
            EXPECT_EQ(contact.normal_force, 0);
            EXPECT_FALSE(contact.triangle);
            ++in_gate;
            continue;
        }
        EXPECT_EQ(contact.body_a, 0u);
        EXPECT_EQ(contact.child_a, 0u);
        // The ball at -1 is on the side z > x, on the first triangle.
        EXPECT_EQ(contact.triangle, contact.child_b) << contact.position.x;
        EXPECT_EQ(contact.position.x > 0, contact.child_b == 1);
        ++on_ground;
    }
    EXPECT_EQ(on_ground, 2);
    EXPECT_EQ(in_gate, 1);
}

// The corners of a box lying flat are four features, and keep their ids from step to step.
TEST(Frame, FeaturesOfPointsLast) {
    SceneDesc scene;
    for (const char *name : {"floor", "box"}) {
        BodyDesc &body = scene.bodies.emplace_back();
        body.name = name;
        body.kind = scene.bodies.size() == 1 ? BodyKind::static_body : BodyKind::dynamic;
        const double half = scene.bodies.size() == 1 ? 3 : 0.5;
        body.colliders.emplace_back().shape = BoxDesc{glm::dvec3(half)};
        body.position = {0, scene.bodies.size() == 1 ? -3 : 0.5, 0};
    }
    const auto simulation = Simulation::create(scene, {}, nullptr);
    std::set<std::uint32_t> first;
    for (int i = 0; i < 20; ++i) {
        simulation->step();
        std::set<std::uint32_t> features;
        for (const ContactView &contact : simulation->read({.contacts = true}).contacts)
            features.insert(contact.feature);
        EXPECT_EQ(features.size(), 4u);
        if (i == 0)
            first = features;
        EXPECT_EQ(features, first);
    }
}

} // namespace plumb
