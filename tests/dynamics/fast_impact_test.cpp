// Impacts of bodies that move far in a step for their size, against closed forms.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// A spinning ball on the ground: Newton's and Coulomb's laws at a single point.
TEST(SoftStepFastImpact, ASpinningBallBouncesByTheClosedForm) {
    Random random(7);
    for (const double speed : {2.0, 5.0, 10.0, 20.0, 50.0})
        for (int trial = 0; trial < 60; ++trial) {
            const double radius = 0.2, mass = 2, friction = 0.3 + 0.5 * (trial % 2);
            const double restitution = 0.5 * (trial % 3);
            const V v{0.8 * speed * random.next_in(-1, 1), -speed,
                      0.8 * speed * random.next_in(-1, 1)};
            const V spin = any_vector(random, 0.7 * speed / radius);
            World world("soft_step", weightless(settings_for("soft_step")));
            world.add_body(ground(friction, restitution));
            BodyDef def = dynamic_body(ball(radius), mass,
                                       V{0, radius + speed * random.next_in(0.02, 0.06), 0}, v);
            def.angular_velocity = narrow(spin);
            const BodyId id = world.add_body(with_material(def, friction, restitution));
            run(world, 12);

            const V arm{0, -radius, 0};
            V sliding = v + glm::cross(spin, arm);
            sliding.y = 0;
            const double normal = mass * speed * (1 + restitution);
            V rub = sliding * (-mass / 3.5); // m and I = 2/5 m r^2 against a force at the rim
            if (glm::length(rub) > friction * normal)
                rub *= friction * normal / glm::length(rub);
            V expected = v + rub / mass;
            expected.y = restitution * speed;
            const V expected_spin = spin + glm::cross(arm, rub) / (0.4 * mass * radius * radius);
            EXPECT_LE(glm::distance(velocity_of(world, id), expected), 0.01 * glm::length(v));
            EXPECT_LE(glm::distance(spin_of(world, id), expected_spin),
                      0.02 * glm::length(v) / radius);
        }
}

// One ball hits another at rest, off centre.
TEST(SoftStepFastImpact, BallsPartByTheClosedFormAndKeepAngularMomentum) {
    Random random(8);
    const double radius = 0.2;
    for (const double speed : {2.0, 20.0})
        for (int trial = 0; trial < 120; ++trial) {
            const double restitution = 0.5 * (trial % 3), friction = 0.5 * (trial % 2);
            const double off = 2 * radius * random.next_in(-0.9, 0.9);
            World world("soft_step", weightless(settings_for("soft_step")));
            const BodyId a = world.add_body(with_material(
                dynamic_body(ball(radius), 1, V{-1 - speed / 60 * random.next_in(0, 1), off, 0},
                             V{speed, 0, 0}),
                friction, restitution));
            const BodyId b = world.add_body(
                with_material(dynamic_body(ball(radius), 1, V{0}), friction, restitution));
            const V before = world.measure().angular_momentum;
            run(world, int(2.5 * 60 / speed) + 4);

            const double sine = off / (2 * radius);
            const V normal{std::sqrt(1 - sine * sine), -sine, 0};
            const V v{speed, 0, 0};
            const double struck = 0.5 * (1 + restitution) * glm::dot(v, normal);
            const V sliding = v - glm::dot(v, normal) * normal;
            V rub{0};
            if (glm::length(sliding) > 0)
                rub =
                    glm::normalize(sliding) * std::min(glm::length(sliding) / 7, friction * struck);
            const V given = struck * normal + rub;
            EXPECT_LE(glm::distance(velocity_of(world, b), given), 0.015 * speed);
            EXPECT_LE(glm::distance(velocity_of(world, a), v - given), 0.015 * speed);
            EXPECT_LE(glm::distance(world.measure().angular_momentum, before),
                      0.03 * speed * radius);
        }
}

// The angular momentum error of random bodies colliding in space: mean and worst, as shares of m v
// r.
struct Lost {
    double mean = 0;
    double worst = 0;
    int often = 0; // more than a twentieth
};
Lost angular_momentum_lost(double speed, double friction, double restitution, int trials = 200) {
    Lost lost;
    Random random(7);
    for (int trial = 0; trial < trials; ++trial) {
        World world("soft_step", weightless(settings_for("soft_step")));
        for (const double side : {-1.0, 1.0}) {
            BodyDef def = dynamic_body(any_shape(random), random.next_in(0.5, 5),
                                       V{0.6 * side, 0, 0} + any_vector(random, 0.15),
                                       V{-0.5 * speed * side, 0, 0});
            def.pose.rotation = narrow(any_rotation(random));
            def.angular_velocity = narrow(any_vector(random, speed));
            world.add_body(with_material(def, friction, restitution));
        }
        const V before = world.measure().angular_momentum;
        run(world, 20 + int(180 / speed));
        const double off =
            glm::distance(world.measure().angular_momentum, before) / (2 * speed * 0.3);
        lost.mean += off / trials;
        lost.worst = std::max(lost.worst, off);
        lost.often += off > 0.05 ? 1 : 0;
    }
    return lost;
}

// Inelastic, frictionless bodies slide around each other's edges after the impact.
bool slides_on(double speed, double friction, double restitution) {
    return restitution == 0 && friction == 0 && speed > 1;
}

// For all shapes: impacts are applied where the contact points of both bodies coincide
// (impact.cpp). With lever arms and normals from the start of the step they lose some per cent, and
// half at worst.
TEST(SoftStepFastImpact, BodiesOfAnyShapeKeepAngularMomentum) {
    for (const double speed : {1.0, 5.0, 20.0})
        for (const double friction : {0.0, 0.5})
            for (const double restitution : {0.0, 0.5, 1.0}) {
                if (slides_on(speed, friction, restitution))
                    continue;
                const Lost lost = angular_momentum_lost(speed, friction, restitution);
                EXPECT_LT(lost.mean, 2e-3) << speed << ' ' << friction << ' ' << restitution;
                EXPECT_LT(lost.worst, 0.05) << speed << ' ' << friction << ' ' << restitution;
            }
}

// Known failing: bodies that slide on lose more, at 20 m/s a quarter at worst.
TEST(SoftStepFastImpact, PlasticBlowsLoseSomeAngularMomentum) {
    for (const double speed : {5.0, 20.0}) {
        const Lost lost = angular_momentum_lost(speed, 0, 0, 3000);
        EXPECT_GT(lost.mean, 2e-3) << speed;
        EXPECT_LT(lost.mean, 5e-3) << speed;
        EXPECT_LT(lost.worst, speed < 10 ? 0.1 : 0.3) << speed;
        EXPECT_LE(lost.often, 10) << speed;
    }
}

// The relative energy gain of a gas of 36 bodies between six walls in ten seconds.
double energy_gained(const Shape &shape, std::uint32_t seed) {
    Random random(seed);
    World world("soft_step", weightless(settings_for("soft_step")));
    for (int side = 0; side < 6; ++side) {
        V normal{0};
        normal[side / 2] = side % 2 == 0 ? 1 : -1;
        world.add_body(with_material(static_body(HalfSpace{narrow(normal), Real(-2)}), 0, 1));
    }
    for (int i = 0; i < 36; ++i) {
        const V at{-1.2 + 0.8 * (i % 4), -0.8 + 0.8 * (i / 4 % 3), -0.8 + 0.8 * (i / 12)};
        BodyDef def = dynamic_body(shape, 1, at, any_vector(random, 3));
        def.angular_velocity = narrow(any_vector(random, 3));
        world.add_body(with_material(def, 0, 1));
    }
    const double before = world.measure().energy();
    run(world, 600);
    return world.measure().energy() / before - 1;
}

TEST(SoftStepGas, ElasticBodiesKeepTheirEnergy) {
    const std::vector<Shape> shapes{block(V{0.15, 0.1, 0.2}), ball(0.15),
                                    upright_capsule(0.15, 0.1)};
    for (const Shape &shape : shapes) {
        std::vector<double> gains;
        for (std::uint32_t seed = 8; seed < 16; ++seed) {
            gains.push_back(std::abs(energy_gained(shape, seed)));
            // In single precision one of 120 capsule gases loses this much, in a single impact: a
            // capsule spinning at 73 rad/s hits another.
            EXPECT_LT(gains.back(), is_double ? 1e-3 : 3e-3) << shape.index() << ", " << seed;
        }
        std::ranges::sort(gains);
        EXPECT_LT(gains[6], 1e-4) << shape.index();
    }
}

// A stick hit at one end comes down on the other, mostly within the same step, however slender. A
// thin one that spins by several radians a step loses up to a tenth in an impact that is not
// foreseen: of 100, up to twelve do, one of them more.
TEST(SoftStepGas, ElasticSticksBounceOnAndOn) {
    const std::vector<Shape> shapes{
        block(V{0.25, 0.06, 0.06}), block(V{0.25, 0.02, 0.02}), block(V{0.25, 0.01, 0.01}),
        upright_capsule(0.25, 0.02),
        Cylinder{narrow(V{0, -0.25, 0}), narrow(V{0, 0.25, 0}), Real(0.02)}};
    for (const Shape &shape : shapes) {
        const bool is_thin = &shape == &shapes[1] || &shape == &shapes[2];
        int kept = 0, kept_of_20 = 0, worse = 0;
        for (std::uint32_t seed = 0; seed < 100; ++seed) {
            Random random(seed);
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0, 1));
            BodyDef stick = with_material(dynamic_body(shape, 1, V{0, 1, 0}), 0, 1);
            stick.pose.rotation = narrow(any_rotation(random));
            stick.angular_velocity = narrow(any_vector(random, 1));
            world.add_body(stick);
            const double before = world.energy();
            run(world, 600);
            const double gain = world.energy() / before - 1;
            if (seed < 20) {
                EXPECT_GT(gain, -0.1) << shape.index() << ", " << seed;
            }
            EXPECT_LT(gain, 1e-3) << shape.index() << ", " << seed;
            kept += gain > -1e-3 ? 1 : 0;
            kept_of_20 += gain > -1e-3 && seed < 20 ? 1 : 0;
            worse += gain > -0.15 ? 0 : 1;
        }
        EXPECT_GE(kept_of_20, 19) << shape.index();
        EXPECT_GE(kept, is_thin ? 88 : 96) << shape.index();
        EXPECT_LE(worse, is_thin ? 1 : 0) << shape.index();
    }
}

// The ends of a short capsule strike in turns within a step. With arms held for the step one of 3
// mm that fell 3 cm gained two thirds of its energy in 30 s, one of 6 mm in a room of 20 cm two and
// a half times what it had above the floor.
TEST(SoftStepGas, SmallCapsulesBounceOn) {
    struct Room {
        double radius, share; // of the capsule, and its half length as a share of that
        double half;          // of the room; 0: a floor
        int least_kept;       // how many of ten keep all but a fiftieth of the energy
    };
    for (const Room &room : {Room{0.003, 1, 0, 9}, Room{0.006, 1, 0.1, 5}, Room{0.006, 0.3, 0.1, 9},
                             Room{0.025, 1, 0.4, 9}, Room{0.025, 0.3, 0.4, 9}}) {
        int kept = 0;
        for (std::uint32_t seed = 0; seed < 10; ++seed) {
            Random random(seed);
            World world("soft_step", settings_for("soft_step"));
            if (room.half > 0)
                for (int side = 0; side < 6; ++side) {
                    V normal{0};
                    normal[side / 2] = side % 2 == 0 ? 1 : -1;
                    world.add_body(with_material(
                        static_body(HalfSpace{narrow(normal), Real(-room.half)}), 0, 1));
                }
            else
                world.add_body(ground(0, 1));
            const double height = room.half > 0 ? 0 : 10 * room.radius;
            const double speed = std::sqrt(0.8 * gravity * room.half);
            BodyDef def =
                with_material(dynamic_body(upright_capsule(room.share * room.radius, room.radius),
                                           1, V{0, height, 0}, any_vector(random, speed)),
                              0, 1);
            def.pose.rotation = narrow(any_rotation(random));
            def.angular_velocity = narrow(any_vector(random, 1));
            world.add_body(def);
            // What it had above the floor.
            const double scale = world.energy() + gravity * room.half;
            const double before = world.energy();
            double most = before;
            for (int i = 0; i < 1200; ++i) {
                run(world, 1);
                most = std::max(most, world.energy());
            }
            EXPECT_LT(most - before, 0.01 * scale)
                << room.radius << ' ' << room.share << ' ' << seed;
            EXPECT_GT(world.energy() - before, -0.1 * scale)
                << room.radius << ' ' << room.share << ' ' << seed;
            kept += world.energy() - before > -0.02 * scale ? 1 : 0;
        }
        EXPECT_GE(kept, room.least_kept) << room.radius << ' ' << room.share;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
