// Steps split over many threads give the same bits as with one. These are the tests to run under
// ThreadSanitizer.
#include "tests/dynamics/all_sorts.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Threads : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Threads, testing::ValuesIn(contact_methods()), name_of);

// A heap collapsing under nets: many times more pairs, joints and springs than one part of the
// parallel loop over them takes.
World heap(const std::string &method) {
    Random random(9);
    World world(method, settings_for(method));
    world.add_body(ground(0.6, 0.3));
    BodyId last;
    for (int i = 0; i < 400; ++i) {
        const V at{0.45 * (i % 8), 0.4 + 0.45 * (i / 64), 0.45 * (i / 8 % 8)};
        BodyDef def = dynamic_body(any_shape(random), 1, at, any_vector(random, 1));
        def.pose.rotation = narrow(any_rotation(random));
        const BodyId id = world.add_body(with_material(def, 0.5, 0.2));
        if (i % 16 == 1) {
            JointDef joint;
            joint.a = last;
            joint.b = id;
            joint.anchor_a_local = narrow(V{0.2, 0, 0});
            joint.anchor_b_local = narrow(V{-0.25, 0, 0});
            world.add_joint(joint);
        }
        last = id;
    }
    if (find_method(method)->info.joints)
        add_joined_net(world, 9, {0, 5, 0});
    if (find_method(method)->info.springs)
        add_net(world, {.n = 17,
                        .side = 4,
                        .middle = {1.6, 4, 1.6},
                        .mass = 1,
                        .stiffness = 500,
                        .damping = 0.2});
    return world;
}

void share_steps(const std::string &method, TaskPool::Parts parts) {
    World alone = heap(method), shared = heap(method);
    TaskPool tasks(8, parts);
    SavedWorld saved;
    std::uint64_t most_pairs = 0; // some methods throw the heap apart
    for (int step = 0; step < 8; ++step) {
        alone.step(nullptr);
        shared.step(&tasks);
        ASSERT_EQ(shared.hash(), alone.hash()) << "step " << step;
        most_pairs = std::max<std::uint64_t>(most_pairs, shared.report().pairs);
        // Between steps: all threads see the results of edits, saves and restores.
        if (step == 2)
            shared.save(saved);
        if (step == 4)
            for (World *world : {&alone, &shared}) {
                world->remove_body(world->body_id(40));
                world->add_body(dynamic_body(ball(0.3), 2, V{1, 6, 1}));
            }
    }
    EXPECT_GE(most_pairs, 20U * 64);
    shared.restore(saved);
    for (int step = 0; step < 2; ++step)
        shared.step(&tasks);
    EXPECT_TRUE(shared.report().finite);
}

TEST_P(Threads, ShareAStepWithoutARace) {
    share_steps(GetParam(), TaskPool::Parts::large);
}

TEST_P(Threads, ShareItInTheSmallestPartsWithoutARace) {
    share_steps(GetParam(), TaskPool::Parts::single);
}

// Surfaces, hulls, cylinders, compounds, sensors, joints of all types, cloth, a grab and holes.
class ThreadsOfAllSorts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, ThreadsOfAllSorts, testing::ValuesIn(all_methods()), name_of);

TEST_P(ThreadsOfAllSorts, GiveTheSameBits) {
    World alone = world_of_all_sorts(GetParam(), 112);
    std::vector<World> shared(5, alone);
    TaskPool one(1), two(2), seven(7);
    TaskPool two_fine(2, TaskPool::Parts::single), seven_fine(7, TaskPool::Parts::single);
    const std::array<TaskPool *, 5> pools{&one, &two, &seven, &two_fine, &seven_fine};
    const MethodInfo &info = alone.method().info;
    const Random random(3);
    for (int step = 0; step < 12; ++step) {
        alone.step(nullptr);
        for (std::size_t pool = 0; pool < shared.size(); ++pool) {
            shared[pool].step(pools[pool]);
            ASSERT_EQ(shared[pool].hash(), alone.hash()) << "step " << step << ", pool " << pool;
        }
        shared.push_back(alone);
        for (World &world : shared) {
            if (step == 3) {
                world.remove_body(world.body_id(20));
                if (info.springs)
                    world.grab_particle(5, narrow(V{0, 3, 0}), Real(20));
            }
            if (step == 6) {
                Random same = random;
                world.add_body(one_of_all_sorts(same, 4, {0, 2, 0}));
                world.set_motion(world.body_id(30), {narrow(V{0, 1, 0}), identity_rotation},
                                 narrow(V{20, 0, 0}), narrow(V{0, 9, 0}));
            }
        }
        alone = std::move(shared.back());
        shared.pop_back();
    }
    if (info.contacts) {
        EXPECT_GT(alone.report().contacts, 60U);
    }
    if (info.contacts && info.springs) {
        EXPECT_GT(alone.report().particle_contacts, 5U);
    }
    if (info.joints) {
        EXPECT_GT(alone.report().joints, 40U);
    }
}

// With sleep and per-island substeps: bodies fall asleep, and are woken by others falling on them.
TEST_P(ThreadsOfAllSorts, GiveTheSameBitsWhereBodiesSleep) {
    World alone(GetParam(), settings_for(GetParam()));
    StepSettings settings = alone.settings();
    settings.sleep_after = 0.05;
    settings.substep_tolerance = 0.02;
    alone.set_settings(settings);
    alone.add_body(ground(0.6, 0));
    for (int i = 0; i < 48; ++i)
        alone.add_body(dynamic_body(block(V{0.2}), 1,
                                    V{0.5 * (i % 6), 0.2 + 0.4 * (i / 6 % 2), 0.5 * (i / 12)}));
    for (int i = 0; i < 3; ++i)
        alone.add_body(dynamic_body(ball(0.2), 3, V{1.0 * i, 2.0 + i, 0.6}));
    World shared = alone;
    TaskPool seven(7, TaskPool::Parts::single);
    int asleep = 0, woken = 0;
    for (int step = 0; step < 60; ++step) {
        const auto before = std::ranges::count_if(alone.state().paces, &Pace::is_asleep);
        alone.step(nullptr);
        shared.step(&seven);
        ASSERT_EQ(shared.hash(), alone.hash()) << "step " << step;
        const auto after = std::ranges::count_if(alone.state().paces, &Pace::is_asleep);
        asleep += after > before ? 1 : 0;
        woken += after < before ? 1 : 0;
    }
    const auto &groups = alone.method().info.reads;
    if (std::ranges::find(groups, SettingGroup::sleep) != groups.end()) {
        EXPECT_GT(asleep, 0);
        EXPECT_GT(woken, 0);
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
