// Constant forces and torques on bodies.
#include "engine/core/check.h"
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

BodyDef pushed(BodyDef def, const V &force, const V &torque = V{0}) {
    def.force = narrow(force);
    def.torque = narrow(torque);
    return def;
}

// v = F t / m, x = F t^2 / 2 m; and a ball turns about its torque by T t^2 / 2 I.
TEST(ConstantForce, AcceleratesEvenly) {
    const V force{3, 1, -2}, torque{0.4, 0.2, -0.1};
    const double mass = 2, inertia = 0.4 * mass * 0.5 * 0.5;
    for (const std::string &method : all_methods()) {
        StepSettings settings = weightless(settings_for(method));
        settings.substeps = 16;
        World world(method, settings);
        const BodyId id =
            world.add_body(pushed(dynamic_body(ball(0.5), mass, V{0}), force, torque));
        run(world, 60);
        const bool is_even = method == "soft_step" || method == "rk4" ||
                             method == "stormer_verlet" || method == "velocity_verlet" ||
                             method == "split_spin" || method == "naive_spin";
        // Half a substep early or late.
        const auto tolerance = [&](const V &acceleration) {
            return 3000 * epsilon +
                   (is_even ? 0 : 0.51 * substep_of(world) * glm::length(acceleration));
        };
        EXPECT_LE(glm::distance(velocity_of(world, id), force / mass), 3000 * epsilon) << method;
        EXPECT_LE(glm::distance(position_of(world, id), 0.5 * force / mass),
                  tolerance(force / mass))
            << method;
        const double cubed = std::pow(glm::length(torque / inertia), 3) / 4; // of a t over 1 s
        const double lost = method == "xpbd" ? 1.01 * spin_lost_by_xpbd(world, cubed) : 0;
        EXPECT_LE(glm::distance(spin_of(world, id), torque / inertia), 3000 * epsilon + lost)
            << method;
        const V turn = wide(rotation_vector(motion_of(world, id).rotation));
        EXPECT_LE(glm::distance(turn, 0.5 * torque / inertia), tolerance(torque / inertia) + lost)
            << method;
    }
}

TEST(ConstantForce, HasAPotential) {
    World world("soft_step", weightless(settings_for("soft_step")));
    world.add_body(pushed(dynamic_body(ball(0.5), 2, V{1, 2, 3}), V{3, 1, -2}));
    const double before = world.energy();
    EXPECT_NEAR(before, -(3 + 2 - 6), 100 * epsilon);
    run(world, 60);
    EXPECT_GT(world.measure().kinetic_energy, 3);
    EXPECT_NEAR(world.energy(), before, 1000 * epsilon);
}

// The angular momentum grows by T t, however the body tumbles.
TEST(ConstantTorque, IsTheRateOfAngularMomentum) {
    const V torque{0.5, 1, -0.3};
    for (const char *method : {"soft_step", "split_spin", "rk4"}) {
        StepSettings settings = weightless(settings_for(method));
        settings.substeps = 8;
        World world(method, settings);
        BodyDef def = pushed(dynamic_body(block(V{0.2, 0.3, 0.5}), 3, V{0}), V{0}, torque);
        def.angular_velocity = narrow(V{1, 2, 3});
        world.add_body(def);
        const V before = world.measure().angular_momentum;
        run(world, 60);
        EXPECT_LE(glm::distance(world.measure().angular_momentum, before + torque),
                  std::max(1e-8, 1000 * epsilon))
            << method;
    }
}

// A force of m g moves bodies to the bit as gravity does: falls, bounces, loads and rest.
TEST(ConstantForce, IsFeltAsGravityIs) {
    const V down{0, -gravity, 0};
    for (const std::string &method : contact_methods()) {
        const auto dropped = [&](const StepSettings &settings, const V &force) {
            World world(method, settings);
            world.add_body(ground(0.5, 0));
            BodyDef box = dynamic_body(block(V{0.3, 0.4, 0.5}), 2, V{0, 0.6, 0}, V{1, 0, 0});
            world.add_body(pushed(with_material(box, 0.5, 0.3), 2.0 * force));
            BodyDef bouncing = dynamic_body(ball(0.2), 1, V{3, 1, 0});
            world.add_body(pushed(with_material(bouncing, 0.5, 0.8), force));
            run(world, 150);
            return world;
        };
        const World falling = dropped(settings_for(method), V{0});
        const World driven = dropped(weightless(settings_for(method)), down);
        for (std::size_t i = 1; i < 3; ++i) {
            EXPECT_EQ(driven.motions()[i].position, falling.motions()[i].position) << method;
            EXPECT_EQ(driven.motions()[i].rotation, falling.motions()[i].rotation) << method;
            EXPECT_EQ(driven.state().paces[i].is_asleep(), falling.state().paces[i].is_asleep());
        }
    }
}

// Friction of 9.81 N holds what is pulled by 6 N, which sleeps; 15 N move it.
TEST(ConstantForce, KeepsAwakeWhatItMoves) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    const auto pulled = [&](double z, double force) {
        return world.add_body(pushed(
            with_material(dynamic_body(block(V{0.5}), 2, V{0, 0.5, z}), 0.5, 0), V{force, 0, 0}));
    };
    const BodyId held = pulled(0, 6), moved = pulled(5, 15);
    run(world, 120);
    EXPECT_TRUE(world.state().paces[held.index].is_asleep());
    EXPECT_LT(position_of(world, held).x, 1e-3);
    EXPECT_NEAR(velocity_of(world, moved).x, 2 * (15 - 0.5 * 2 * gravity) / 2, 5e-3);
}

TEST(ConstantForce, DoesNotMoveLockedAxes) {
    for (const std::string &method : all_methods()) {
        World world(method, weightless(settings_for(method)));
        BodyDef def =
            pushed(dynamic_body(block(V{0.2, 0.3, 0.4}), 2, V{0}), V{1, 2, 3}, V{3, 2, 1});
        def.locked = {true, false, false, false, true, true};
        const BodyId id = world.add_body(def);
        run(world, 10);
        EXPECT_EQ(motion_of(world, id).position.x, 0) << method;
        EXPECT_GT(position_of(world, id).y, 0) << method;
        EXPECT_EQ(motion_of(world, id).angular_velocity.y, 0) << method;
        EXPECT_GT(spin_of(world, id).x, 0) << method;
    }
}

TEST(ConstantForce, IsOfDynamicBodiesAndFinite) {
    World world("soft_step", settings_for("soft_step"));
    EXPECT_THROW((void)world.add_body(pushed(static_body(ball(1)), V{1, 0, 0})), CheckFailure);
    EXPECT_THROW((void)world.add_body(pushed(dynamic_body(ball(1), 1, V{0}), V{0},
                                             V{std::numeric_limits<double>::infinity(), 0, 0})),
                 CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
