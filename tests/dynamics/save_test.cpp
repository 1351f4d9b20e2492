// Saving, restoring, and what a step must not do.
#include "engine/core/check.h"
#include "tests/dynamics/all_sorts.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>
#include <tuple>

namespace {

std::atomic<std::uint64_t> allocations{0};
// How many more allocations succeed before one fails.
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

// Counts this program's allocations, and fails them on demand.
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
        BodyDef def = dynamic_body(any_shape(random), 1, at);
        def.linear_damping = def.angular_damping = Real(0.5); // keeps balls from rolling on forever
        const BodyId id = world.add_body(def);
        if (i % 8 == 1 && find_method(method)->info.joints) {
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

// A save is unaffected by later edits of its world.
TEST_P(Saves, EditsDoNotReachWhatWasSaved) {
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

// Data unchanged since the previous save is shared with it, and nothing else is.
TEST_P(Saves, ShareWhatRests) {
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
    // Saving over a save that shares its columns with another leaves the other intact.
    world.save(first);
    world.restore(second);
    EXPECT_EQ(world.hash(), before);
    for (const SavedWorld *saved : {&first, &third}) {
        world.restore(*saved);
        EXPECT_EQ(world.hash(), after);
    }
}

// Lets a world fall until no body's substep count has changed for a second.
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

// A heap, boxes resting on a mesh and a height field, a sensor, a platform that turns by itself
// and, where the method supports them, joints and a net that holds a body.
World settling(const std::string &method) {
    const MethodInfo &info = find_method(method)->info;
    World world = heap(method, 60);
    const BodyId doomed = world.add_body(dynamic_body(ball(0.2), 1, V{0, 9, 20}));
    BodyDef sensor = static_body(block(V{1}), V{3, 1, 3});
    sensor.colliders.front().sensor = true;
    world.add_body(sensor);
    BodyDef platform = static_body(block(V{0.5, 0.1, 0.5}), V{0, 5, -20});
    platform.kind = BodyKind::kinematic;
    platform.angular_velocity = narrow(V{0, 1, 0});
    world.add_body(platform);
    world.add_body(hilly_ground(false, {20, 1, 0}));
    world.add_body(hilly_ground(true, {30, 1, 0}));
    for (int i = 0; i < 12; ++i)
        world.add_body(with_material(
            dynamic_body(block(V{0.2}), 1, V{i % 2 == 0 ? 20 : 30, 1.5, 0.6 * (i / 2) - 1.5}), 0.9,
            0));
    if (info.joints)
        for (int i = 0; i < 5; ++i) {
            BodyDef hung = dynamic_body(block(V{0.1}), 1, V{-6.0 - i, 4, 0});
            hung.linear_damping = hung.angular_damping = Real(5);
            JointDef joint;
            joint.type = static_cast<JointType>(i);
            joint.b = world.add_body(hung);
            joint.anchor_a_local = narrow(V{-6.0 - i, 4, 0});
            joint.max_length = Real(0.1);
            joint.limits = {Real(-0.1), Real(0.1)};
            world.add_joint(joint);
        }
    if (info.springs) {
        const BodyId hung = world.add_body(dynamic_body(block(V{0.2}), 0.5, V{-20, 3, 0}));
        const auto first = std::uint32_t(world.state().particles.size());
        add_net(world, {.n = 6,
                        .side = 2,
                        .middle = {-20, 4, 0},
                        .mass = 0.2,
                        .stiffness = 200,
                        .damping = 2});
        world.add_spring(spring(of_particle(first + 14), of_body(hung, {0, 0.2, 0}), 0.5, 100, 2));
        world.add_body(dynamic_body(ball(0.3), 0.2, V{-30, 4.5, 0}));
        add_net(world, {.n = 9,
                        .side = 2,
                        .middle = {-30, 4, 0},
                        .mass = 0.2,
                        .stiffness = 200,
                        .damping = 2});
    }
    world.remove_body(doomed);
    return world;
}

class SettledSteps : public testing::TestWithParam<std::tuple<std::string, bool>> {};
INSTANTIATE_TEST_SUITE_P(Methods, SettledSteps,
                         testing::Combine(testing::ValuesIn(all_methods()), testing::Bool()),
                         [](const auto &each) {
                             return std::get<0>(each.param) +
                                    (std::get<1>(each.param) ? "_asleep" : "");
                         });

TEST_P(SettledSteps, AllocateNothing) {
    const auto &[method, sleeps] = GetParam();
    World world = settling(method);
    StepSettings settings = world.settings();
    settings.sleep_after = sleeps ? 0.5 : 0;
    world.set_settings(settings);
    TaskPool one(1), two(2), three(3);
    ASSERT_TRUE(settles(world));
    run(world, 1200); // until leaning and rocking bodies and the nets settle
    SavedWorld saved;
    for (TaskPool *tasks : {static_cast<TaskPool *>(nullptr), &one, &two, &three}) {
        for (int i = 0; i < 10; ++i)
            world.step(tasks);
        const std::uint64_t before = allocations;
        for (int i = 0; i < 60; ++i)
            world.step(tasks);
        EXPECT_EQ(allocations - before, 0U) << (tasks ? tasks->threads() : 0);
        world.save(saved);
        const std::uint64_t before_save = allocations;
        world.save(saved);
        EXPECT_EQ(allocations - before_save, 0U);
    }
    const MethodInfo &info = world.method().info;
    if (info.contacts) {
        EXPECT_GT(world.contacts().size(), 60U);
    }
    if (info.contacts && info.springs && !sleeps) {
        EXPECT_GT(world.report().particle_contacts, 0U);
    }
}

// Nor does a step with particles, springs and the bodies they touch.
TEST_P(Saves, AStepOfParticlesAllocatesNothing) {
    const MethodInfo &method = find_method(GetParam())->info;
    if (!method.springs)
        GTEST_SKIP() << "no springs";
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
    if (method.contacts) {
        ASSERT_GT(world.report().particle_contacts, 50U);
    }
    const std::uint64_t before = allocations;
    run(world, 60);
    EXPECT_EQ(allocations - before, 0U);
}

// Runs out of memory at each allocation of a step in turn: the world stays as it was, and the step
// that finally succeeds is the one it would have been. Returns how often it failed.
int fail_at_each_allocation(const World &start, TaskPool *tasks) {
    World whole = start;
    whole.step(tasks);
    const std::uint64_t after = whole.hash();
    run(whole, 3);
    SavedWorld saved;
    start.save(saved);
    World world(start.method().info.name, start.settings());
    world.restore(saved); // the state alone: a step must allocate all its memory again
    const std::uint64_t before = world.hash();
    EXPECT_EQ(before, start.hash());
    int failures = 0;
    for (std::int64_t left = 0;; ++left) {
        bool failed = false;
        allocations_left = left;
        try {
            world.step(tasks);
        } catch (const std::bad_alloc &) {
            failed = true;
        }
        allocations_left = std::numeric_limits<std::int64_t>::max();
        if (!failed)
            break;
        ++failures;
        EXPECT_EQ(world.hash(), before) << left;
        EXPECT_EQ(world.step_count(), start.step_count()) << left;
        if (world.hash() != before)
            return failures;
    }
    EXPECT_EQ(world.hash(), after);
    run(world, 3);
    EXPECT_EQ(world.hash(), whole.hash());
    return failures;
}

class FailedSteps : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, FailedSteps, testing::ValuesIn(all_methods()), name_of);

TEST_P(FailedSteps, ForWantOfMemoryLeaveTheStateAsItWas) {
    TaskPool three(3, TaskPool::Parts::single);
    for (TaskPool *tasks : {static_cast<TaskPool *>(nullptr), &three}) {
        World world = world_of_all_sorts(GetParam(), 24);
        EXPECT_GE(fail_at_each_allocation(world, tasks), 5);
        run(world, 5); // fills the contact memory
        if (world.method().info.springs)
            world.grab_particle(7, narrow(V{0, 3, 0}), Real(20));
        EXPECT_GE(fail_at_each_allocation(world, tasks), 5);
    }
}

// A failed step that would have woken a sleeping body leaves it asleep.
TEST_P(FailedSteps, LetSleepWhatSlept) {
    World world(GetParam(), settings_for(GetParam()));
    StepSettings settings = world.settings();
    settings.sleep_after = 0.05;
    settings.substep_tolerance = 0.02;
    world.set_settings(settings);
    world.add_body(ground(0.6, 0));
    for (int i = 0; i < 4; ++i)
        world.add_body(dynamic_body(block(V{0.2}), 1, V{0.5 * i, 0.2, 0}));
    run(world, 60);
    const auto &groups = world.method().info.reads;
    const bool sleeps = std::ranges::find(groups, SettingGroup::sleep) != groups.end();
    ASSERT_EQ(std::ranges::count_if(world.state().paces, &Pace::is_asleep), sleeps ? 4 : 0);
    world.add_body(dynamic_body(ball(0.2), 1, V{0, 0.62, 0}, V{0, -3, 0}));
    fail_at_each_allocation(world, nullptr);
    run(world, 1);
    EXPECT_EQ(std::ranges::count_if(world.state().paces, &Pace::is_asleep), sleeps ? 3 : 0);
}

// More candidate pairs than a step accepts.
TEST_P(FailedSteps, ForTooManyPairsLeaveTheStateAsItWas) {
    if (!find_method(GetParam())->info.contacts)
        GTEST_SKIP() << "no contacts";
    BodyDef swarm = dynamic_body(ball(0.1), 1, V{0, 20, 0});
    swarm.colliders.resize(2500, swarm.colliders.front());
    TaskPool three(3);
    World world = world_of_all_sorts(GetParam(), 24), twin = world;
    BodyId last;
    for (World *each : {&world, &twin}) {
        run(*each, 5);
        each->add_body(swarm);
        last = each->add_body(swarm);
    }
    const std::uint64_t before = world.hash();
    EXPECT_EQ(before, twin.hash());
    EXPECT_THROW(world.step(&three), CheckFailure);
    EXPECT_EQ(world.hash(), before);
    EXPECT_EQ(world.step_count(), 5U);
    EXPECT_THROW((void)world.contacts(), CheckFailure);
    EXPECT_EQ(world.hash(), before);
    for (World *each : {&world, &twin}) {
        each->remove_body(last);
        each->step(&three);
        run(*each, 3);
    }
    EXPECT_EQ(world.hash(), twin.hash());
}

// A thousand bodies that come to rest: each takes at most 300 bytes, contacts included, and all
// states of a minute fit into 256 MB (float), since what has not changed is stored once.
TEST(Saves, AreSmall) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.6, 0));
    for (int i = 0; i < 1000; ++i)
        world.add_body(dynamic_body(
            block(V{0.25}), 1, V{0.6 * (i % 20), 0.25 + 0.5 * (i / 400), 0.6 * (i / 20 % 20)}));
    constexpr std::size_t of_double = is_double ? 2 : 1;
    SavedWorld last, now;
    std::size_t sum = 0;
    for (int i = 0; i < 3600; ++i) {
        run(world, 1);
        now = {};
        world.save(now, i == 0 ? nullptr : &last);
        sum += now.bytes_beside(i == 0 ? nullptr : &last);
        std::swap(now, last);
    }
    EXPECT_TRUE(all_sleep(world));
    EXPECT_GE(world.state().contacts.size(), 1000U);
    EXPECT_LE(last.bytes_beside(nullptr), world.bodies().size() * 300 * of_double);
    EXPECT_LE(sum, (std::size_t{256} << 20U) * of_double);
    RecordProperty("bytes", static_cast<int>(last.bytes_beside(nullptr)));
    RecordProperty("minute", static_cast<int>(sum));
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
