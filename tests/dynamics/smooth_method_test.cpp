// The smooth methods on springs: order, stability, energy.
#include "tests/dynamics/particles.h"

#include <map>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

const std::map<std::string, double> orders{{"explicit_euler", 1},
                                           {"semi_implicit_euler", 1},
                                           {"stormer_verlet", 2},
                                           {"velocity_verlet", 2},
                                           {"rk4", 4},
                                           {"backward_euler", 1}};

std::vector<std::string> ordered_methods() {
    std::vector<std::string> names;
    for (const auto &[name, order] : orders)
        names.push_back(name);
    return names;
}

class SmoothMethods : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, SmoothMethods, testing::ValuesIn(ordered_methods()), name_of);

// Two particles and a ball joined to each other and to the world by damped springs, one of them
// attached to the ball's side: they swing and turn in space under gravity.
World swinging(const std::string &method, double dt, bool damped = true) {
    StepSettings settings = settings_for(method);
    settings.dt = dt;
    settings.substeps = settings.max_substeps = 1;
    settings.sleep_after = 0;
    World world(method, settings);
    world.add_particle(moving_particle(V{1, 0, 0}, V{0, 0.5, 1}, 0.5));
    world.add_particle(moving_particle(V{1.5, 1, 0}, V{0, -0.5, 0.3}, 0.8));
    BodyDef def = dynamic_body(ball(0.3), 2, V{2.5, 0, 0}, V{0, 0.2, -0.4});
    def.angular_velocity = narrow(V{0.3, 1, -0.5});
    def.colliders.front().sensor = true; // no contacts
    def.inertia = Vec3{Real(0.4 * 2 * 0.3 * 0.3)};
    if (damped) {
        def.linear_damping = Real(0.3);
        def.angular_damping = Real(0.2);
    }
    const BodyId body = world.add_body(def);
    const double c = damped ? 0.4 : 0;
    world.add_spring(spring(of_world(V{0}), of_particle(0), 0.9, 20, c));
    world.add_spring(spring(of_particle(0), of_particle(1), 1.0, 15, c));
    world.add_spring(spring(of_particle(1), of_body(body, V{0, 0.25, 0.1}), 1.1, 12, c));
    world.add_spring(spring(of_body(body, V{-0.3, 0, 0}), of_world(V{3, 2, 0}), 1.5, 18, c));
    return world;
}

std::vector<double> after(const std::string &method, int steps) {
    World world = swinging(method, 1.0 / steps);
    run(world, steps);
    std::vector<double> all;
    const auto add = [&](const V &v) { all.insert(all.end(), {v.x, v.y, v.z}); };
    for (std::uint32_t i = 0; i < 2; ++i) {
        add(particle_position(world, i));
        add(particle_velocity(world, i));
    }
    add(position_of(world, world.body_id(0)));
    add(velocity_of(world, world.body_id(0)));
    add(spin_of(world, world.body_id(0)));
    return all;
}

double distance_of(const std::vector<double> &a, const std::vector<double> &b) {
    double squared = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squared += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(squared);
}

TEST_P(SmoothMethods, ConvergeWithTheirOrder) {
    if (!is_double)
        GTEST_SKIP() << "rounding hides it";
    static const std::vector<double> exact = after("rk4", 8192);
    const double order = orders.at(GetParam());
    const int coarsest = order == 1 ? 1024 : order == 2 ? 256 : 64;
    const double first = distance_of(after(GetParam(), coarsest), exact);
    const double second = distance_of(after(GetParam(), 2 * coarsest), exact);
    const double third = distance_of(after(GetParam(), 4 * coarsest), exact);
    EXPECT_NEAR(std::log2(first / second), order, 0.1) << first << ' ' << second;
    EXPECT_NEAR(std::log2(second / third), order, 0.1) << second << ' ' << third;
}

// How much the energy of a mass on a spring grows over some steps, for a given omega dt.
double growth(const std::string &method, double omega_dt, int steps) {
    StepSettings settings = weightless(settings_for(method));
    settings.dt = 0.01;
    settings.substeps = settings.max_substeps = 1;
    World world(method, settings);
    const double omega = omega_dt / settings.dt;
    world.add_particle(particle_at(V{1.001, 0, 0}));
    world.add_spring(spring(of_world(V{0}), of_particle(0), 1, omega * omega));
    const double before = world.energy();
    double most = 0;
    for (int i = 0; i < steps && std::isfinite(most); ++i) {
        run(world, 1);
        most = std::max(most, world.energy());
    }
    return most / before;
}

// A spring is stable up to omega dt = 2 with semi-implicit Euler and Verlet, up to 2 sqrt(2) with
// Runge-Kutta 4, never with explicit Euler, always with backward Euler.
TEST(Stability, LimitsAreThoseOfTheory) {
    const std::map<std::string, double> limits{{"semi_implicit_euler", 2},
                                               {"stormer_verlet", 2},
                                               {"velocity_verlet", 2},
                                               {"rk4", 2 * std::sqrt(2.0)}};
    for (const auto &[method, limit] : limits) {
        EXPECT_LT(growth(method, 0.99 * limit, 2000), 200) << method;
        EXPECT_GT(growth(method, 1.01 * limit, 400), 1e4) << method;
    }
    // |1 + i w h|^2 = 1 + (w h)^2 per step.
    EXPECT_NEAR(std::log(growth("explicit_euler", 0.05, 2000)), 2000 * std::log1p(0.0025), 0.1);
    EXPECT_GT(growth("explicit_euler", 0.1, 2000), 1e6);
    for (const double omega_dt : {0.1, 1.0, 3.0, 30.0, 1000.0})
        EXPECT_LE(growth("backward_euler", omega_dt, 500), 1 + 1e-4) << omega_dt;
}

TEST(Energy, ExplicitGainsSymplecticIsBoundedImplicitLoses) {
    const auto drift = [](const std::string &method) {
        World world = swinging(method, 1.0 / 200, false);
        const double before = world.energy();
        double most = 0, last = 0;
        for (int i = 0; i < 20000; ++i) {
            run(world, 1);
            last = world.energy() - before;
            most = std::max(most, std::abs(last));
        }
        return std::pair{most, last};
    };
    EXPECT_GT(drift("explicit_euler").second, 10);
    EXPECT_LT(drift("semi_implicit_euler").first, 1.0);
    for (const char *method : {"stormer_verlet", "velocity_verlet", "soft_step"})
        EXPECT_LT(drift(method).first, 0.1) << method;
    EXPECT_LT(drift("backward_euler").second, -1);
}

// A hanging net ten thousand times stiffer than the step could otherwise follow.
TEST(Stability, BackwardEulerHoldsAStiffNet) {
    StepSettings settings = settings_for("backward_euler");
    World world("backward_euler", settings);
    constexpr std::uint32_t n = 12;
    const auto at = [](std::uint32_t i, std::uint32_t j) { return i * n + j; };
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j)
            world.add_particle(particle_at(V{0.1 * i, 0, 0.1 * j}, 0.01, i == 0));
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            if (i + 1 < n)
                world.add_spring(
                    spring(of_particle(at(i, j)), of_particle(at(i + 1, j)), 0.1, 1e4, 0.1));
            if (j + 1 < n)
                world.add_spring(
                    spring(of_particle(at(i, j)), of_particle(at(i, j + 1)), 0.1, 1e4, 0.1));
        }
    run(world, 1200);
    EXPECT_TRUE(world.report().finite);
    // A column hangs straight down, each link stretched by the weight below it.
    double length = 0;
    for (std::uint32_t i = 1; i < n; ++i)
        length += 0.1 + (n - i) * 0.01 * gravity / 1e4;
    EXPECT_NEAR(particle_position(world, at(n - 1, 5)).y, -length, 2e-3);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
