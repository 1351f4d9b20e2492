// What makes up a body: colliders, mass frame, locks, damping.
#include "engine/dynamics/bodies/mass_frame.h"
#include "engine/geometry/quickhull.h"
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

BodyDef compound(const std::vector<Shape> &shapes, double density) {
    BodyDef def;
    for (const Shape &shape : shapes) {
        ColliderDef &collider = def.colliders.emplace_back();
        collider.shape = shape;
        collider.density = Real(density);
    }
    return def;
}

Box block_at(const V &center, const V &half_extents) {
    return {narrow(center), identity_rotation, narrow(half_extents)};
}

Mat3 tensor_of(const MassFrame &mass) {
    const Mat3 r = glm::mat3_cast(mass.frame.rotation);
    Mat3 moments{Real(0)};
    for (int i = 0; i < 3; ++i)
        moments[i][i] = mass.inertia[i];
    return r * moments * glm::transpose(r);
}

// A box made of eight unequal pieces has the box's mass and inertia.
TEST(MassFrame, PiecesOfABoxAreTheBox) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const V half{random.next_in(0.1, 2), random.next_in(0.1, 2), random.next_in(0.1, 2)};
        const V center = any_vector(random, 2);
        const V cut{random.next_in(-0.9, 0.9), random.next_in(-0.9, 0.9),
                    random.next_in(-0.9, 0.9)};
        std::vector<Shape> pieces;
        for (int i = 0; i < 8; ++i) {
            V low, high;
            for (int k = 0; k < 3; ++k) {
                const bool upper = (i >> k & 1) != 0;
                low[k] = center[k] + half[k] * (upper ? cut[k] : -1);
                high[k] = center[k] + half[k] * (upper ? 1 : cut[k]);
            }
            pieces.emplace_back(block_at(0.5 * (low + high), 0.5 * (high - low)));
        }
        const MassFrame whole = mass_frame(compound({block_at(center, half)}, 700));
        const MassFrame sum = mass_frame(compound(pieces, 700));
        const double mass = 700 * 8 * half.x * half.y * half.z;
        EXPECT_NEAR(double(whole.mass) / mass, 1, 20 * epsilon);
        EXPECT_NEAR(double(sum.mass) / mass, 1, 40 * epsilon);
        EXPECT_LE(glm::distance(wide(whole.frame.position), center), 20 * epsilon);
        EXPECT_LE(glm::distance(wide(sum.frame.position), center), 40 * epsilon);
        const double size = mass * glm::dot(half, half);
        const Mat3 a = tensor_of(whole), b = tensor_of(sum);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double across = glm::dot(half, half) - half[i] * half[i];
                EXPECT_NEAR(double(a[i][j]), i == j ? mass / 3 * across : 0, 100 * epsilon * size);
                EXPECT_NEAR(double(b[i][j]), double(a[i][j]), 400 * epsilon * size);
            }
    }
}

TEST(MassFrame, OfAHullIsThatOfTheBoxItIs) {
    const V half{0.5, 0.25, 1};
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(narrow(
            V{(i & 1) ? half.x : -half.x, (i & 2) ? half.y : -half.y, (i & 4) ? half.z : -half.z}));
    const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
    BodyDef def = compound({ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation}}, 500);
    def.colliders.front().hull = mesh;
    const MassFrame mass = mass_frame(def);
    EXPECT_NEAR(double(mass.mass), 500, 500 * 20 * epsilon);
    const Mat3 tensor = tensor_of(mass);
    EXPECT_NEAR(double(tensor[0][0]), 500.0 / 3 * (half.y * half.y + half.z * half.z), 1e-3);
    EXPECT_NEAR(double(tensor[1][1]), 500.0 / 3 * (half.x * half.x + half.z * half.z), 1e-3);
    EXPECT_NEAR(double(tensor[2][2]), 500.0 / 3 * (half.x * half.x + half.y * half.y), 1e-3);
}

TEST(MassFrame, GivenMassCenterAndInertiaCount) {
    BodyDef def = compound({block(V{1, 1, 1})}, 1000);
    def.mass = Real(6);
    EXPECT_EQ(mass_frame(def).mass, Real(6));
    EXPECT_NEAR(double(mass_frame(def).inertia.x), 4, 1e-5); // 6 / 3 * (1 + 1)
    def.center_of_mass = narrow(V{0, -0.5, 0});
    EXPECT_EQ(mass_frame(def).frame.position, *def.center_of_mass);
    EXPECT_NEAR(double(mass_frame(def).inertia.x), 4 + 6 * 0.25, 1e-5);
    EXPECT_NEAR(double(mass_frame(def).inertia.y), 4, 1e-5);
    def.inertia = narrow(V{1, 2, 3});
    EXPECT_EQ(mass_frame(def).inertia, narrow(V{1, 2, 3}));
}

TEST(MassFrame, SensorsWeighNothing) {
    BodyDef def = compound({ball(0.5), ball(2)}, 1000);
    def.colliders[1].sensor = true;
    EXPECT_NEAR(double(mass_frame(def).mass), 1000 * 4.0 / 3 * pi / 8, 1e-3);
}

// A thrown hammer: its centre of mass flies the parabola, wherever the handle's frame goes.
TEST(Colliders, ACompoundFliesAboutItsCentreOfMass) {
    for (const std::string &method : all_methods()) {
        StepSettings settings = settings_for(method);
        settings.substeps = 8;
        World world(method, settings);
        BodyDef def = compound(
            {block_at(V{0, 0.5, 0}, V{0.05, 0.5, 0.05}), block_at(V{0, 1, 0}, V{0.3, 0.1, 0.1})},
            1000);
        def.pose.position = narrow(V{0, 3, 0});
        def.velocity = narrow(V{2, 5, 0});
        def.angular_velocity = narrow(V{1, 2, 6});
        const BodyId id = world.add_body(def);
        const Transform start = world.pose_of(id.index);
        EXPECT_LE(glm::distance(wide(start.position), V{0, 3, 0}), 10 * epsilon);
        const V center = position_of(world, id);
        EXPECT_GT(center.y, 3.5);
        run(world, 60);
        const double h = substep_of(world);
        const V expected = center + V{2, 5, 0} + 0.5 * V{0, -gravity, 0};
        EXPECT_LE(glm::distance(position_of(world, id), expected), 0.5 * gravity * h + 1e-4)
            << method;
        // The frame stays at a fixed distance from the centre of mass.
        const Transform now = world.pose_of(id.index);
        EXPECT_NEAR(glm::distance(wide(now.position), position_of(world, id)),
                    glm::distance(wide(start.position), center), 1e-5);
    }
}

TEST(Colliders, ContactsAreKnownByChild) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    BodyDef dumbbell = compound(
        {Sphere{narrow(V{-1, 0, 0}), Real(0.5)}, Sphere{narrow(V{1, 0, 0}), Real(0.5)}}, 1000);
    dumbbell.pose.position = narrow(V{0, 0.5, 0});
    const BodyId id = world.add_body(dumbbell);
    run(world, 120);
    ASSERT_EQ(world.contacts().size(), 2U);
    for (std::uint16_t child = 0; child < 2; ++child) {
        EXPECT_EQ(world.contacts()[child].key.b, id.index);
        EXPECT_EQ(world.contacts()[child].key.child_b, child);
        EXPECT_GT(world.contacts()[child].impulses[0].x, Real(0));
    }
    EXPECT_NEAR(position_of(world, id).y, 0.5, 1e-3);
}

TEST(Colliders, FiltersAndSensors) {
    for (const bool ignores : {false, true})
        for (const bool sensor : {false, true}) {
            World world("soft_step", settings_for("soft_step"));
            BodyDef floor = ground(0.5, 0);
            floor.colliders.front().filter.layer = 3;
            world.add_body(floor);
            BodyDef def = dynamic_body(ball(0.5), 1, V{0, 0.5, 0});
            def.colliders.front().sensor = sensor;
            def.colliders.front().filter.ignores = ignores ? 1U << 3 : 1U << 4;
            if (sensor) { // something must have mass
                def.colliders.push_back(def.colliders.front());
                def.colliders.back().sensor = false;
                def.colliders.back().filter.ignores = ~0U;
            }
            const BodyId id = world.add_body(def);
            world.step(nullptr);
            EXPECT_EQ(world.contacts().size(), ignores ? 0U : 1U);
            run(world, 30);
            const bool falls = ignores || sensor;
            EXPECT_EQ(position_of(world, id).y < 0, falls);
        }
}

// A body that ignores every layer in use moves bit for bit as if it were alone, until a body on a
// layer it does not ignore arrives.
TEST(Colliders, WhatIgnoresAllGoesAsByItself) {
    const auto ball_at = [](double x, double speed) {
        BodyDef def = dynamic_body(ball(0.5), 1, V{x, 2, 0}, V{speed, 0, 0});
        def.angular_velocity = narrow(V{1, 2, 3});
        def.colliders.front().filter = {.layer = 1, .ignores = 2};
        return def;
    };
    World alone("soft_step", settings_for("soft_step"));
    const BodyId lone = alone.add_body(ball_at(0, 1));
    World world("soft_step", settings_for("soft_step"));
    const BodyId one = world.add_body(ball_at(0, 1));
    world.add_body(ball_at(1.5, -1));
    for (int i = 0; i < 60; ++i) {
        alone.step(nullptr);
        world.step(nullptr);
        EXPECT_TRUE(world.contacts().empty());
        ASSERT_EQ(position_of(world, one), position_of(alone, lone)) << i;
        ASSERT_EQ(spin_of(world, one), spin_of(alone, lone)) << i;
    }

    World floored = world;
    const BodyId floor = floored.add_body(ground(0.5, 0)); // on layer 0
    run(floored, 240);
    EXPECT_NEAR(position_of(floored, one).y, 0.5, 1e-2);
    floored.remove_body(floor);
    run(floored, 60);
    EXPECT_LT(position_of(floored, one).y, -1);
    EXPECT_TRUE(floored.contacts().empty());
}

// v' = g - c v has the solution v = g / c + (v0 - g / c) e^(-c t).
TEST(Damping, FollowsTheExponential) {
    for (const std::string &method : all_methods()) {
        StepSettings settings = settings_for(method);
        settings.substeps = 16;
        World world(method, settings);
        BodyDef def = dynamic_body(ball(0.5), 2, V{0}, V{3, 10, -1});
        def.linear_damping = Real(1.5);
        def.angular_damping = Real(0.5);
        def.angular_velocity = narrow(V{4, 0, 2});
        const BodyId id = world.add_body(def);
        run(world, 60);
        const V g{0, -gravity, 0};
        const V terminal = g / 1.5;
        const double e = std::exp(-1.5);
        const V v = terminal + (V{3, 10, -1} - terminal) * e;
        const V x = terminal + (V{3, 10, -1} - terminal) * (1 - e) / 1.5;
        // Exact but for rounding in soft_step; first order, c h / 2, in the others.
        const double h = substep_of(world);
        const bool exact = method == "soft_step" || method == "rk4";
        const double tolerance = exact ? 3000 * epsilon : 20 * 1.5 * h;
        EXPECT_LE(glm::distance(velocity_of(world, id), v), tolerance) << method;
        EXPECT_LE(glm::distance(position_of(world, id), x), tolerance) << method;
        EXPECT_LE(glm::distance(spin_of(world, id), V{4, 0, 2} * std::exp(-0.5)), tolerance)
            << method;
    }
}

TEST(GravityScale, ScalesTheFall) {
    World world("soft_step", settings_for("soft_step"));
    std::vector<BodyId> ids;
    const std::array scales{0.0, 1.0, -0.5};
    for (const double scale : scales) {
        BodyDef def = dynamic_body(ball(0.1), 1, V{3 * scale, 0, 0});
        def.gravity_scale = Real(scale);
        ids.push_back(world.add_body(def));
    }
    run(world, 60);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(position_of(world, ids[i]).y, -0.5 * gravity * scales[i], 1e-4);
}

// Whatever pushes it, a locked axis does not move by a bit.
TEST(Locks, HoldToTheBit) {
    for (const std::string &method : contact_methods())
        for (int axis = 0; axis < 6; ++axis) {
            World world(method, settings_for(method));
            world.add_body(ground(0.5, 0.3));
            BodyDef def = dynamic_body(block(V{0.2, 0.3, 0.4}), 2, V{0.25, 1, -0.5}, V{1, -2, 3});
            def.angular_velocity = narrow(V{2, 1, 3});
            def.locked[std::size_t(axis)] = true;
            const BodyId id = world.add_body(def);
            const BodyId other =
                world.add_body(dynamic_body(ball(0.3), 1, V{0.3, 2, -0.5}, V{0, -4, 0}));
            const V start = position_of(world, id);
            for (int i = 0; i < 120; ++i) {
                world.step(nullptr);
                if (axis < 3)
                    ASSERT_EQ(position_of(world, id)[axis], start[axis]) << method;
                else
                    ASSERT_EQ(spin_of(world, id)[axis - 3], 0) << method;
            }
            EXPECT_TRUE(world.report().finite);
            EXPECT_LT(glm::length(velocity_of(world, other)), 20);
        }
}

// A box that can only slide down is stopped by the floor like any other.
TEST(Locks, ALockedBoxStillRestsOnTheFloor) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    BodyDef def = dynamic_body(block(V{0.5}), 2, V{0, 1, 0});
    def.locked = {true, false, true, true, true, true};
    const BodyId id = world.add_body(def);
    run(world, 120);
    EXPECT_NEAR(position_of(world, id).y, 0.5, 1e-3);
    EXPECT_NEAR(velocity_of(world, id).y, 0, 1e-4);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
