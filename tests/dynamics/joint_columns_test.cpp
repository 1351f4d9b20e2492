// Ball joints in columns match the functions for single joints bit for bit, in the same order.
#include "engine/dynamics/joints/joint_columns.h"

#include "tests/dynamics/solver_view.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

struct Solved : SolverView {
    Solved(const World &world, Random random) : SolverView(world) {
        for (std::uint32_t i = 0; i < joints.size(); ++i) {
            group.joints.push_back(i);
            for (std::size_t row = 0; row < 3; ++row)
                joints[i].impulses[row] = Real(random.next_in(-1, 1));
        }
        context.joints = joints;
    }

    // The passes of a substep, without what they do not share.
    void solve(bool in_columns) {
        const Real h = Real(0.004);
        const JointPass holding{.softness = make_soft(Real(60), Real(5), h),
                                .push_velocity = Real(3),
                                .h = h,
                                .at_the_end = true,
                                .springs = Springs::midpoint};
        const JointPass relaxing{.softness = {}, .h = h, .springs = Springs::skip};
        prepare_joints(context);
        joint_system.arrange(context);
        if (in_columns)
            prepare_joint_columns(context);
        for (int substep = 0; substep < 2; ++substep) {
            follow_loads(context, h);
            if (substep == 0)
                weigh_joints(context);
            else
                weigh_changed_joints(context);
            remember_joints(context);
            warm_start_joints(context, Real(0.5), Springs::midpoint);
            solve_joints(context, holding);
            drift(context, h);
            refresh_joints(context);
            warm_start_joints(context, Real(0.5), Springs::skip);
            solve_joints(context, relaxing);
            store_joint_columns(context);
        }
    }
    std::size_t count_in_columns() const {
        return static_cast<std::size_t>(
            std::ranges::count(scratch.joints, true, &JointConstraint::in_columns));
    }
};

// Some bodies spin too fast for the chord's series, some are very heavy or light, some cannot move
// or turn along an axis, and some joint ends are the world's or kinematic.
World net(Random &random) {
    World world("soft_step", settings_for("soft_step"));
    add_joined_net(world, 8, V{0});
    const auto ids = [&] { return static_cast<std::uint32_t>(world.bodies().size()); };
    for (int i = 0; i < 60; ++i) {
        BodyDef def = dynamic_body(any_shape(random), std::pow(10, random.next_in(-4, 4)),
                                   any_vector(random, 3), any_vector(random, 3));
        def.pose.rotation = narrow(any_rotation(random));
        def.angular_velocity = narrow(any_vector(random, random.next_in(0, 1) < 0.3 ? 200 : 5));
        if (i % 7 == 0)
            def.locked[static_cast<std::size_t>(i % 6)] = true;
        if (i % 11 == 0) {
            def.kind = BodyKind::kinematic;
            def.mass.reset();
            def.locked = {};
        }
        world.add_body(def);
        for (int k = 0; k < 3; ++k) {
            JointDef joint;
            const auto other = static_cast<std::uint32_t>(random.next_in(0, ids() - 1));
            joint.a = world.body_id(ids() - 1);
            if (i % 13 != 0 || k > 0)
                joint.b = world.body_id(other);
            if (random.next_in(0, 1) < 0.5)
                std::swap(joint.a, joint.b);
            joint.anchor_a_local = narrow(any_vector(random, 0.5));
            joint.anchor_b_local = narrow(any_vector(random, 0.5));
            world.add_joint(joint);
        }
    }
    return world;
}

TEST(JointColumns, ComeToTheBitsOfSingleJoints) {
    for (int seed = 0; seed < 20; ++seed) {
        Random random(static_cast<std::uint64_t>(seed));
        const World world = net(random);
        Solved columns(world, random), single(world, random);
        columns.solve(true);
        single.solve(false);
        EXPECT_EQ(single.count_in_columns(), 0U);
        ASSERT_GT(columns.count_in_columns(), 200U) << seed;
        for (std::size_t i = 0; i < columns.bodies.size(); ++i) {
            ASSERT_EQ(columns.bodies[i].velocity, single.bodies[i].velocity) << seed << ' ' << i;
            ASSERT_EQ(columns.bodies[i].angular_velocity, single.bodies[i].angular_velocity)
                << seed << ' ' << i;
        }
        for (std::size_t i = 0; i < columns.scratch.joints.size(); ++i)
            ASSERT_EQ(columns.scratch.joints[i].impulse, single.scratch.joints[i].impulse)
                << seed << ' ' << i;
    }
}

// Joints of one hub are solved one by one whatever is done, and need no columns.
TEST(JointColumns, AreNoneWhereFewCanBeSolvedAtOnce) {
    World world("soft_step", settings_for("soft_step"));
    const BodyId hub = world.add_body(dynamic_body(Sphere{Vec3{0}, Real(1)}, 100, V{0}));
    for (int i = 0; i < 100; ++i) {
        JointDef joint;
        joint.a = hub;
        joint.b = world.add_body(dynamic_body(Sphere{Vec3{0}, Real(0.1)}, 1, {2.0 + i, 0, 0}));
        joint.anchor_a_local = narrow(V{2.0 + i, 0, 0});
        world.add_joint(joint);
    }
    Solved solved(world, Random(1));
    solved.solve(true);
    EXPECT_TRUE(solved.joint_system.groups().empty());
    EXPECT_EQ(solved.count_in_columns(), 0U);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
