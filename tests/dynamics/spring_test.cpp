// Springs between particles, bodies and the world, against their closed forms.
#include "tests/dynamics/particles.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Springs : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Springs, testing::ValuesIn(spring_methods()), name_of);

constexpr double k = 40; // N/m
constexpr double m = 2;  // kg
constexpr double rest = 1;
constexpr double stretch = 0.2;

// x'' = -k x / m - c x' / m from x = stretch at rest.
double closed_form(double c, double t) {
    const double rate = c / (2 * m);
    const double squared = k / m - rate * rate;
    if (squared == 0)
        return stretch * (1 + rate * t) * std::exp(-rate * t);
    if (squared > 0) {
        const double w = std::sqrt(squared);
        return stretch * std::exp(-rate * t) * (std::cos(w * t) + rate / w * std::sin(w * t));
    }
    const double w = std::sqrt(-squared);
    return stretch * std::exp(-rate * t) * (std::cosh(w * t) + rate / w * std::sinh(w * t));
}

World sprung(const std::string &method, double c, double dt) {
    StepSettings settings = weightless(settings_for(method));
    settings.dt = dt;
    World world(method, settings);
    const std::uint32_t p = world.add_particle(particle_at(V{rest + stretch, 0, 0}, m));
    world.add_spring(spring(of_world(V{0}), of_particle(p), rest, k, c));
    return world;
}

// The largest difference from the closed form within a second, as a share of the stretch.
double worst(const std::string &method, double c, double dt) {
    World world = sprung(method, c, dt);
    double most = 0;
    while (world.time() < 1) {
        run(world, 1);
        most = std::max(
            most, std::abs(particle_position(world, 0).x - rest - closed_form(c, world.time())));
    }
    return most / stretch;
}

// Undamped, under-, critically and overdamped. First-order methods are off by about w dt times the
// angle, 4.5 rad.
TEST_P(Springs, FollowsItsClosedForm) {
    for (const double c : {0.0, 3.0, 2 * std::sqrt(k * m), 60.0})
        EXPECT_LT(worst(GetParam(), c, 1e-3), 0.012) << "c = " << c;
}

// Two masses between two walls: the even mode swings at sqrt(k / m), the odd one at sqrt(3 k / m).
TEST_P(Springs, TwoMassesHaveTheirModes) {
    for (const bool odd : {false, true}) {
        StepSettings settings = weightless(settings_for(GetParam()));
        settings.dt = 1e-3;
        World world(GetParam(), settings);
        const double side = odd ? -1 : 1;
        world.add_particle(particle_at(V{1 + 0.1, 0, 0}, m));
        world.add_particle(particle_at(V{2 + 0.1 * side, 0, 0}, m));
        world.add_spring(spring(of_world(V{0}), of_particle(0), 1, k));
        world.add_spring(spring(of_particle(0), of_particle(1), 1, k));
        world.add_spring(spring(of_particle(1), of_world(V{3, 0, 0}), 1, k));
        const double w = std::sqrt((odd ? 3 : 1) * k / m);
        double most = 0;
        for (int i = 0; i < 1000; ++i) {
            run(world, 1);
            const double x = 0.1 * std::cos(w * world.time());
            most = std::max({most, std::abs(particle_position(world, 0).x - 1 - x),
                             std::abs(particle_position(world, 1).x - 2 - side * x)});
        }
        EXPECT_LT(most / 0.1, odd ? 0.035 : 0.012) << (odd ? "odd" : "even");
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
