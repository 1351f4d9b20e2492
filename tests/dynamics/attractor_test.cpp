// Attractors against Kepler's laws: the orbit in closed form, and its conserved quantities.
#include "tests/dynamics/particles.h"

#include <map>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// An ellipse about the origin in the xy plane; time starts at the farthest point, on +x.
struct Orbit {
    double a = 2, e = 0.5, mu = pi * pi / 2; // a period of 8 s

    double rate() const { return std::sqrt(mu / (a * a * a)); }
    // The eccentric anomaly E of Kepler's equation E - e sin E = M, by halving: M grows with E.
    double anomaly(double t) const {
        const double mean = rate() * t + pi;
        double low = mean - 1, high = mean + 1;
        for (int i = 0; i < 60; ++i) {
            const double middle = (low + high) / 2;
            (middle - e * std::sin(middle) < mean ? low : high) = middle;
        }
        return (low + high) / 2;
    }
    double height() const { return a * std::sqrt(1 - e * e); } // semi-minor axis
    V place(double t) const {
        const double E = anomaly(t);
        return {-a * (std::cos(E) - e), -height() * std::sin(E), 0};
    }
    V velocity(double t) const {
        const double E = anomaly(t), turning = rate() / (1 - e * std::cos(E));
        return {turning * a * std::sin(E), -turning * height() * std::cos(E), 0};
    }
    double energy() const { return -mu / (2 * a); } // for 1 kg
};

StepSettings settings_of(const std::string &method, double dt) {
    StepSettings settings = weightless(settings_for(method));
    settings.dt = dt;
    settings.substeps = settings.max_substeps = 1;
    return settings;
}

const V sun{0.5, -1, 2};

World orbiting(const std::string &method, double dt, bool is_particle = false) {
    const Orbit orbit;
    World world(method, settings_of(method, dt));
    world.add_attractor({narrow(sun), Real(orbit.mu)});
    if (is_particle)
        world.add_particle(moving_particle(sun + orbit.place(0), orbit.velocity(0)));
    else
        world.add_body(dynamic_body(ball(0.1), 1, sun + orbit.place(0), orbit.velocity(0)));
    return world;
}
V place(const World &world, bool is_particle) {
    return is_particle ? particle_position(world, 0) : position_of(world, world.body_id(0));
}

// Distance from the closed form after five eighths of a period, past the nearest point.
double error_after(const std::string &method, int steps, bool is_particle) {
    constexpr double end = 5;
    World world = orbiting(method, end / steps, is_particle);
    run(world, steps);
    return glm::distance(place(world, is_particle), sun + Orbit{}.place(end));
}

class Attractors : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Attractors, testing::ValuesIn(all_methods()), name_of);

// First order, except for the time-symmetric methods and Runge-Kutta 4.
TEST_P(Attractors, MethodsFollowKeplersOrbitWithTheirOrder) {
    if (!is_double)
        GTEST_SKIP() << "rounding hides it";
    static const std::map<std::string, double> orders{{"soft_step", 2},       {"stormer_verlet", 2},
                                                      {"velocity_verlet", 2}, {"rk4", 4},
                                                      {"naive_spin", 2},      {"split_spin", 2}};
    const auto found = orders.find(GetParam());
    const double order = found == orders.end() ? 1 : found->second;
    const int coarsest = order == 1 ? 16384 : order == 2 ? 1024 : 512;
    for (const bool is_particle : {false, true}) {
        if (is_particle && !find_method(GetParam())->info.springs)
            continue;
        const double first = error_after(GetParam(), coarsest, is_particle);
        const double second = error_after(GetParam(), 2 * coarsest, is_particle);
        EXPECT_NEAR(std::log2(first / second), order, 0.1) << first << ' ' << second;
    }
}

// With several substeps per step too; no method knows the closed form.
TEST_P(Attractors, SubstepsAreSteps) {
    World fine = orbiting(GetParam(), 1.0 / 240);
    StepSettings settings = settings_of(GetParam(), 1.0 / 60);
    settings.substeps = settings.max_substeps = 4;
    World coarse = orbiting(GetParam(), 1.0 / 60);
    coarse.set_settings(settings);
    run(fine, 240);
    run(coarse, 60);
    EXPECT_LT(glm::distance(place(fine, false), place(coarse, false)), 300 * epsilon);
}

// Kepler's second law, and the energy -mu / (2 a).
TEST(Attractors, SymplecticMethodsKeepAngularMomentumAndEnergy) {
    for (const char *method :
         {"semi_implicit_euler", "stormer_verlet", "velocity_verlet", "soft_step"}) {
        World world = orbiting(method, 1.0 / 240);
        const V moment = glm::cross(Orbit{}.place(0), Orbit{}.velocity(0));
        EXPECT_NEAR(world.energy(), Orbit{}.energy(), 10 * epsilon);
        for (int i = 0; i < 24000; ++i) { // twelve and a half periods
            run(world, 1);
            if (i % 500 == 0) {
                const V now =
                    glm::cross(place(world, false) - sun, velocity_of(world, world.body_id(0)));
                EXPECT_NEAR(glm::distance(now, moment), 0, 20000 * epsilon) << method;
                EXPECT_NEAR(world.energy(), Orbit{}.energy(), is_double ? 6e-3 : 8e-3) << method;
            }
        }
    }
}

// Whatever scales gravity, or removes an axis of it, does so to an attractor too; fixed bodies
// stay.
TEST(Attractors, PullAsGravityDoes) {
    World world("velocity_verlet", settings_of("velocity_verlet", 1.0 / 1024));
    world.add_attractor({Vec3{Real(0)}, Real(8)});
    BodyDef twice = dynamic_body(ball(0.1), 1, V{2, 0, 0});
    twice.gravity_scale = Real(2);
    BodyDef held = dynamic_body(ball(0.1), 1, V{0, 2, 0});
    held.locked[1] = true;
    world.add_body(twice);
    world.add_body(held);
    world.add_body(static_body(ball(0.1), V{0, 0, 2}));
    world.add_particle(particle_at(V{0, -2, 0}));
    world.add_particle(particle_at(V{0, 0, -2}, 1, true));
    run(world, 1);
    const double dt = 1.0 / 1024; // 8 / 2^2 = 2 m/s^2
    EXPECT_NEAR(velocity_of(world, world.body_id(0)).x, -4 * dt, 1e-5 * dt);
    EXPECT_EQ(velocity_of(world, world.body_id(1)), V{0});
    EXPECT_EQ(velocity_of(world, world.body_id(2)), V{0});
    EXPECT_NEAR(particle_velocity(world, 0).y, 2 * dt, 1e-5 * dt);
    EXPECT_EQ(particle_velocity(world, 1), V{0});
}

// A kinematic body keeps its prescribed motion: forces do not move it.
TEST(Attractors, LeaveAloneWhatMovesAsTold) {
    for (const std::string &method : all_methods()) {
        World world(method, settings_of(method, 1.0 / 64));
        world.add_attractor({Vec3{Real(0)}, Real(8)});
        BodyDef told = static_body(ball(0.1), V{2, 0, 0});
        told.kind = BodyKind::kinematic;
        told.velocity = narrow(V{0, 1, 0});
        const BodyId id = world.add_body(told);
        run(world, 32);
        EXPECT_NEAR(glm::distance(position_of(world, id), V(2, 0.5, 0)), 0, 10 * epsilon) << method;
        EXPECT_EQ(velocity_of(world, id), V(0, 1, 0)) << method;
    }
}

// Two balls dropped on opposite sides of an attractor inside a stone ball come to rest on it, and
// stay.
TEST(Attractors, BallsRestOnAPlanet) {
    for (const std::string &method : contact_methods()) {
        if (method == "naive_impulses") // nothing rests under it
            continue;
        StepSettings settings = weightless(settings_for(method));
        World world(method, settings);
        world.add_attractor({Vec3{Real(0)}, Real(gravity)}); // 9.81 m/s^2 at its surface
        world.add_body(static_body(ball(1)));
        const BodyId above = world.add_body(dynamic_body(ball(0.2), 1, V{0, 1.3, 0}));
        const BodyId below = world.add_body(dynamic_body(ball(0.2), 1, V{0, -1.3, 0}));
        run(world, 240);
        EXPECT_NEAR(position_of(world, above).y, 1.2, 0.01) << method;
        EXPECT_NEAR(position_of(world, below).y, -1.2, 0.01) << method;
        EXPECT_LT(glm::length(velocity_of(world, above)), 0.02) << method;
    }
}

TEST(Attractors, AreSavedAndHashed) {
    World world = orbiting("soft_step", 1.0 / 60);
    run(world, 10);
    SavedWorld saved;
    world.save(saved);
    run(world, 30);
    const std::uint64_t after = world.hash();
    World other("rk4", StepSettings{});
    other.restore(saved);
    run(other, 30);
    EXPECT_EQ(other.hash(), after);
    const std::uint64_t before = other.hash();
    other.add_attractor({Vec3{Real(1)}, Real(2)});
    EXPECT_NE(other.hash(), before);
    EXPECT_EQ(world.model().attractors.size(), 1U); // the saved model is not edited
}

TEST(Attractors, RefuseWhatIsNotFinite) {
    World world("soft_step", StepSettings{});
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_ANY_THROW(world.add_attractor({Vec3{nan}, Real(1)}));
    EXPECT_ANY_THROW(world.add_attractor({Vec3{Real(0)}, nan}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
