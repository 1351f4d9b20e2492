// Torque-free tops: the spin methods against the closed form and each other.
#include "tests/dynamics/free_top.h"
#include "tests/dynamics/worlds.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// u is the integral of 1 / sqrt(1 - m sin^2) up to the amplitude whose sine is sn (Abramowitz and
// Stegun, 16.1.3), here by Simpson's rule.
TEST(Jacobi, InvertsTheEllipticIntegral) {
    for (const long double m : {0.0L, 0.1L, 0.5L, 0.9L, 0.999L})
        for (const long double amplitude : {-1.5L, -0.3L, 0.0L, 0.7L, 1.2L, 1.57L}) {
            const auto integrand = [&](long double phi) {
                return 1 / std::sqrt(1 - m * std::sin(phi) * std::sin(phi));
            };
            constexpr int intervals = 20000;
            const long double h = amplitude / intervals;
            long double u = integrand(0) + integrand(amplitude);
            for (int i = 1; i < intervals; ++i)
                u += (i % 2 == 1 ? 4 : 2) * integrand(i * h);
            u *= h / 3;
            const Elliptic e = jacobi(u, m);
            EXPECT_NEAR(double(e.sn), double(std::sin(amplitude)), 1e-12);
            EXPECT_NEAR(double(e.cn), double(std::cos(amplitude)), 1e-12);
            EXPECT_NEAR(double(e.dn), double(1 / integrand(amplitude)), 1e-12);
        }
    // Abramowitz and Stegun, table 17.1.
    EXPECT_NEAR(double(quarter_period(0.5L)), 1.854074677301372, 1e-15);
    EXPECT_NEAR(double(quarter_period(0.99L)), 3.695637362989875, 1e-15);
}

// Tops spinning about the axis of the greatest and of the least moment, and one near the middle
// axis; each in two orders of the axes.
struct Top {
    V half_extents;
    V spin; // body axes, zero about the middle
};
constexpr double near_middle = 0.2;
const std::array tops{Top{{0.1, 0.2, 0.4}, {4, 0, 2}},           Top{{0.1, 0.2, 0.4}, {1, 0, 5}},
                      Top{{0.4, 0.2, 0.1}, {-5, 0, 1}},          Top{{0.2, 0.4, 0.1}, {0, 2, -4}},
                      Top{{0.1, 0.2, 0.4}, {3, 0, near_middle}}, Top{{0.2, 0.1, 0.4}, {0, 3, 5.2}}};

FreeTop top_of(const World &world, BodyId id, const V &spin) {
    return {WideVec{wide(world.bodies()[id.index].inertia)}, WideVec{spin}};
}

BodyId add_top(World &world, const Top &top) {
    BodyDef def = dynamic_body(block(top.half_extents), 2, V{0});
    def.angular_velocity = narrow(top.spin);
    return world.add_body(def);
}

// The rotation from `from` to `to`, in the body axes of `from`.
WideQuat turn_between(const WideQuat &from, const WideQuat &to) {
    return product({from.w, -from.x, -from.y, -from.z}, to);
}

TEST(FreeTop, TheReferenceBySmallStepsAgrees) {
    for (const Top &top : tops) {
        World world("rk4", weightless(settings_for("rk4")));
        const BodyId id = add_top(world, top);
        const FreeTop exact = top_of(world, id, top.spin);
        for (const double periods : {0.1, 0.5, 0.8, 3.0}) {
            const long double time = periods * exact.period();
            const SpinState found = spin_reference(wide(world.bodies()[id.index].inertia),
                                                   WideVec{top.spin}, WideQuat{}, time, 40000);
            EXPECT_LE(double(glm::distance(found.spin, exact.spin_at(time))), 1e-10) << periods;
            const WideQuat turned =
                turn_between(exact.rotation_at(0, 0), exact.rotation_at(time, 0));
            EXPECT_LE(angle_between(found.rotation, turned), 1e-9) << periods;
        }
    }
}

// The greatest errors at step ends over three periods.
struct TopError {
    double spin = 0;     // relative to the greatest
    double rotation = 0; // rad
    double momentum = 0; // in the world, relative to it
    double energy = 0;   // relative, too
};

TopError error_of(const std::string &method, const Top &top, double dt) {
    StepSettings settings = weightless(settings_for(method));
    settings.dt = dt;
    settings.substeps = settings.max_substeps = 1;
    World world(method, settings);
    const BodyId id = add_top(world, top);
    const Measures before = world.measure();
    const FreeTop exact = top_of(world, id, wide(narrow(top.spin)));
    const int steps = int(3 * double(exact.period()) / dt);
    const double momentum = glm::length(before.angular_momentum);
    TopError worst;
    for (int i = 1; i <= steps; ++i) {
        world.step(nullptr);
        if (i % (steps / 10) != 0)
            continue;
        const Motion &motion = motion_of(world, id);
        const WideVec spin = turn_back(widened(motion.rotation), widened(motion.angular_velocity));
        const long double time = i * static_cast<long double>(dt);
        const WideQuat turned = turn_between(exact.rotation_at(0, 0), exact.rotation_at(time, 0));
        const Measures now = world.measure();
        const auto keep = [](double &greatest, double error) {
            greatest = std::max(greatest, error);
        };
        keep(worst.spin, double(glm::distance(spin, exact.spin_at(time))) / glm::length(top.spin));
        keep(worst.rotation, angle_between(widened(motion.rotation), turned));
        keep(worst.momentum,
             glm::distance(now.angular_momentum, before.angular_momentum) / momentum);
        keep(worst.energy, std::abs(now.energy() / before.energy() - 1));
    }
    return worst;
}

// At |w| h of 0.05 to 0.1; single precision also drifts along the way.
TEST(FreeTop, ImplicitSplitAndRungeKuttaSpinsFollowIt) {
    const double rounding = is_double ? 1e-7 : 1e-2;
    for (const Top &top : tops) {
        const TopError implicit = error_of("soft_step", top, 1.0 / 64);
        EXPECT_LE(implicit.spin, 0.006 + rounding);
        EXPECT_LE(implicit.rotation, 0.06 + rounding);
        EXPECT_LE(implicit.momentum, 2000 * epsilon);
        EXPECT_LE(implicit.energy, 2000 * epsilon);
        const TopError split = error_of("split_spin", top, 1.0 / 64);
        EXPECT_LE(split.spin, 0.18 + rounding);
        EXPECT_LE(split.rotation, 0.18 + rounding);
        EXPECT_LE(split.momentum, 2000 * epsilon);
        EXPECT_LE(split.energy, 0.02); // bounded, not conserved
        const TopError rk4 = error_of("rk4", top, 1.0 / 64);
        EXPECT_LE(rk4.spin, 3e-6 + rounding);
        EXPECT_LE(rk4.rotation, 1e-5 + rounding);
        EXPECT_LE(rk4.momentum, 1e-6 + 2000 * epsilon);
        EXPECT_LE(rk4.energy, 1e-6 + 2000 * epsilon);
    }
}

// Known failing: without the gyroscopic term no step is short enough, for either the spin or the
// conserved quantities; the other methods improve with their order.
TEST(FreeTop, NaiveSpinIsAsWrongAtAnyStep) {
    if (!is_double)
        GTEST_SKIP() << "orders do not stand out of single precision";
    for (const Top &top : tops) {
        const auto order = [&](const char *method) {
            return std::log2(error_of(method, top, 1.0 / 128).spin /
                             error_of(method, top, 1.0 / 256).spin);
        };
        EXPECT_NEAR(order("soft_step"), 2, 0.05);
        EXPECT_NEAR(order("split_spin"), 2, 0.05);
        EXPECT_NEAR(order("rk4"), 4, 0.1);
        EXPECT_NEAR(order("naive_spin"), 0, 0.05);
        const TopError naive = error_of("naive_spin", top, 1.0 / 256);
        EXPECT_GT(naive.spin, 0.1);
        EXPECT_GT(naive.rotation, 0.1);
        EXPECT_GT(naive.momentum, 0.01);
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
