// Saving, restoring, and what a step may not do.
#include "tests/dynamics/worlds.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations{0};
// How many more allocations succeed; the one after those fails.
std::atomic<std::int64_t> allocations_left{std::numeric_limits<std::int64_t>::max()};

void *counted(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
    ++allocations;
    if (allocations_left-- == 0)
        throw std::bad_alloc();
    const std::size_t whole = (std::max(size, alignment) + alignment - 1) / alignment * alignment;
    if (void *memory = std::aligned_alloc(alignment, whole))
        return memory;
    throw std::bad_alloc();
}

} // namespace

// Counts what this program allocates, and fails when asked.
void *operator new(std::size_t size) {
    return counted(size);
}
void *operator new[](std::size_t size) {
    return counted(size);
}
void *operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
void *operator new(std::size_t size, const std::nothrow_t & /*tag*/) noexcept {
    try {
        return counted(size);
    } catch (const std::bad_alloc &) {
        return nullptr;
    }
}
void operator delete(void *memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete(void *memory, const std::nothrow_t & /*tag*/) noexcept {
    std::free(memory);
}
void operator delete(void *memory) noexcept {
    std::free(memory);
}
void operator delete[](void *memory) noexcept {
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void *memory, std::size_t) noexcept {
    std::free(memory);
}

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

World heap(const std::string &method, int bodies) {
    Random random(4);
    World world(method, settings_for(method));
    world.add_body(ground(0.6, 0));
    BodyId last;
    for (int i = 0; i < bodies; ++i) {
        const V at{0.7 * (i % 10), 0.4 + 0.8 * (i / 100), 0.7 * (i / 10 % 10)};
        const BodyId id = world.add_body(dynamic_body(any_shape(random), 1, at));
        if (i % 8 == 1) {
            JointDef joint;
            joint.a = last;
            joint.b = id;
            joint.anchor_a_local = narrow(V{0.35, 0, 0});
            joint.anchor_b_local = narrow(V{-0.35, 0, 0});
            world.add_joint(joint);
        }
        last = id;
    }
    return world;
}

class Saves : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Saves, testing::ValuesIn(all_methods()), name_of);

TEST_P(Saves, RestoringGivesTheSameBits) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    World world = heap(GetParam(), 60);
    run(world, 30);
    SavedWorld saved;
    world.save(saved);
    const std::uint64_t at_save = world.hash();
    run(world, 60);
    const std::uint64_t after = world.hash();
    for (int i = 0; i < 3; ++i) {
        world.restore(saved);
        ASSERT_EQ(world.hash(), at_save);
        run(world, 60);
        ASSERT_EQ(world.hash(), after);
    }
}

// A save outlives edits of the world that it was made of.
TEST_P(Saves, EditsDoNotReachWhatWasSaved) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    World world = heap(GetParam(), 20);
    run(world, 10);
    SavedWorld saved;
    world.save(saved);
    const std::uint64_t before = world.hash();
    run(world, 20);
    const std::uint64_t expected = world.hash();
    world.restore(saved);
    world.remove_body(world.body_id(5));
    world.remove_body(world.body_id(0)); // the ground
    world.add_body(dynamic_body(ball(0.5), 3, V{0, 9, 0}));
    run(world, 20);
    ASSERT_NE(world.hash(), expected);
    world.restore(saved);
    ASSERT_EQ(world.hash(), before);
    run(world, 20);
    ASSERT_EQ(world.hash(), expected);
}

// What has not changed since the save before is shared with it, and nothing else is.
TEST_P(Saves, ShareWhatRests) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    World world = heap(GetParam(), 20);
    run(world, 10);
    SavedWorld first;
    world.save(first);
    SavedWorld second;
    world.save(second, &first);
    EXPECT_GT(first.bytes_beside(nullptr), 0U);
    EXPECT_EQ(second.bytes_beside(&first), 0U);
    EXPECT_EQ(second.bytes_beside(nullptr), first.bytes_beside(nullptr));
    const std::uint64_t before = world.hash();
    run(world, 1);
    const std::uint64_t after = world.hash();
    ASSERT_NE(after, before);
    SavedWorld third;
    world.save(third, &second);
    EXPECT_GT(third.bytes_beside(&second), 0U);
    // A save into the memory of one whose columns another shares leaves that as it was.
    world.save(first);
    world.restore(second);
    EXPECT_EQ(world.hash(), before);
    for (const SavedWorld *saved : {&first, &third}) {
        world.restore(*saved);
        EXPECT_EQ(world.hash(), after);
    }
}

// Lets a world fall until nobody's substeps have changed for a second.
bool settles(World &world) {
    run(world, 240);
    int still = 0;
    for (int step = 0; still < 60 && step < 1200; ++step) {
        const std::vector<Pace> before = world.state().paces;
        run(world, 1);
        still =
            std::ranges::equal(world.state().paces, before, {}, &Pace::substeps, &Pace::substeps)
                ? still + 1
                : 0;
    }
    return still == 60;
}

TEST_P(Saves, ASettledStepAllocatesNothing) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    World world = heap(GetParam(), 100);
    StepSettings settings = world.settings();
    settings.sleep_after = 0;
    world.set_settings(settings);
    TaskPool tasks(3);
    ASSERT_TRUE(settles(world));
    for (int i = 0; i < 5; ++i)
        world.step(&tasks);
    SavedWorld saved;
    world.save(saved);
    const std::uint64_t before = allocations;
    for (int i = 0; i < 60; ++i)
        world.step(nullptr);
    EXPECT_EQ(allocations - before, 0U);
    world.restore(saved);
    for (int i = 0; i < 10; ++i)
        world.step(&tasks);
    const std::uint64_t with_threads = allocations;
    for (int i = 0; i < 60; ++i)
        world.step(&tasks);
    EXPECT_EQ(allocations - with_threads, 0U);
    world.save(saved);
    const std::uint64_t before_save = allocations;
    world.save(saved);
    EXPECT_EQ(allocations - before_save, 0U);
}

// Nor does one of particles, springs and what they touch.
TEST_P(Saves, AStepOfParticlesAllocatesNothing) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0.5, 0));
    world.add_body(dynamic_body(block(V{0.2}), 1, V{0.5, 0.2, 0.5}));
    for (int i = 0; i < 100; ++i) {
        ParticleDef def;
        def.position = narrow(V{0.1 * (i % 10), 0.5, 0.1 * (i / 10)});
        def.mass = Real(0.01);
        world.add_particle(def);
        const auto to = [&](int other) {
            SpringDef spring;
            spring.a = {SpringEnd::Kind::particle, std::uint32_t(i), Vec3{Real(0)}};
            spring.b = {SpringEnd::Kind::particle, std::uint32_t(other), Vec3{Real(0)}};
            spring.rest_length = Real(0.1);
            spring.stiffness = Real(20);
            spring.damping = Real(0.2);
            world.add_spring(spring);
        };
        if (i % 10 > 0)
            to(i - 1);
        if (i >= 10)
            to(i - 10);
    }
    run(world, 600);
    ASSERT_GT(world.report().particle_contacts, 50U);
    const std::uint64_t before = allocations;
    run(world, 60);
    EXPECT_EQ(allocations - before, 0U);
}

// Memory may run out anywhere in a step: the world is as it was, and the step, taken again, is the
// step that it would have been.
TEST_P(Saves, AStepThatFailsLeavesTheStateAsItWas) {
    if (!find_method(GetParam())->info.joints)
        GTEST_SKIP() << "no joints";
    // Balls that touch each other from the start.
    const auto pile = [] {
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(ground(0.6, 0));
        for (int i = 0; i < 60; ++i)
            world.add_body(dynamic_body(
                ball(0.3), 1, V{0.59 * (i % 4), 0.3 + 0.59 * (i / 16), 0.59 * (i / 4 % 4)}));
        return world;
    };
    World world = pile();
    const std::uint64_t before = world.hash();
    World whole = pile();
    run(whole, 1);
    const std::uint64_t after = whole.hash();
    run(whole, 4);
    int failures = 0;
    for (std::int64_t left = 0;; ++left) {
        bool failed = false;
        allocations_left = left;
        try {
            world.step(nullptr);
        } catch (const std::bad_alloc &) {
            failed = true;
        }
        allocations_left = std::numeric_limits<std::int64_t>::max();
        if (!failed)
            break;
        ++failures;
        ASSERT_EQ(world.hash(), before) << left;
        ASSERT_EQ(world.step_count(), 0U) << left;
    }
    EXPECT_GE(failures, 5);
    EXPECT_EQ(world.hash(), after);
    run(world, 4);
    EXPECT_EQ(world.hash(), whole.hash());
}

// What rests takes little to save: 300 bytes a body, contacts and all.
TEST(Saves, AreSmall) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.6, 0));
    for (int i = 0; i < 1000; ++i)
        world.add_body(dynamic_body(
            block(V{0.25}), 1, V{0.6 * (i % 20), 0.25 + 0.5 * (i / 400), 0.6 * (i / 20 % 20)}));
    run(world, 120);
    const State &state = world.state();
    const std::size_t bytes =
        state.motions.size() * sizeof(Motion) + state.contacts.size() * sizeof(ContactMemory) +
        state.points.size() * sizeof(PointMemory) + state.joints.size() * sizeof(JointMemory) +
        state.penalties.points.size() * sizeof(PointPenalty) +
        state.penalties.joints.size() * sizeof(JointPenalty);
    EXPECT_GE(state.contacts.size(), 1000U);
    EXPECT_LE(bytes, 1000U * (is_double ? 600U : 300U));
}

TEST(Contacts, AreFoundAgainAfterRestoring) {
    World world = heap("soft_step", 40);
    run(world, 60);
    SavedWorld saved;
    world.save(saved);
    const Measures before = world.measure();
    world.restore(saved);
    EXPECT_NEAR(world.measure().max_penetration, before.max_penetration, 1e-6);
    EXPECT_GE(world.contacts().size(), 20U);
    for (const Contact &contact : world.contacts())
        EXPECT_GT(contact.manifold.count, 0);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
