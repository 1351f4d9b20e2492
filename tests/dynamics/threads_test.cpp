// Steps shared out to many threads: the same bits as with one. Under ThreadSanitizer this is what
// it looks at.
#include "tests/dynamics/particles.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Threads : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Threads, testing::ValuesIn(contact_methods()), name_of);

// A heap that falls together, under nets: many times more pairs, joints and springs than a part of
// the loop over them takes.
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
        // Between steps: what edits, saves and restores leave is there for all threads.
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

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
