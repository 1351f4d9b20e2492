// Dampers of soft step that are strong for the substep, against closed forms and fine steps.
#include "engine/dynamics/method.h"
#include "engine/dynamics/particles/spring_constraint.h"
#include "tests/dynamics/particles.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// v' = f - x v over a unit of time, from v = 1: the mean speed, and the speed at the end.
TEST(Dampers, AreExactUnderAConstantForce) {
    for (double x = 1e-3; x < 1e3; x *= 1.7)
        for (const double force : {0.0, 1.0, -3.0, 1e3}) {
            const long double final_speed = force / static_cast<long double>(x);
            const long double off = 1 - final_speed;
            const long double mean = final_speed - off * std::expm1(-static_cast<long double>(x)) /
                                                       static_cast<long double>(x);
            const long double end = final_speed + off * std::exp(-static_cast<long double>(x));
            const DamperHalf first = damper_before_move(static_cast<Real>(x));
            const DamperHalf second = damper_after_move(static_cast<Real>(x));
            const double half = 0.5 * force;
            const double to_mean = double(first.of_force) * (1 + half) + double(first.of_start);
            const double to_end =
                double(second.of_force) * (to_mean + half) + double(second.of_start) * to_mean;
            const double rounding = 200 * epsilon + 2e-8; // and the series' next terms
            const double scale = 1 + std::abs(force);
            EXPECT_NEAR(to_mean, double(mean), rounding * scale) << x << ' ' << force;
            EXPECT_NEAR(to_end, double(end), rounding * scale) << x << ' ' << force;
        }
}

// m y'' = -m g - c y' - k y from rest at 0.
double sunk(double m, double k, double c, double t) {
    const double rate = c / (2 * m), squared = rate * rate - k / m, least = -m * gravity / k;
    if (squared <= 0) {
        const double w = std::sqrt(-squared);
        return least * (1 - std::exp(-rate * t) * (std::cos(w * t) + rate / w * std::sin(w * t)));
    }
    const double fast = rate + std::sqrt(squared), slow = k / m / fast;
    return least * (1 + (slow * std::exp(-fast * t) - fast * std::exp(-slow * t)) / (fast - slow));
}

// At 60 Hz what hung on a damper of 1000 N s/m to the kilogram sank 1.4 times as far, on one of 1e4
// three times.
TEST(Dampers, LetSinkAsTheirClosedFormSays) {
    for (const bool is_body : {false, true})
        for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240})
            for (const double mass : {0.1, 1.0, 30.0})
                for (const double k : {20.0, 500.0})
                    for (const double c : {30.0, 100.0, 300.0, 1e3, 1e4, 1e5}) {
                        StepSettings settings = settings_for("soft_step");
                        settings.dt = dt;
                        settings.sleep_after = 0;
                        World world("soft_step", settings);
                        const SpringEnd end =
                            is_body
                                ? of_body(world.add_body(dynamic_body(ball(0.1), mass, V{0})), V{0})
                                : of_particle(world.add_particle(particle_at(V{0}, mass)));
                        const double length = 20;
                        world.add_spring(spring(of_world(V{0, length, 0}), end, length, k, c));
                        const double least = mass * gravity / k;
                        double most = 0;
                        while (world.time() < 5) {
                            run(world, 1);
                            const double y = is_body ? position_of(world, world.body_id(0)).y
                                                     : particle_position(world, 0).y;
                            most = std::max(most, std::abs(y - sunk(mass, k, c, world.time())));
                        }
                        const double went = std::abs(sunk(mass, k, c, 5));
                        EXPECT_LT(most, 0.015 * went + 1e-5)
                            << (is_body ? "body " : "particle ") << dt << ' ' << mass << ' ' << k
                            << ' ' << c << ": of " << least;
                    }
}

// Two bodies that fly apart lose no momentum to a damper between them, and gain no energy.
TEST(Dampers, BetweenBodiesKeepMomentum) {
    for (const double c : {100.0, 1e3, 1e5}) {
        World world("soft_step", weightless(settings_for("soft_step")));
        BodyDef left = dynamic_body(ball(0.1), 1, V{-1, 0, 0});
        BodyDef right = dynamic_body(ball(0.1), 3, V{1, 0, 0});
        left.velocity = narrow(V{-2, 1, 0});
        right.velocity = narrow(V{3, -0.5, 0.2});
        const BodyId a = world.add_body(left), b = world.add_body(right);
        world.add_spring(spring(of_body(a, V{0}), of_body(b, V{0}), 2, 100, c));
        const V before = world.measure().linear_momentum;
        const V turning = world.measure().angular_momentum;
        const double energy = world.energy();
        double most = 0;
        for (int i = 0; i < 300; ++i) {
            run(world, 1);
            most = std::max(most, world.energy());
        }
        EXPECT_LT(glm::length(world.measure().linear_momentum - before), 1e4 * epsilon) << c;
        EXPECT_LT(glm::length(world.measure().angular_momentum - turning), 1e4 * epsilon) << c;
        EXPECT_LT(most, energy * (1 + 1e-4)) << c;
    }
}

// A plate on four dampers, loaded at one corner, sinks and tilts as it does at a sixteenth of the
// step.
TEST(Dampers, ShareAPlate) {
    const auto sink = [](double dt) {
        StepSettings settings = settings_for("soft_step");
        settings.dt = dt;
        settings.sleep_after = 0;
        World world("soft_step", settings);
        const BodyId plate = world.add_body(dynamic_body(block(V{1, 0.05, 0.5}), 20, V{0}));
        for (const double x : {-0.9, 0.9})
            for (const double z : {-0.4, 0.4})
                world.add_spring(
                    spring(of_world(V{x, 1, z}), of_body(plate, V{x, 0, z}), 1, 500, 5000));
        world.add_body(with_material(dynamic_body(block(V{0.1}), 5, V{0.8, 0.15, 0.3}), 0.8, 0));
        while (world.time() < 5)
            run(world, 1);
        const V up = wide(motion_of(world, plate).rotation) * V{0, 1, 0};
        return std::pair(position_of(world, plate).y, std::hypot(up.x, up.z));
    };
    const auto [coarse, coarse_tilt] = sink(1.0 / 60);
    const auto [fine, fine_tilt] = sink(1.0 / 960);
    EXPECT_LT(fine, -0.03);
    EXPECT_NEAR(coarse, fine, 0.01 * std::abs(fine));
    EXPECT_GT(fine_tilt, 0.01);
    EXPECT_NEAR(coarse_tilt, fine_tilt, 0.02 * fine_tilt);
}

// What sinks slowly on a damper sleeps only where it stays.
TEST(Dampers, KeepAwakeWhatTheyLetSink) {
    for (const double radius : {0.02, 0.1, 1.0})
        for (const double c : {100.0, 300.0, 1000.0}) {
            World world("soft_step", settings_for("soft_step"));
            const BodyId body = world.add_body(dynamic_body(ball(radius), 1, V{0}));
            world.add_spring(spring(of_world(V{0, 2, 0}), of_body(body, V{0}), 2, 50, c));
            while (world.time() < 20 * c / 50)
                run(world, 1);
            EXPECT_NEAR(position_of(world, body).y, -gravity / 50, 1e-3 * radius)
                << radius << ' ' << c;
            EXPECT_EQ(glm::length(velocity_of(world, body)), 0) << radius << ' ' << c; // asleep
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
