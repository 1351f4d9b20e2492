// The same state has the same future, bit for bit.
#include "tests/dynamics/worlds.h"

#include <cstring>
#include <functional>
#include <set>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Determinism : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Determinism, testing::ValuesIn(all_methods()), name_of);

// Some forty bodies of all shapes in a heap, a chain, a lift. With `holes`, some bodies and joints
// are added far away and removed again without ever touching anything.
World random_world(const std::string &method, std::uint64_t seed, bool holes = false) {
    Random random(seed);
    World world(method, settings_for(method));
    std::vector<BodyId> doomed;
    const auto add_doomed = [&] {
        if (holes)
            doomed.push_back(world.add_body(dynamic_body(ball(0.5), 1, V{500, 500, 500})));
    };
    world.add_body(ground(0.6, 0));
    add_doomed();
    BodyDef lift = static_body(block(V{0.5, 0.1, 0.5}), V{1.5, 0.3, 0});
    lift.kind = BodyKind::kinematic;
    lift.velocity = narrow(V{0, 0.25, 0});
    lift.angular_velocity = narrow(V{0, 0.5, 0});
    world.add_body(lift);
    for (int i = 0; i < 40; ++i) {
        BodyDef def =
            dynamic_body(any_shape(random), random.next_in(0.5, 5),
                         V{random.next_in(-1, 1), random.next_in(0.3, 4), random.next_in(-1, 1)},
                         any_vector(random, 1));
        def.pose.rotation = glm::normalize(narrow(any_rotation(random)));
        def.angular_velocity = narrow(any_vector(random, 3));
        world.add_body(with_material(def, random.next_unit(), random.next_unit()));
        if (i % 7 == 0)
            add_doomed();
    }
    JointDef joint;
    for (int i = 0; i < 5; ++i) {
        const BodyId link = world.add_body(dynamic_body(ball(0.1), 1, V{3.25 + 0.25 * i, 3, 0}));
        joint.type = i % 2 == 0 ? JointType::ball : JointType::distance;
        joint.b = link;
        joint.anchor_a_local =
            joint.a == BodyId{} ? narrow(V{3, 3, 0}) : narrow(V{i % 2 == 0 ? 0.25 : 0.0, 0, 0});
        if (i == 0)
            joint.anchor_b_local = narrow(V{-0.25, 0, 0});
        else
            joint.anchor_b_local = Vec3{Real(0)};
        set_length(joint, Real(0.25));
        world.add_joint(joint);
        joint.a = link;
    }
    for (const BodyId id : doomed)
        world.remove_body(id);
    return world;
}

bool same_bits(const Motion &a, const Motion &b) {
    // Motion consists only of Reals, without padding.
    static_assert(sizeof(Motion) % sizeof(Real) == 0);
    return std::memcmp(static_cast<const void *>(&a), static_cast<const void *>(&b),
                       sizeof(Motion)) == 0;
}

// The motions of the live bodies, in order.
std::vector<Motion> living(const World &world) {
    std::vector<Motion> motions;
    for (std::size_t i = 0; i < world.bodies().size(); ++i)
        if (world.bodies()[i].alive)
            motions.push_back(world.motions()[i]);
    return motions;
}

void expect_same(const World &a, const World &b, int step) {
    const std::vector<Motion> of_a = living(a), of_b = living(b);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i)
        ASSERT_TRUE(same_bits(of_a[i], of_b[i])) << "body " << i << ", step " << step;
    ASSERT_EQ(a.hash(), b.hash()) << "step " << step;
}

// A new world from another's readable state: poses, velocities, accumulated impulses, settings.
World loaded(const World &from) {
    World world(from.method().info.name, from.settings());
    std::vector<BodyId> ids(from.bodies().size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Body &body = from.bodies()[i];
        if (!body.alive)
            continue;
        const Motion &motion = from.motions()[i];
        BodyDef def;
        def.kind = body.kind;
        const Collider &collider = from.model().colliders[body.first_collider];
        ColliderDef &only = def.colliders.emplace_back();
        only.shape = collider.shape;
        only.material = collider.material;
        if (body.kind == BodyKind::dynamic)
            def.mass = body.mass;
        def.pose = {motion.position, motion.rotation};
        def.velocity = motion.velocity;
        def.angular_velocity = motion.angular_velocity;
        ids[i] = world.add_body(def);
    }
    for (const Joint &joint : from.joints()) {
        if (!joint.alive)
            continue;
        const auto end = [&](std::uint32_t body) {
            return body == Joint::world ? BodyId{} : ids[body];
        };
        JointDef def;
        def.type = joint.type;
        def.a = end(joint.a);
        def.b = end(joint.b);
        def.anchor_a_local = joint.anchor_a_local;
        def.anchor_b_local = joint.anchor_b_local;
        def.min_length = joint.min_length;
        def.max_length = joint.max_length;
        def.collide_connected = joint.collide_connected;
        const auto index = std::size_t(&joint - from.joints().data());
        def.memory = from.state().joints[index];
        if (!from.state().penalties.joints.empty())
            def.penalty = from.state().penalties.joints[index];
        world.add_joint(def);
    }
    for (const ContactMemory &memory : from.state().contacts) {
        ContactKey key = memory.key;
        key.a = ids[key.a].index;
        key.b = ids[key.b].index;
        const std::span penalties(from.state().penalties.points);
        world.remember_contact(
            key, memory.origin,
            std::span(from.state().points).subspan(memory.first_point, memory.point_count),
            penalties.empty() ? penalties
                              : penalties.subspan(memory.first_point, memory.point_count));
    }
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (from.bodies()[i].alive)
            world.set_pace(ids[i], from.state().paces[i]);
    world.set_clock(from.state().clock);
    return world;
}

TEST_P(Determinism, ACopyContinuesAsTheOriginal) {
    for (const int at : {0, 1, 7, 40, 100}) {
        World world = random_world(GetParam(), 1);
        run(world, at);
        World copy = world;
        expect_same(world, copy, at);
        for (int i = 0; i < 60; ++i) {
            world.step(nullptr);
            copy.step(nullptr);
            expect_same(world, copy, at + i);
        }
    }
}

TEST_P(Determinism, AnyNumberOfThreadsGivesTheSameBits) {
    World alone = random_world(GetParam(), 2);
    std::vector<World> worlds(5, alone);
    TaskPool one(1), two(2), three(3), eight(8), many(8, TaskPool::Parts::single);
    const std::array<TaskPool *, 5> pools{&one, &two, &three, &eight, &many};
    for (int i = 0; i < 90; ++i) {
        alone.step(nullptr);
        for (std::size_t k = 0; k < worlds.size(); ++k) {
            worlds[k].step(pools[k]);
            expect_same(alone, worlds[k], i);
        }
    }
}

// The future depends on the state, not on how it came about: the broad phase's tree and the order
// in which slots were used do not matter.
TEST_P(Determinism, AWorldLoadedFromItsStateContinuesTheSame) {
    for (const bool holes : {false, true})
        for (const int at : {0, 1, 30, 77, 150}) {
            World world = random_world(GetParam(), 3, holes);
            run(world, at);
            World again = loaded(world);
            expect_same(world, again, at);
            for (int i = 0; i < 60; ++i) {
                world.step(nullptr);
                again.step(nullptr);
                expect_same(world, again, at + i);
            }
        }
}

// Nor is anything cached that depends on a setting: here, how far static bodies reach.
TEST_P(Determinism, ASettingChangedOnTheWayCountsFromThen) {
    World world = random_world(GetParam(), 6);
    world.add_body(static_body(block(V{3, 0.1, 3}), V{0, -0.05, 0}));
    run(world, 20);
    SavedWorld before;
    world.save(before);
    const std::uint64_t hash_before = world.hash();
    for (const double distance : {0.2, 0.0, 0.05}) {
        StepSettings settings = world.settings();
        settings.speculative_distance = distance;
        world.set_settings(settings);
        World again = loaded(world);
        for (int i = 0; i < 20; ++i) {
            world.step(nullptr);
            again.step(nullptr);
            expect_same(world, again, i);
        }
    }
    world.restore(before);
    ASSERT_EQ(world.hash(), hash_before);
    World again = loaded(world);
    run(world, 20);
    run(again, 20);
    expect_same(world, again, 20);
}

TEST_P(Determinism, HolesDoNotCount) {
    World with = random_world(GetParam(), 4, true);
    World without = random_world(GetParam(), 4, false);
    ASSERT_GT(with.bodies().size(), without.bodies().size());
    for (int i = 0; i < 60; ++i) {
        expect_same(with, without, i);
        with.step(nullptr);
        without.step(nullptr);
    }
}

TEST(Hash, ChangesWithEveryPartOfTheState) {
    World world = random_world("soft_step", 5);
    run(world, 120); // so that contacts carry load
    const World before = world;
    ASSERT_EQ(before.hash(), World(before).hash());
    const auto next = [](Real &value) {
        value = std::nextafter(value, std::numeric_limits<Real>::infinity());
    };
    int parts = 0;
    for (std::uint32_t i = 0; i < world.bodies().size(); ++i) {
        const Motion &m = before.motions()[i];
        const bool has_velocity = world.bodies()[i].kind != BodyKind::static_body;
        for (int part = 0; part < 13; ++part) {
            if (!has_velocity && part >= 3 && part < 9)
                continue;
            Transform pose{m.position, m.rotation};
            Vec3 velocity = m.velocity, spin = m.angular_velocity;
            const int axis = part % 3;
            if (part < 3)
                next(pose.position[axis]);
            else if (part < 6)
                next(velocity[axis]);
            else if (part < 9)
                next(spin[axis]);
            else
                next(pose.rotation[part - 9]);
            World changed = before;
            changed.set_motion(changed.body_id(i), pose, velocity, spin);
            EXPECT_NE(changed.hash(), before.hash()) << "body " << i << " part " << part;
            ++parts;
        }
    }
    EXPECT_GT(parts, 500);
    // Cached contact state.
    int loaded_points = 0;
    for (const ContactMemory &memory : before.state().contacts) {
        const auto first = before.state().points.begin() + memory.first_point;
        const std::vector<PointMemory> points(first, first + memory.point_count);
        const auto expect_other = [&](const ContactOrigin &origin,
                                      const std::vector<PointMemory> &remembered) {
            World changed = before;
            changed.remember_contact(memory.key, origin, remembered);
            EXPECT_NE(changed.hash(), before.hash());
        };
        for (std::size_t k = 0; k < points.size(); ++k) {
            loaded_points += points[k].impulse.x > 0 ? 1 : 0;
            for (int axis = 0; axis < 3; ++axis)
                for (Vec3 PointMemory::*member :
                     {&PointMemory::impulse, &PointMemory::core_a, &PointMemory::core_b}) {
                    std::vector<PointMemory> other = points;
                    next((other[k].*member)[axis]);
                    expect_other(memory.origin, other);
                }
        }
        for (int axis = 0; axis < 3; ++axis) {
            ContactOrigin other = memory.origin;
            next(other.normal[axis]);
            expect_other(other, points);
            other = memory.origin;
            next(other.offset[axis]);
            expect_other(other, points);
        }
        for (int axis = 0; axis < 4; ++axis) {
            ContactOrigin other = memory.origin;
            next(other.rotation_a[axis]);
            expect_other(other, points);
            other = memory.origin;
            next(other.rotation_b[axis]);
            expect_other(other, points);
        }
    }
    EXPECT_GT(loaded_points, 30);
    World changed = before;
    changed.set_clock({before.step_count() + 1, 0, 0});
    EXPECT_NE(changed.hash(), before.hash());
    changed = before;
    changed.set_method("sequential_impulses");
    EXPECT_NE(changed.hash(), before.hash());
}

// State that only augmented Lagrangian methods keep, and that is dropped when another method steps.
TEST(Hash, ChangesWithEveryPenalty) {
    World world = random_world("avbd", 5);
    run(world, 120);
    const World before = world;
    const Penalties &penalties = before.state().penalties;
    ASSERT_EQ(penalties.points.size(), before.state().points.size());
    int known = 0;
    for (const ContactMemory &memory : before.state().contacts) {
        const auto points =
            std::span(before.state().points).subspan(memory.first_point, memory.point_count);
        const auto own = std::span(penalties.points).subspan(memory.first_point, points.size());
        for (std::size_t k = 0; k < own.size(); ++k) {
            known += own[k].normal > 0 && own[k].tangential > 0 ? 1 : 0;
            for (int part = 0; part < 4; ++part) {
                std::vector<PointPenalty> other(own.begin(), own.end());
                Real &value = part == 0   ? other[k].normal
                              : part == 1 ? other[k].tangential
                                          : other[k].slip[part - 2];
                value = std::nextafter(value, std::numeric_limits<Real>::infinity());
                World changed = before;
                changed.remember_contact(memory.key, memory.origin, points, other);
                EXPECT_NE(changed.hash(), before.hash());
            }
        }
    }
    EXPECT_GT(known, 30);
    ASSERT_EQ(penalties.joints.size(), before.joints().size());
    for (const JointPenalty &penalty : penalties.joints)
        EXPECT_GT(penalty[0], 0);
    world.set_method("soft_step");
    world.step(nullptr);
    EXPECT_TRUE(world.state().penalties.points.empty());
    EXPECT_TRUE(world.state().penalties.joints.empty());
}

TEST(Hash, ChangesWithEverySetting) {
    const World before("soft_step", StepSettings{});
    const auto hash_with = [&](const StepSettings &settings) {
        World changed = before;
        changed.set_settings(settings);
        return changed.hash();
    };
    EXPECT_EQ(hash_with({}), before.hash());
    std::set<std::uint64_t> hashes{before.hash()};
    for (const SettingNumber number : setting_numbers()) {
        StepSettings settings;
        const double value = setting_value(settings, number);
        const double other = value < number.setting().max ? value + 1 : value - 1;
        set_setting(settings, number,
                    is_whole(number.setting()) ? other : std::nextafter(value, 1e300));
        EXPECT_TRUE(hashes.insert(hash_with(settings)).second) << setting_name(number);
    }
}

// The definitions of bodies and joints decide the future as well.
TEST(Hash, ChangesWithBodiesAndJoints) {
    BodyDef body = dynamic_body(block(V{0.1, 0.2, 0.3}), 2, V{0});
    JointDef joint;
    joint.type = JointType::distance;
    set_length(joint, Real(1));
    const auto hash_of = [](const BodyDef &b, JointDef j) {
        World world("soft_step", StepSettings{});
        j.a = world.add_body(b);
        j.b = world.add_body(dynamic_body(ball(0.1), 1, V{1, 0, 0}));
        world.add_joint(j);
        return world.hash();
    };
    const std::uint64_t before = hash_of(body, joint);
    EXPECT_EQ(hash_of(body, joint), before);
    const auto next = [](Real value) { return std::nextafter(value, Real(1e30)); };
    const auto body_differs = [&](const std::function<void(BodyDef &)> &change) {
        BodyDef changed = body;
        change(changed);
        return hash_of(changed, joint) != before;
    };
    EXPECT_TRUE(body_differs([&](BodyDef &b) { b.mass = next(*b.mass); }));
    EXPECT_TRUE(body_differs([&](BodyDef &b) {
        Real &friction = b.colliders.front().material.friction;
        friction = next(friction);
    }));
    EXPECT_TRUE(
        body_differs([&](BodyDef &b) { b.colliders.front().material.restitution = Real(0.5); }));
    EXPECT_TRUE(body_differs([&](BodyDef &b) { b.kind = BodyKind::kinematic; }));
    EXPECT_TRUE(body_differs([&](BodyDef &b) { b.colliders.front().shape = ball(0.2); }));
    EXPECT_TRUE(body_differs([&](BodyDef &b) {
        Real &half = std::get<Box>(b.colliders.front().shape).half_extents.y;
        half = next(half);
    }));
    const auto joint_differs = [&](const std::function<void(JointDef &)> &change) {
        JointDef changed = joint;
        change(changed);
        return hash_of(body, changed) != before;
    };
    EXPECT_TRUE(joint_differs([&](JointDef &j) { j.type = JointType::ball; }));
    EXPECT_TRUE(joint_differs([&](JointDef &j) { set_length(j, next(j.max_length)); }));
    EXPECT_TRUE(joint_differs([&](JointDef &j) { j.collide_connected = true; }));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_TRUE(joint_differs([&](JointDef &j) { j.anchor_a_local[axis] = Real(1e-30); }));
        EXPECT_TRUE(joint_differs([&](JointDef &j) { j.anchor_b_local[axis] = Real(1e-30); }));
        EXPECT_TRUE(joint_differs(
            [&](JointDef &j) { j.memory.impulses[std::size_t(axis)] = Real(1e-30); }));
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
