// Resting, sliding, rolling, and tunnelling.
#include "tests/dynamics/rest_methods.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Contacts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Contacts, testing::ValuesIn(rest_methods()), name_of);

// Normal force (N) of the contact between two bodies.
double force_between(const World &world, BodyId a, BodyId b) {
    double sum = 0;
    for (const Contact &contact : world.contacts())
        if (contact.key.a == std::min(a.index, b.index) &&
            contact.key.b == std::max(a.index, b.index))
            for (std::size_t k = 0; k < std::size_t(contact.manifold.count); ++k)
                sum += double(contact.impulses[k].x);
    return sum * world.substeps_of(std::max(a.index, b.index)) / world.settings().dt;
}

World stack(const std::string &method, const StepSettings &settings, int n) {
    World world(method, settings);
    world.add_body(ground(0.5, 0));
    for (int i = 0; i < n; ++i)
        world.add_body(dynamic_body(block(V{0.25}), 2, V{0, 0.25 + 0.5 * i, 0}));
    run(world, 600);
    return world;
}

void expect_weights(const World &world, int n) {
    for (int i = 0; i < n; ++i) {
        const auto below = static_cast<std::uint32_t>(i);
        const double weight = (n - i) * 2 * gravity;
        EXPECT_NEAR(force_between(world, world.body_id(below), world.body_id(below + 1)), weight,
                    0.01 * weight)
            << "contact " << i << " of " << n;
    }
}

// Each contact in a stack carries what lies above it.
TEST_P(Contacts, CarryTheWeightOfAStack) {
    for (const int n : {1, 2, 3})
        expect_weights(stack(GetParam(), settings_for(GetParam()), n), n);
}

TEST(SoftStep, CarriesTheWeightOfATallStack) {
    for (const int n : {5, 10})
        expect_weights(stack("soft_step", settings_for("soft_step"), n), n);
}

// The push that separates overlapping boxes is not warm started as a load: five boxes come to rest
// at the usual ten iterations, and further iterations or shorter steps do not wake them. Ten boxes
// fall: they need more.
TEST(SequentialImpulses, FiveCubesRest) {
    const auto expect_rest = [](const StepSettings &settings) {
        World world("sequential_impulses", settings);
        world.add_body(ground(0.5, 0));
        for (int i = 0; i < 5; ++i)
            world.add_body(dynamic_body(block(V{0.5}), 1000, V{0, 0.5 + i, 0}));
        const double before = world.measure().potential_energy;
        run(world, static_cast<int>(std::lround(30 / settings.dt)));
        const Measures m = world.measure();
        EXPECT_LT(m.kinetic_energy, 1e-6 * before)
            << settings.iterations << " iterations, dt " << settings.dt << " s";
        EXPECT_NEAR(m.potential_energy, before, 1e-3 * before);
        EXPECT_LT(m.max_penetration, 1e-3);
    };
    StepSettings settings = settings_for("sequential_impulses");
    for (const int iterations : {10, 20, 50}) {
        settings.iterations = iterations;
        expect_rest(settings);
    }
    settings.iterations = 10;
    for (const double dt : {1.0 / 120, 1.0 / 240}) {
        settings.dt = dt;
        expect_rest(settings);
    }
}

// If the push goes through the velocities, it is warm started like a load, and the boxes rock.
TEST(SequentialImpulses, SixCubesRockWithBaumgartesBiasInTheirVelocities) {
    const auto kinetic_energy_after_30_s = [](int split_impulse) {
        StepSettings settings = settings_for("sequential_impulses");
        settings.split_impulse = split_impulse;
        World world("sequential_impulses", settings);
        world.add_body(ground(0.5, 0));
        for (int i = 0; i < 6; ++i)
            world.add_body(dynamic_body(block(V{0.5}), 1000, V{0, 0.5 + i, 0}));
        run(world, 1800);
        return world.measure().kinetic_energy;
    };
    EXPECT_LT(kinetic_energy_after_30_s(1), 1e-3);
    EXPECT_GT(kinetic_energy_after_30_s(0), 1);
}

// Always visiting a contact's points from first to last would feed the sway: eight cubes fell after
// 30 s. More than ten cubes still need more than the usual ten passes.
TEST(SequentialImpulses, WithOurAdditionsTenCubesComeToRestAndThirteenFall) {
    const auto stack = [](int count, int iterations) {
        StepSettings settings = settings_for("sequential_impulses");
        settings.iterations = iterations;
        World world("sequential_impulses", settings);
        world.add_body(ground(0.5, 0));
        for (int i = 0; i < count; ++i)
            world.add_body(dynamic_body(block(V{0.5}), 1000, V{0, 0.5 + i, 0}));
        run(world, 60 * 60);
        return world;
    };
    const auto sunk = [](const World &world) {
        return static_cast<double>(world.bodies().size()) - 1.5 -
               static_cast<double>(world.motions().back().position.y);
    };
    for (const auto &[count, iterations] : {std::pair{8, 10}, {9, 10}, {10, 10}, {13, 20}}) {
        const World world = stack(count, iterations);
        EXPECT_LT(sunk(world), 0.01) << count;
        EXPECT_LT(world.measure().kinetic_energy, 1e-6 * world.measure().potential_energy) << count;
    }
    EXPECT_GT(sunk(stack(13, 10)), 1);
}

TEST(SequentialImpulses, CarryTheWeightOfFive) {
    StepSettings settings = settings_for("sequential_impulses");
    settings.iterations = 100;
    expect_weights(stack("sequential_impulses", settings, 5), 5);
}

// A box at rest does not creep, not even on a slope that friction holds. Known failing: with XPBD
// it creeps down, since its static friction holds a point either fully or not at all.
TEST_P(Contacts, ABoxAtRestDoesNotCreep) {
    for (const double slope : {0.0, 0.2, 0.4}) {
        World world(GetParam(), settings_for(GetParam()));
        const glm::dquat tilt(std::cos(slope / 2), 0, 0, std::sin(slope / 2));
        world.add_body(ground(0.6, 0, tilt * V{0, 1, 0}));
        BodyDef def = dynamic_body(block(V{0.4, 0.2, 0.3}), 2, tilt * V{0, 0.2, 0});
        def.pose.rotation = narrow(tilt);
        const BodyId id = world.add_body(with_material(def, 0.6, 0));
        run(world, 60);
        const V settled = position_of(world, id);
        run(world, 600);
        if (GetParam() == "xpbd" && slope > 0) {
            EXPECT_GT(glm::distance(position_of(world, id), settled), 1e-3) << slope;
            continue;
        }
        EXPECT_LE(glm::distance(position_of(world, id), settled), 1e-4) << slope;
        EXPECT_LE(glm::length(velocity_of(world, id)), 1e-4) << slope;
    }
}

// v^2 / (2 mu g), minus the v h / 2 by which a semi-implicit step is ahead of its velocity, in any
// direction: friction is a cone, not a pyramid. With a pyramid the distance at 45 degrees would be
// shorter by 0.3. Known failing: XPBD, whose friction is bounded by the overlap correction, which
// is off from the load by some per cent, as the corners are solved in turn.
TEST_P(Contacts, StoppingDistance) {
    const double mu = 0.3, speed = 4;
    const double exact = speed * speed / (2 * mu * gravity);
    double least = 1e9, most = 0;
    for (int heading = 0; heading < 16; ++heading) {
        const double angle = heading * 2 * pi / 16;
        const V along{std::cos(angle), 0, std::sin(angle)};
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(ground(mu, 0));
        const BodyId id = world.add_body(with_material(
            dynamic_body(block(V{0.3, 0.1, 0.3}), 2, V{0, 0.1, 0}, speed * along), mu, 0));
        run(world, 180);
        const V end = position_of(world, id) - V{0, 0.1, 0};
        const double way = glm::dot(end, along);
        least = std::min(least, way);
        most = std::max(most, way);
        if (GetParam() == "xpbd") {
            EXPECT_NEAR(way, exact, 0.06 * exact) << heading;
            continue;
        }
        EXPECT_NEAR(way, exact - speed * substep_of(world) / 2, 0.005 * exact) << heading;
        EXPECT_LE(glm::length(end - way * along), 0.005 * exact) << heading;
        EXPECT_LE(glm::length(velocity_of(world, id)), 1e-3);
    }
    EXPECT_EQ(most / least <= 1.01, GetParam() != "xpbd");
}

// On a slope of any heading: g (sin a - mu cos a), or rest if tan a < mu.
TEST_P(Contacts, Slope) {
    const double mu = 0.4;
    for (const double slope : {0.2, 0.35, 0.45, 0.6})
        for (const double facing : {0.0, 0.7, 2.0}) {
            const V axis{std::sin(facing), 0, std::cos(facing)};
            const glm::dquat tilt(std::cos(slope / 2), std::sin(slope / 2) * axis);
            World world(GetParam(), settings_for(GetParam()));
            world.add_body(ground(mu, 0, tilt * V{0, 1, 0}));
            BodyDef def = dynamic_body(block(V{0.3, 0.1, 0.3}), 2, tilt * V{0, 0.1, 0});
            def.pose.rotation = narrow(tilt);
            const BodyId id = world.add_body(with_material(def, mu, 0));
            run(world, 60);
            const double speed = glm::length(velocity_of(world, id));
            if (std::tan(slope) < mu) {
                EXPECT_LE(speed, GetParam() == "xpbd" ? 5e-3 : 1e-3) << slope;
            } else {
                const double expected = gravity * (std::sin(slope) - mu * std::cos(slope));
                const double share = GetParam() == "xpbd" ? 0.25 : 0.01; // see StoppingDistance
                EXPECT_NEAR(speed, expected, share * expected) << slope << ' ' << facing;
            }
        }
}

// A ball thrown without spin slides until it rolls, at 5/7 of its speed. Then it rolls on, on its
// own radius, though it penetrates by 1e-4 of it and more.
TEST_P(Contacts, SlideToRoll) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0.4, 0));
    const BodyId id = world.add_body(
        with_material(dynamic_body(ball(0.25), 2, V{0, 0.25, 0}, V{3, 0, 1.5}), 0.4, 0));
    run(world, 120);
    const V v = velocity_of(world, id), w = spin_of(world, id);
    const V expected = 5.0 / 7 * V{3, 0, 1.5};
    // Known failing: XPBD's spin decays (FreeMotion), and takes the speed with it.
    if (GetParam() == "xpbd") {
        EXPECT_NEAR(glm::distance(v, expected), 0.012, 0.01);
        return;
    }
    EXPECT_LE(glm::distance(v, expected), 2e-5 * glm::length(expected));
    const double slip = glm::length(v + glm::cross(w, V{0, -0.25, 0}));
    EXPECT_LE(slip, 2e-5);
    run(world, 120);
    EXPECT_LE(glm::distance(velocity_of(world, id), expected), 2e-5 * glm::length(expected));
}

TEST_P(Contacts, WithoutFrictionNothingSlowsDown) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0, 0));
    const BodyId id = world.add_body(
        with_material(dynamic_body(block(V{0.3, 0.1, 0.3}), 2, V{0, 0.1, 0}, V{3, 0, 1}), 0.5, 0));
    run(world, 120);
    EXPECT_LE(glm::distance(velocity_of(world, id), V{3, 0, 1}), 1e-3);
}

// Contacts are made for everything a body may reach in a step, so a bullet stops at a thin wall.
TEST_P(Contacts, AFastBallDoesNotPassAThinWall) {
    for (const double speed : {10.0, 50.0, 300.0, 1000.0})
        for (const double start : {0.5, 1.3, 2.0, 3.7}) {
            World world(GetParam(), weightless(settings_for(GetParam())));
            world.add_body(static_body(block(V{0.025, 5, 5})));
            const BodyId id =
                world.add_body(dynamic_body(ball(0.1), 1, V{-start, 0, 0}, V{speed, 0, 0}));
            run(world, 60);
            EXPECT_LE(position_of(world, id).x, -0.025 - 0.1 + 0.01) << speed << ' ' << start;
        }
}

// Known failing of methods that do not look ahead: a contact plane is that of the start of the
// step, so a body that would fly past a corner within the step is stopped by it.
TEST_P(Contacts, AFastBallPassesBesideABox) {
    const auto passes = [&](double speed) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        world.add_body(static_body(block(V{0.5})));
        const BodyId id = world.add_body(dynamic_body(ball(0.1), 1, V{-2, 0.8, 0}, V{speed, 0, 0}));
        run(world, 60);
        return velocity_of(world, id) == V{speed, 0, 0};
    };
    EXPECT_TRUE(passes(3));
    EXPECT_EQ(passes(300), find_method(GetParam())->info.looks_ahead);
}

// Known failing of methods that do not look ahead: the reach of a turning body's ends within a step
// is ignored. A rod that makes more than a quarter turn in one step misses a post that its end has
// passed.
TEST_P(Contacts, ASpinningRodNoticesAPost) {
    const auto notices = [&](double spin, int steps) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        world.add_body(static_body(block(V{0.02, 0.5, 0.02}), V{0, 0, 0.9}));
        BodyDef rod = dynamic_body(block(V{1, 0.02, 0.02}), 1, V{0});
        rod.angular_velocity = narrow(V{0, spin, 0});
        world.add_body(rod);
        const double before = world.measure().angular_momentum.y;
        run(world, steps);
        return std::abs(world.measure().angular_momentum.y - before) > 0.01 * before;
    };
    EXPECT_TRUE(notices(2, 60));
    if (GetParam() == "xpbd")
        return; // its spin decays by more than that in any case
    EXPECT_EQ(notices(60 * 3.0, 1),
              find_method(GetParam())->info.looks_ahead); // after turning by 2 to 3 rad
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
