// Joints whose ends are apart, as after a hard hit or from a careless scene file, are closed
// without a gain of energy.
#include "tests/dynamics/worlds.h"

#include "engine/dynamics/joints/joint_rows.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

Shape any_limb(Random &random, double size) {
    const double a = size * random.next_in(0.2, 0.5), b = size * random.next_in(0.1, 0.4);
    const double c = size * random.next_in(0.1, 0.4);
    switch (random.next_index(3)) {
    case 0:
        return block(V{a, b, c});
    case 1:
        return upright_capsule(a, b);
    default:
        return ball(a);
    }
}

// A joint of any kind and place between two bodies, its ends apart by up to `gap`.
JointDef any_joint(Random &random, const World &world, BodyId a, BodyId b, double size,
                   double gap) {
    JointDef joint;
    joint.a = a;
    joint.b = b;
    const Transform at_a = world.pose_of(a.index), at_b = world.pose_of(b.index);
    const V place = wide(at_a.position) + any_vector(random, 0.5 * size);
    const auto from = [&](const Transform &at) {
        return glm::inverse(wide(at.rotation)) * (place - wide(at.position));
    };
    joint.anchor_a_local = narrow(from(at_a));
    joint.anchor_b_local = narrow(from(at_b) + any_vector(random, gap));
    const glm::dquat frame = any_rotation(random);
    joint.frame_a_local = narrow(glm::inverse(wide(at_a.rotation)) * frame);
    joint.frame_b_local = narrow(glm::inverse(wide(at_b.rotation)) * frame);
    switch (random.next_index(5)) {
    case 0:
        break;
    case 1:
        joint.type = JointType::hinge;
        joint.limits = {Real(-random.next_in(0, 1.5)), Real(random.next_in(0, 1.5))};
        break;
    case 2:
        joint.type = JointType::slider;
        joint.limits = {Real(-0.3 * size), Real(0.3 * size)};
        break;
    case 3:
        joint.type = JointType::fixed;
        break;
    default:
        joint.type = JointType::distance;
        joint.anchor_a_local = joint.anchor_b_local = Vec3{Real(0)};
        set_length(joint,
                   Real((1 + gap / size) * glm::length(wide(at_a.position) - wide(at_b.position))));
    }
    return joint;
}

// Five bodies in a tree that do not collide.
void add_tree(World &world, Random &random, double size, double gap) {
    std::vector<BodyId> limbs;
    for (int i = 0; i < 5; ++i) {
        const V at = size * V{random.next_in(-1, 1), 2 + 0.9 * (i % 3), random.next_in(-1, 1)};
        BodyDef limb = dynamic_body(any_limb(random, size), 200 * size * size * size, at);
        limb.pose.rotation = narrow(any_rotation(random));
        limb.colliders[0].filter = {0, 1};
        limbs.push_back(world.add_body(limb));
        if (i > 0)
            world.add_joint(any_joint(random, world,
                                      limbs[random.next_index(static_cast<std::uint32_t>(i))],
                                      limbs.back(), size, gap));
    }
}

struct Gain {
    double in_a_step = 0; // J
    double in_all = 0;
};
Gain gain_of(World &world, double seconds, double dt) {
    const double first = world.energy();
    double before = first;
    Gain gain;
    for (int step = 0; step < seconds / dt; ++step) {
        world.step(nullptr);
        const double now = world.energy();
        gain.in_a_step = std::max(gain.in_a_step, now - before);
        gain.in_all = std::max(gain.in_all, now - first);
        before = now;
    }
    return gain;
}

// Without gravity, what is pulled together takes on no more speed than a joint is pushed with, and
// loses it again.
TEST(TornJoints, CloseWithoutEnergy) {
    for (std::uint32_t seed = 0; seed < 40; ++seed)
        for (const double gap : {0.01, 0.1, 0.3}) {
            Random random(seed);
            StepSettings settings = settings_for("soft_step");
            settings.gravity = V{0};
            settings.dt = seed % 3 == 0 ? 1.0 / 30 : seed % 3 == 1 ? 1.0 / 60 : 1.0 / 120;
            World world("soft_step", settings);
            const double size = seed % 2 == 0 ? 1 : 0.2;
            add_tree(world, random, size, gap * size);
            const double mass = 1000 * size * size * size;
            EXPECT_LT(gain_of(world, 8, settings.dt).in_all, 0.5 * mass) << seed << ", " << gap;
            EXPECT_LT(world.measure().max_joint_drift, 1e-3 * size) << seed << ", " << gap;
        }
}

// The angle of a soft hinge jumps where its axes turn against each other.
TEST(TornJoints, OfASoftHingeThatBendsByHalfATurnGainNothing) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        StepSettings settings = settings_for("soft_step");
        settings.gravity = V{0};
        settings.dt = seed % 3 == 0 ? 1.0 / 30 : seed % 3 == 1 ? 1.0 / 60 : 1.0 / 120;
        World world("soft_step", settings);
        BodyDef flap = dynamic_body(block(V{0.3, 0.2, 0.1}), 1, V{0.5, 0, 0});
        flap.angular_velocity = narrow(any_vector(random, 20));
        flap.colliders[0].filter = {0, 1};
        JointDef hinge;
        hinge.type = JointType::hinge;
        hinge.b = world.add_body(flap);
        hinge.anchor_b_local = Vec3{Real(-0.5), Real(0), Real(0)};
        hinge.limits = {Real(-random.next_in(0, 1)), Real(random.next_in(0, 1))};
        hinge.frequency = Real(random.next_in(0.5, 3));
        hinge.damping_ratio = Real(random.next_in(0, 0.5));
        world.add_joint(hinge);
        const double first = world.energy();
        EXPECT_LT(gain_of(world, 10, settings.dt).in_all, 0.1 * first) << seed;
    }
}

TEST(TornJoints, LimitsOfAHingeAreOpenWhereItIsFolded) {
    for (const double lean : {0.3, 1.5, 1.6, 2.5, 3.1}) {
        World world("soft_step", settings_for("soft_step"));
        BodyDef flap = dynamic_body(ball(0.5), 1, V{0});
        flap.pose.rotation =
            narrow(glm::angleAxis(lean, V{0, 1, 0}) * glm::angleAxis(0.7, V{1, 0, 0}));
        JointDef hinge;
        hinge.type = JointType::hinge;
        hinge.b = world.add_body(flap);
        hinge.limits = {Real(-0.1), Real(0.1)};
        hinge.frequency = Real(1);
        world.add_joint(hinge);
        const Joint &joint = world.joints()[0];
        const JointError error =
            joint_error(joint, world.joint_motion(joint.a), world.joint_motion(joint.b));
        const double beyond = lean < pi / 2 ? 0.7 - 0.1 : 0;
        EXPECT_NEAR(error.angular, std::hypot(std::sin(lean), beyond), 1e-5) << lean;
    }
}

// A bridge of planks, drawn a little too loosely, from the world to it or to a kinematic post;
// bodies fall on it.
TEST(TornJoints, OfABridgeGainNothing) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        StepSettings settings = settings_for("soft_step");
        settings.dt = seed % 2 == 0 ? 1.0 / 120 : 1.0 / 60;
        World world("soft_step", settings);
        const int planks = 3 + static_cast<int>(random.next_index(14));
        const double size = seed % 4 < 2 ? 1 : 0.1, height = size * random.next_in(0.5, 6);
        const double loose = random.next_in(0, 0.02) * 0.5 * planks * size;
        BodyId before{};
        const auto join = [&](BodyId a, BodyId b, const V &at_a, const V &at_b) {
            JointDef joint;
            joint.a = a;
            joint.b = b;
            const auto seen_from = [&](BodyId id, const V &at) {
                return id == BodyId{} ? at : at - position_of(world, id);
            };
            joint.anchor_a_local = narrow(seen_from(a, at_a));
            joint.anchor_b_local = narrow(seen_from(b, at_b));
            world.add_joint(joint);
        };
        for (int i = 0; i < planks; ++i) {
            const V at = size * V{0.5 * i, 0, 0}, left = at - size * V{0.25, 0, 0};
            const BodyId plank =
                world.add_body(dynamic_body(block(size * V{0.24, 0.04, 0.4}), 1, at));
            join(before, plank, left, left);
            before = plank;
        }
        const V end = size * V{0.5 * planks - 0.25, 0, 0};
        BodyDef post = dynamic_body(ball(0.05 * size), 1, end);
        post.kind = BodyKind::kinematic;
        post.mass.reset();
        post.colliders[0].filter = {0, 1};
        join(before, seed % 3 == 0 ? world.add_body(post) : BodyId{}, end, end - V{loose, 0, 0});
        for (int i = 0; i < 3; ++i)
            world.add_body(dynamic_body(
                any_limb(random, 0.6 * size), random.next_in(0.3, 3),
                V{size * random.next_in(0.2, 0.5 * planks - 0.7), height + i * size, 0}));
        const double fall = (planks + 3) * gravity * height;
        EXPECT_LT(gain_of(world, 5, settings.dt).in_a_step, 0.1 * fall) << seed;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
