#include "engine/dynamics/bodies/motion.h"

#include "engine/geometry/mass.h"
#include "tests/dynamics/rigid_spin.h"
#include "tests/dynamics/worlds.h"

#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;
using L = long double;

Body brick(const V &half_extents, double mass) {
    Body body;
    body.kind = BodyKind::dynamic;
    body.mass = Real(mass);
    body.inertia = principal_inertia(block(half_extents), Real(mass));
    body.inv_inertia = Real(1) / body.inertia;
    body.alive = true;
    return body;
}

SolverBody moving(const Body &body, const V &velocity, const V &spin, const glm::dquat &rotation) {
    SolverBody motion;
    motion.velocity = narrow(velocity);
    motion.angular_velocity = narrow(spin);
    motion.rotation = narrow(rotation);
    motion.inv_mass = Vec3{Real(1) / body.mass};
    motion.inv_inertia = world_inverse_inertia(motion.rotation, body.inv_inertia);
    return motion;
}

// Column by column: R I^-1 R^T e. The matrix entries are at most |I^-1| and come from about a dozen
// roundings; the rounding of a quaternion's length counts four times.
TEST(InverseInertia, AgainstWideArithmetic) {
    Random random(1);
    for (int trial = 0; trial < 5000; ++trial) {
        const Quat q = narrow(any_rotation(random));
        const Vec3 inverse{Real(random.next_in(0.1, 10)), Real(random.next_in(0.1, 10)),
                           Real(random.next_in(0.1, 10))};
        const Mat3 result = world_inverse_inertia(q, inverse);
        const double largest = std::max({double(inverse.x), double(inverse.y), double(inverse.z)});
        for (int column = 0; column < 3; ++column) {
            WideVec unit{0, 0, 0};
            unit[column] = 1;
            const WideQuat r = normalized(widened(q));
            const WideVec expected =
                turn(r, WideVec{L(inverse.x), L(inverse.y), L(inverse.z)} * turn_back(r, unit));
            for (int row = 0; row < 3; ++row)
                EXPECT_NEAR(double(result[column][row]), double(expected[row]),
                            24 * epsilon * largest);
        }
    }
}

TEST(InverseInertia, OfABallIsTheSameInEveryFrame) {
    Random random(2);
    const Vec3 inverse{Real(0.3)};
    for (int trial = 0; trial < 100; ++trial) {
        const Mat3 result = world_inverse_inertia(narrow(any_rotation(random)), inverse);
        EXPECT_EQ(result, Mat3{Real(0.3)});
    }
}

TEST(SpinMomentum, AgainstWideArithmetic) {
    Random random(3);
    for (int trial = 0; trial < 5000; ++trial) {
        const Quat q = narrow(any_rotation(random));
        const Vec3 inertia{Real(random.next_in(0.1, 10)), Real(random.next_in(0.1, 10)),
                           Real(random.next_in(0.1, 10))};
        const Vec3 spin = narrow(any_vector(random, 5));
        const WideQuat r = normalized(widened(q));
        const WideVec expected = turn(r, WideVec{L(inertia.x), L(inertia.y), L(inertia.z)} *
                                             turn_back(r, widened(spin)));
        const double size = 10 * glm::length(wide(spin));
        EXPECT_LE(double(glm::length(widened(spin_momentum(q, inertia, spin)) - expected)),
                  40 * epsilon * size);
    }
}

// The quaternion (cos(x/2), sin(x/2) axis) * rotation. Rounding the angle x turns the result by
// x epsilon / 2; add a dozen roundings of a unit quaternion.
TEST(Turned, AgainstTheExponentialMap) {
    Random random(4);
    for (int trial = 0; trial < 20000; ++trial) {
        const Quat q = narrow(any_rotation(random));
        const double size = std::pow(10.0, random.next_in(-9, 2));
        const Vec3 spin = narrow(size * glm::normalize(any_vector(random, 1) + V{1e-3}));
        const auto h = Real(random.next_in(0.001, 0.1));
        const WideVec axis = widened(spin);
        const L speed = glm::length(axis);
        const L half_angle = speed * L(h) / 2;
        const WideVec v = axis / speed * std::sin(half_angle);
        const WideQuat expected =
            product({std::cos(half_angle), v.x, v.y, v.z}, normalized(widened(q)));
        const WideQuat result = widened(turned(q, spin, h));
        const double tolerance = epsilon * (12 + 2 * double(half_angle));
        EXPECT_LE(std::abs(double(result.w - expected.w)), tolerance);
        EXPECT_LE(std::abs(double(result.x - expected.x)), tolerance);
        EXPECT_LE(std::abs(double(result.y - expected.y)), tolerance);
        EXPECT_LE(std::abs(double(result.z - expected.z)), tolerance);
    }
}

// Small turns must not get lost: axis and angle are accurate to relative rounding.
TEST(Turned, ByVerySmallAngles) {
    const Vec3 spin{Real(3e-5), Real(-4e-5), Real(1.2e-4)}; // 1.3e-4 rad/s
    const Quat q = turned(identity_rotation, spin, Real(0.01));
    const double series = 1 - 1.3e-6 * 1.3e-6 / 24; // of sin(x/2) / (x/2)
    EXPECT_NEAR(double(q.x), series * 1.5e-7, 8 * epsilon * 1.5e-7);
    EXPECT_NEAR(double(q.y), series * -2e-7, 8 * epsilon * 2e-7);
    EXPECT_NEAR(double(q.z), series * 6e-7, 8 * epsilon * 6e-7);
    EXPECT_EQ(turned(q, Vec3{Real(0)}, Real(1)), q);
}

double spin_energy(const V &inertia, const V &spin) {
    return 0.5 * glm::dot(inertia * spin, spin);
}

// The midpoint rule conserves w . I w and |I w|^2 for any step at which Newton's method finds the
// root: with enough iterations, up to two radians.
TEST(GyroscopicSpin, KeepsEnergyAndMomentum) {
    Random random(5);
    for (int trial = 0; trial < 20000; ++trial) {
        const V inertia = wide(principal_inertia(
            block(V{random.next_in(0.05, 1), random.next_in(0.05, 1), random.next_in(0.05, 1)}),
            Real(1)));
        const V spin = wide(narrow(any_vector(random, 10)));
        const double turn = random.next_in(0, 2);
        const double h = turn / glm::length(spin);
        const V end = wide(gyroscopic_spin(narrow(inertia), narrow(spin), Real(h), 20));
        // The rounding of each component of the spin, weighted by the largest inertia.
        const double largest = std::max({inertia.x, inertia.y, inertia.z});
        const double size = largest * glm::dot(spin, spin);
        EXPECT_NEAR(spin_energy(inertia, end), spin_energy(inertia, spin), 20 * epsilon * size)
            << "turn " << turn;
        EXPECT_NEAR(glm::length(inertia * end), glm::length(inertia * spin),
                    20 * epsilon * largest * glm::length(spin))
            << "turn " << turn;
    }
}

// Beyond that Newton's method may miss. Energy is still conserved to the stated 32 epsilon (plus
// rounding) for any step and number of iterations, so no spin can explode.
TEST(GyroscopicSpin, KeepsEnergyForAnyStep) {
    Random random(5);
    int momentum_lost = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const V inertia = wide(principal_inertia(
            block(V{random.next_in(0.05, 1), random.next_in(0.05, 1), random.next_in(0.05, 1)}),
            Real(1)));
        const V spin = wide(narrow(any_vector(random, 10)));
        const double turn = std::pow(10.0, random.next_in(-3, 4));
        const double h = turn / glm::length(spin);
        for (const int iterations : {1, 3, 20}) {
            const V end = wide(gyroscopic_spin(narrow(inertia), narrow(spin), Real(h), iterations));
            EXPECT_NEAR(spin_energy(inertia, end) / spin_energy(inertia, spin), 1, 50 * epsilon)
                << "turn " << turn;
            if (iterations == 3 &&
                std::abs(glm::length(inertia * end) / glm::length(inertia * spin) - 1) > 0.01)
                ++momentum_lost;
        }
    }
    EXPECT_GT(momentum_lost, 0); // known failing: at such steps the spin is no longer accurate
}

// The default of three iterations converges to rounding for turns of up to 0.3 rad per substep: 12
// turns a second at four substeps of a sixtieth.
TEST(GyroscopicSpin, ThreeIterationsAreEnoughForUsualSpins) {
    Random random(6);
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 inertia = principal_inertia(
            block(V{random.next_in(0.05, 1), random.next_in(0.05, 1), random.next_in(0.05, 1)}),
            Real(1));
        const Vec3 spin = narrow(any_vector(random, 10));
        const auto h = Real(0.3) / glm::length(spin);
        const Vec3 three = gyroscopic_spin(inertia, spin, h, 3);
        const Vec3 many = gyroscopic_spin(inertia, spin, h, 20);
        EXPECT_LE(double(glm::distance(three, many)), 40 * epsilon * glm::length(wide(spin)));
    }
}

void fly(SolverBody &motion, const Body &body, const V &pull, double h, Kick kick) {
    FreeFlight flight = begin_flight(motion, body, narrow(pull), Real(h), kick, 3);
    RoundedOff rounded_off;
    move(motion, rounded_off, body, flight, Real(h));
    EXPECT_TRUE(flight.free);
    end_flight(motion, body, flight, kick);
}

class Flight : public testing::TestWithParam<Kick> {};
INSTANTIATE_TEST_SUITE_P(Kicks, Flight, testing::Values(Kick::before, Kick::around),
                         [](const auto &kick) {
                             return kick.param == Kick::before ? "before" : "around";
                         });

// The sums of n substeps round values up to the farthest position and speed.
TEST_P(Flight, FollowsTheParabola) {
    const Body body = brick({0.1, 0.2, 0.3}, 2);
    const V start_velocity{3, 10, -1};
    const V pull{0.5, -9.81, 0};
    SolverBody motion = moving(body, start_velocity, V{1, 2, 3}, glm::dquat(1, 0, 0, 0));
    const double h = 1.0 / 256;
    const int steps = 512;
    for (int i = 1; i <= steps; ++i) {
        fly(motion, body, pull, h, GetParam());
        const double t = i * h;
        const V x = start_velocity * t + 0.5 * t * t * pull;
        const V v = start_velocity + t * pull;
        EXPECT_LE(glm::distance(wide(motion.position), x), i * 2 * epsilon * 7);
        EXPECT_LE(glm::distance(wide(motion.velocity), v), i * 2 * epsilon * 11);
    }
}

// A tumbling brick for 10 000 substeps: nothing may drift beyond rounding. Each substep rounds the
// rotation and the spin some ten times, with either sign; a tenth of the worst-case sum is many
// times a random walk.
TEST_P(Flight, KeepsEnergyAndAngularMomentum) {
    Random random(7);
    for (int trial = 0; trial < 10; ++trial) {
        const Body body = brick(
            {random.next_in(0.05, 0.5), random.next_in(0.05, 0.5), random.next_in(0.05, 0.5)}, 2);
        SolverBody motion = moving(body, V{0}, any_vector(random, 10), any_rotation(random));
        const auto momentum = [&] {
            const glm::dquat q = glm::normalize(wide(motion.rotation));
            return q * (wide(body.inertia) * (glm::conjugate(q) * wide(motion.angular_velocity)));
        };
        const V momentum_before = momentum();
        const double energy_before = 0.5 * glm::dot(momentum_before, wide(motion.angular_velocity));
        const int steps = 10000;
        for (int i = 0; i < steps; ++i)
            fly(motion, body, V{0}, 1.0 / 240, GetParam());
        const double energy = 0.5 * glm::dot(momentum(), wide(motion.angular_velocity));
        const double tolerance = 0.1 * steps * 10 * epsilon;
        EXPECT_NEAR(energy / energy_before, 1, tolerance);
        EXPECT_LE(glm::distance(momentum(), momentum_before) / glm::length(momentum_before),
                  tolerance);
    }
}

// Order 2: against Runge-Kutta in long double with a thousand times smaller steps.
TEST_P(Flight, TorqueFreeSpinIsOfSecondOrder) {
    const Body body = brick({0.1, 0.2, 0.4}, 2);
    const V start{1, 2, 0.5};
    const SpinState exact =
        spin_reference(wide(body.inertia), widened(narrow(start)), WideQuat{1, 0, 0, 0}, 2, 20000);
    std::vector<double> errors;
    for (const int steps : {16, 32, 64}) {
        SolverBody motion = moving(body, V{0}, start, glm::dquat(1, 0, 0, 0));
        for (int i = 0; i < steps; ++i)
            fly(motion, body, V{0}, 2.0 / steps, GetParam());
        const WideVec spin = turn(exact.rotation, exact.spin);
        errors.push_back(double(glm::length(widened(motion.angular_velocity) - spin)) +
                         angle_between(widened(motion.rotation), exact.rotation));
    }
    // The next term is two orders higher: at the coarsest step (|w| h)^2 = 0.08 of the ratio.
    for (std::size_t i = 0; i + 1 < errors.size(); ++i)
        EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2, 0.12) << errors[i];
}

// A symmetric top's axis precesses about its angular momentum at |L| / I_across. The midpoint rule
// turns each angle x in a substep into 2 atan(x / 2), an error of x^3 / 12: in the turn itself,
// w h, and in the spin's own precession in body axes, (1 - I_along / I_across) w_along h.
TEST_P(Flight, SymmetricTopPrecesses) {
    const Body body = brick({0.1, 0.3, 0.1}, 1);
    ASSERT_EQ(body.inertia.x, body.inertia.z);
    // Spin mostly about y, tilted: w = (1, 10, 0) in the body.
    const V start{1, 10, 0};
    SolverBody motion = moving(body, V{0}, start, glm::dquat(1, 0, 0, 0));
    const V momentum = wide(body.inertia) * start;
    const double rate = glm::length(momentum) / double(body.inertia.x);
    const double h = 1.0 / 500;
    const int steps = 500;
    const V along = glm::normalize(momentum);
    const V axis0 = V{0, 1, 0};
    const V u = glm::normalize(axis0 - glm::dot(axis0, along) * along);
    const V w = glm::cross(along, u);
    double angle = 0;
    double last = 0;
    for (int i = 0; i < steps; ++i) {
        fly(motion, body, V{0}, h, GetParam());
        const V axis = wide(motion.rotation) * axis0;
        const double now = std::atan2(glm::dot(axis, w), glm::dot(axis, u));
        angle += std::remainder(now - last, 2 * pi);
        last = now;
    }
    const double turn = glm::length(start) * h;
    const double precession = (1 - double(body.inertia.y) / double(body.inertia.x)) * start.y * h;
    const double allowed = (std::pow(turn, 3) + std::pow(precession, 3)) / 12;
    EXPECT_NEAR(angle, rate * steps * h, steps * (allowed + 10 * epsilon));
}

// A body touched by a solver moves with the solver's velocities and nothing else.
TEST_P(Flight, ATouchedBodyFollowsTheSolver) {
    const Body body = brick({0.1, 0.2, 0.3}, 2);
    SolverBody motion = moving(body, V{0}, V{0}, glm::dquat(1, 0, 0, 0));
    FreeFlight flight =
        begin_flight(motion, body, Vec3{0, Real(-10), 0}, Real(0.125), GetParam(), 3);
    motion.velocity = Vec3{Real(1), Real(0), Real(0)};
    RoundedOff rounded_off;
    move(motion, rounded_off, body, flight, Real(0.125));
    EXPECT_FALSE(flight.free);
    EXPECT_EQ(motion.position, Vec3(Real(0.125), Real(0), Real(0)));
    EXPECT_EQ(motion.rotation, identity_rotation);
}

TEST_P(Flight, KinematicBodiesKeepTheirVelocityAndStaticOnesTheirPlace) {
    Body body;
    body.kind = BodyKind::kinematic;
    body.alive = true;
    SolverBody motion;
    motion.velocity = Vec3{Real(1), Real(2), Real(3)};
    motion.angular_velocity = Vec3{Real(0), Real(0), Real(0.5)};
    RoundedOff rounded_off;
    for (int i = 0; i < 100; ++i) {
        FreeFlight flight =
            begin_flight(motion, body, Vec3{0, Real(-10), 0}, Real(0.125), GetParam(), 3);
        move(motion, rounded_off, body, flight, Real(0.125));
        end_flight(motion, body, flight, GetParam());
    }
    EXPECT_EQ(motion.velocity, Vec3(Real(1), Real(2), Real(3)));
    EXPECT_EQ(motion.angular_velocity, Vec3(Real(0), Real(0), Real(0.5)));
    EXPECT_EQ(motion.position, Vec3(Real(12.5), Real(25), Real(37.5))); // exact in binary
    const double turn = 2 * std::atan2(double(motion.rotation.z), double(motion.rotation.w));
    EXPECT_NEAR(std::remainder(turn - 6.25, 2 * pi), 0, 100 * 4 * epsilon);

    body.kind = BodyKind::static_body;
    motion = SolverBody{};
    FreeFlight flight = begin_flight(motion, body, Vec3{0, Real(-10), 0}, Real(1), GetParam(), 3);
    move(motion, rounded_off, body, flight, Real(1));
    end_flight(motion, body, flight, GetParam());
    EXPECT_EQ(motion.position, Vec3{Real(0)});
    EXPECT_EQ(motion.velocity, Vec3{Real(0)});
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
