// Collisions of bodies, without gravity, and bounces in it.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Impacts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Impacts, testing::ValuesIn(impact_methods()), name_of);

// TGS Soft bounces once, at the end of a step, and so from a place up to v dt away.
TEST(TgsSoft, BouncesToTheSquareOfItsRestitution) {
    for (const double restitution : {0.5, 0.8}) {
        World world("tgs_soft", settings_for("tgs_soft"));
        world.add_body(ground(0, restitution));
        const BodyId id =
            world.add_body(with_material(dynamic_body(ball(0.1), 1, V{0, 2.1, 0}), 0, restitution));
        double apex = 0;
        bool has_hit = false;
        for (int i = 0; i < 120 && !(has_hit && velocity_of(world, id).y < 0); ++i) {
            world.step(nullptr);
            has_hit = has_hit || world.report().impacts > 0;
            apex = has_hit ? std::max(apex, position_of(world, id).y - 0.1) : 0;
        }
        const double speed = std::sqrt(2 * gravity * 2);
        EXPECT_NEAR(apex, 2 * restitution * restitution, speed / 60);
    }
}

// A ball dropped on the ground gets one impact, whose impulse accounts for its whole momentum
// change in that step except for gravity. By Newton's law it is m (1 + e) v.
class Bounce : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Bounce, testing::ValuesIn(contact_methods()), name_of);

TEST_P(Bounce, IsRecordedWithItsImpulse) {
    const double mass = 2, restitution = 0.5, height = 1;
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0, restitution));
    const BodyId id = world.add_body(
        with_material(dynamic_body(ball(0.1), mass, V{0, 0.1 + height, 0}), 0, restitution));
    const double dt = world.settings().dt;
    const double speed = std::sqrt(2 * gravity * height);
    // A step early or late is g dt of the speed. What looks ahead by whole steps strikes it as far
    // above the ground as it goes in one, with the energy that it has there.
    const double early = world.settings().impact_lookahead * speed * dt;
    const bool looks_far = GetParam() == "sequential_impulses" || GetParam() == "nncg";
    const auto lost_by = [&](double fast) {
        return fast - std::sqrt(fast * fast - 2 * gravity * early);
    };
    const double error = mass * (looks_far ? lost_by(speed) + lost_by(restitution * speed)
                                           : (1 + restitution) * gravity * dt);
    int impacts = 0;
    for (int i = 0; i < 40; ++i) {
        const double before = velocity_of(world, id).y;
        world.step(nullptr);
        EXPECT_EQ(world.report().impacts, world.impacts().size());
        for (const auto &impact : world.impacts()) {
            ++impacts;
            const double change = velocity_of(world, id).y - before + gravity * dt;
            // AVBD's poses are not where its forces alone would have them.
            EXPECT_NEAR(double(impact.impulse), mass * change,
                        (GetParam() == "avbd" ? 0.02 : 1e-4) * mass * change);
            EXPECT_NEAR(double(impact.impulse), mass * (1 + restitution) * speed, error);
            EXPECT_EQ(impact.key.a, 0u);
            EXPECT_EQ(impact.key.b, id.index);
            EXPECT_NEAR(double(glm::distance(impact.normal, narrow(V{0, 1, 0}))), 0, 1e-6);
            EXPECT_NEAR(position_of(world, id).x, double(impact.position.x), 1e-6);
            EXPECT_LT(std::abs(double(impact.position.y)), 1.1 * speed * dt);
        }
    }
    EXPECT_EQ(impacts, 1);
}

// Hit at several points, a body reports one impact. Known failing: naive impulses spread the
// impulse over the points, and have not applied all of it when their passes end, so that the body
// is hit again.
TEST_P(Bounce, OfABoxIsOneForAllItsPoints) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0, 0.5));
    const BodyId id =
        world.add_body(with_material(dynamic_body(block(V{0.2}), 1, V{0, 0.21, 0}), 0, 0.5));
    world.set_motion(id, {narrow(V{0, 0.21, 0}), identity_rotation}, narrow(V{0, -4, 0}),
                     Vec3{Real(0)});
    const double dt = world.settings().dt;
    std::size_t impacts = 0;
    double first = 0;
    for (int i = 0; i < 3; ++i) {
        const double before = velocity_of(world, id).y;
        world.step(nullptr);
        EXPECT_EQ(world.report().impacts, world.impacts().size());
        for (const auto &impact : world.impacts()) {
            const double change = velocity_of(world, id).y - before + gravity * dt;
            EXPECT_NEAR(double(impact.impulse), change, (GetParam() == "avbd" ? 0.02 : 1e-4) * 6);
            if (++impacts == 1)
                first = double(impact.impulse);
        }
    }
    if (GetParam() == "naive_impulses") {
        EXPECT_EQ(impacts, 2u);
        EXPECT_LT(first, 0.7 * 1.5 * 4);
    } else {
        EXPECT_EQ(impacts, 1u);
        EXPECT_NEAR(first, 1.5 * 4, 1.5 * gravity * dt);
    }
}

BodyDef any_body(Random &random, const V &position) {
    const double mass = random.next_in(0.5, 5);
    BodyDef def = dynamic_body(any_shape(random), mass, position);
    def.pose.rotation = glm::normalize(narrow(any_rotation(random)));
    def.angular_velocity = narrow(any_vector(random, 3));
    return def;
}

struct Collision {
    Measures before;
    Measures after;
    double momentum_scale = 0;
    double spin_scale = 0;
    double worst_gain = 0; // of energy in one step, relative to the initial energy
    bool met = false;
};

Collision collide_two(const std::string &method, Random &random, double friction,
                      double restitution, int substeps, int refinement = 1) {
    StepSettings settings = weightless(settings_for(method));
    settings.substeps = substeps;
    settings.dt /= refinement;
    World world(method, settings);
    BodyDef a = any_body(random, V{-1, 0, 0});
    BodyDef b = any_body(random, V{1, random.next_in(-0.2, 0.2), random.next_in(-0.2, 0.2)});
    a.velocity = narrow(V{2, 0, 0} + any_vector(random, 0.3));
    b.velocity = narrow(V{-2, 0, 0} + any_vector(random, 0.3));
    for (BodyDef *def : {&a, &b})
        *def = with_material(*def, friction, restitution);
    world.add_body(a);
    world.add_body(b);
    Collision c;
    c.before = world.measure();
    for (int i = 0; i < 60 * refinement; ++i) {
        const double energy = world.measure().energy();
        world.step(nullptr);
        c.worst_gain =
            std::max(c.worst_gain, (world.measure().energy() - energy) / c.before.energy());
        for (const Contact &contact : world.contacts())
            for (int k = 0; k < contact.manifold.count; ++k)
                c.met = c.met || contact.impulses[std::size_t(k)].x > 0;
        c.met = c.met || world.report().impacts > 0;
    }
    c.after = world.measure();
    c.momentum_scale = 2.3 * double(*a.mass + *b.mass);
    c.spin_scale = c.momentum_scale * 1.5;
    return c;
}

// Equal and opposite impulses: momentum is kept to the rounding of each impulse's application, of
// which a solver makes about 4 points x 30 passes for each substep of a touch that lasts a few.
TEST_P(Impacts, KeepsLinearMomentum) {
    Random random(1);
    int met = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const double restitution = 0.25 * random.next_index(5);
        const double friction = 0.25 * random.next_index(4);
        const Collision c = collide_two(GetParam(), random, friction, restitution, 4);
        met += c.met ? 1 : 0;
        EXPECT_LE(glm::distance(c.after.linear_momentum, c.before.linear_momentum),
                  500 * epsilon * c.momentum_scale);
    }
    EXPECT_GT(met, 150); // they do collide
}

// Balls that collide off centre with friction. With one substep both lever arms of an impulse end
// in the same point, so angular momentum is conserved to rounding as well.
TEST_P(Impacts, BallsKeepAngularMomentumInOneSubstep) {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        StepSettings settings = weightless(settings_for(GetParam()));
        settings.substeps = 1;
        World world(GetParam(), settings);
        const double restitution = 0.25 * random.next_index(5);
        const double friction = 0.25 * random.next_index(4);
        for (const double side : {-1.0, 1.0}) {
            BodyDef def =
                dynamic_body(ball(random.next_in(0.2, 0.4)), random.next_in(0.5, 5),
                             V{side, random.next_in(-0.1, 0.1), random.next_in(-0.1, 0.1)},
                             V{-2 * side, 0, 0} + any_vector(random, 0.3));
            def.angular_velocity = narrow(any_vector(random, 5));
            world.add_body(with_material(def, friction, restitution));
        }
        const Measures before = world.measure();
        run(world, 60);
        const V lost = world.measure().angular_momentum - before.angular_momentum;
        // A few roundings a step of m x v: 10 kg, 3 m, 3 m/s. A known failing of soft_step: its
        // relaxing pass keeps the arms of before the move, so an impulse of at most p = 23 N s
        // acts at points that are up to 4.6 m/s / 60 apart.
        const double stale = GetParam() == "soft_step" ? 23 * 4.6 / 60 : 0;
        EXPECT_LE(glm::length(lost), stale + 4 * 60 * epsilon * 90);
    }
}

// Known failings of sequential impulses and NNCG, both of first order in the substep: with several
// substeps the arms are those of the start of the step; and in a substep in which a solver touched
// it, a body with unequal inertias turns under the gyroscopic torque of the spin that it had
// before. The mean loss of the same 200 plastic collisions falls in proportion to the substep,
// whichever way that is made smaller. Soft step's is small at any, for it lets such blows come
// where they touch.
TEST_P(Impacts, AngularMomentumConvergesWithTheSubstep) {
    std::vector<double> losses;
    for (const int refinement : {1, 4, 16}) {
        Random random(3);
        double sum = 0;
        for (int trial = 0; trial < 200; ++trial) {
            const Collision c = collide_two(GetParam(), random, 0.5, 0, 1, refinement);
            sum +=
                glm::distance(c.after.angular_momentum, c.before.angular_momentum) / c.spin_scale;
        }
        losses.push_back(sum / 200);
    }
    if (GetParam() == "soft_step") {
        EXPECT_LT(losses[0], 1e-4);
        EXPECT_LT(losses[1], 5e-5);
        EXPECT_LT(losses[2], 3e-5);
        return;
    }
    EXPECT_LT(losses[0], 0.01);
    EXPECT_GT(losses[0], 1e-4);
    EXPECT_LT(losses[1], losses[0] / 3);
    EXPECT_LT(losses[2], losses[1] / 3);
}

// Newton's law cannot add energy for restitution up to 1, and balls obey that.
TEST_P(Impacts, BallsNeverGainEnergy) {
    Random random(4);
    for (int trial = 0; trial < 300; ++trial) {
        const double restitution = 0.25 * random.next_index(5);
        const double friction = 0.25 * random.next_index(5);
        World world(GetParam(), weightless(settings_for(GetParam())));
        for (const double side : {-1.0, 1.0}) {
            BodyDef def =
                dynamic_body(ball(random.next_in(0.2, 0.4)), random.next_in(0.5, 5),
                             V{side, random.next_in(-0.1, 0.1), random.next_in(-0.1, 0.1)},
                             V{-2 * side, 0, 0} + any_vector(random, 0.3));
            def.angular_velocity = narrow(any_vector(random, 5));
            world.add_body(with_material(def, friction, restitution));
        }
        for (int i = 0; i < 60; ++i) {
            const double before = world.energy();
            world.step(nullptr);
            EXPECT_LE(world.energy() - before, 40 * epsilon * world.energy())
                << "restitution " << restitution << " friction " << friction;
        }
    }
}

// Known failings with bricks and capsules that tumble: a body that a solver touched keeps its world
// spin while it turns, which changes its energy by the order of w h; and the points of one manifold
// share an impact by a limited number of passes, which shows where it is elastic and smooth. The
// worst of 300 collisions each, as measured: 0.9 % of the energy in one such collision and 0.015 %
// otherwise by soft_step; 1.3 % and 0.3 % by sequential impulses, with its longer substep.
TEST_P(Impacts, TumblingBodiesGainLittleEnergy) {
    const bool soft = GetParam() == "soft_step";
    for (const double friction : {0.0, 0.5})
        for (const double restitution : {0.0, 0.5, 1.0}) {
            Random random(5);
            double worst = 0;
            int gains = 0; // of more than 2e-4
            for (int trial = 0; trial < 300; ++trial) {
                const int substeps = settings_for(GetParam()).substeps;
                const Collision c =
                    collide_two(GetParam(), random, friction, restitution, substeps);
                worst = std::max(worst, c.worst_gain);
                gains += c.worst_gain > 2e-4 ? 1 : 0;
            }
            const bool elastic = restitution == 1 && friction == 0;
            const double bound = soft ? (elastic ? 0.01 : 2e-4) : (elastic ? 0.02 : 5e-3);
            EXPECT_LE(worst, bound) << friction << ' ' << restitution;
            EXPECT_LE(gains, soft ? 2 : 80) << friction << ' ' << restitution;
        }
}

// Two balls without friction: along the line of centres the velocities after are
// (m1 u1 + m2 u2 -+ m e (u1 - u2)) / (m1 + m2), across they stay. The line of centres at contact is
// known only to v h, so the balls are laid just apart and one substep is taken.
TEST_P(Impacts, BallsInClosedForm) {
    Random random(6);
    for (int trial = 0; trial < 200; ++trial) {
        const double m1 = random.next_in(0.5, 20), m2 = random.next_in(0.5, 20);
        const double restitution = random.next_in(0.05, 1);
        const V n = any_rotation(random) * V{1, 0, 0};
        const V u1 = 2.0 * n + any_vector(random, 1);
        const V u2 = any_vector(random, 0.5);
        StepSettings settings = weightless(settings_for(GetParam()));
        settings.substeps = 1;
        World world(GetParam(), settings);
        const BodyId a =
            world.add_body(with_material(dynamic_body(ball(0.2), m1, V{0}, u1), 0, restitution));
        const BodyId b = world.add_body(
            with_material(dynamic_body(ball(0.3), m2, 0.50001 * n, u2), 0, restitution));
        world.step(nullptr);
        const double s1 = glm::dot(u1, n), s2 = glm::dot(u2, n);
        const double common = (m1 * s1 + m2 * s2) / (m1 + m2);
        const double part = restitution * (s1 - s2) / (m1 + m2);
        const V v1 = u1 + (common - m2 * part - s1) * n;
        const V v2 = u2 + (common + m1 * part - s2) * n;
        // The normal is a difference of centres half a metre apart: epsilon of a unit, and the
        // light ball's velocity changes by up to 8 m/s.
        EXPECT_LE(glm::distance(velocity_of(world, a), v1), 100 * epsilon);
        EXPECT_LE(glm::distance(velocity_of(world, b), v2), 100 * epsilon);
        EXPECT_LE(glm::length(spin_of(world, a)), 400 * epsilon); // 2.5 dv / r times as much
    }
}

// Elastic, equal masses, met off centre in full flight: the two fly apart at a right angle whatever
// the line of centres was.
TEST_P(Impacts, EqualBallsPartAtARightAngle) {
    for (const double offset : {0.05, 0.1, 0.2, 0.3}) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        const BodyId a = world.add_body(
            with_material(dynamic_body(ball(0.2), 1, V{-1, offset, 0}, V{3, 0, 0}), 0, 1));
        const BodyId b = world.add_body(with_material(dynamic_body(ball(0.2), 1, V{0}), 0, 1));
        run(world, 60);
        const V va = velocity_of(world, a), vb = velocity_of(world, b);
        EXPECT_GT(glm::length(vb), 1);
        EXPECT_NEAR(glm::dot(va, vb), 0, 200 * epsilon * 9);
        EXPECT_NEAR(glm::dot(va, va) + glm::dot(vb, vb), 9, 200 * epsilon * 9);
        // The line of centres from where they met: as it was at the start of the step, when the
        // manifold was made.
        const double sine = offset / 0.4;
        EXPECT_NEAR(std::atan2(-vb.y, vb.x), std::asin(sine),
                    3.0 / 60 / 0.4 / std::sqrt(1 - sine * sine));
    }
}

// n balls in, n balls out, the rest stand still: five that touch, and no gravity.
TEST_P(Impacts, CradleHandsOn) {
    for (int in = 1; in <= 4; ++in) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        std::vector<BodyId> balls;
        for (int i = 0; i < 5; ++i) {
            const bool moves = i < in;
            const double gap = moves ? 0.125 : 0;
            balls.push_back(world.add_body(with_material(
                dynamic_body(ball(0.125), 1, V{0.25 * i - gap, 0, 0}, V{moves ? 1.0 : 0.0, 0, 0}),
                0, 1)));
        }
        run(world, 60);
        EXPECT_EQ(world.report().unresolved_impacts, 0U);
        for (int i = 0; i < 5; ++i) {
            const V expected{i >= 5 - in ? 1.0 : 0.0, 0, 0};
            EXPECT_LE(glm::distance(velocity_of(world, balls[std::size_t(i)]), expected),
                      100 * epsilon)
                << in << " in, ball " << i;
        }
    }
}

// Dropped from h0, a ball comes back to e^2 h0, whatever the step: the impact law accounts for the
// gap. Read off as energy, which stands for the apex between two steps.
TEST_P(Impacts, BounceHeights) {
    for (const double restitution : {0.3, 0.5, 0.8, 1.0})
        for (const double dt : {1.0 / 60, 1.0 / 50, 1.0 / 90}) {
            StepSettings settings = settings_for(GetParam());
            settings.dt = dt;
            World world(GetParam(), settings);
            world.add_body(ground(0, restitution));
            const BodyId id =
                world.add_body(with_material(dynamic_body(ball(0.1), 1, V{0, 1.1, 0}), 0, 0));
            for (int bounce = 1; bounce <= 3; ++bounce) {
                // A flight must be longer than a few steps to be seen from one step to the next.
                const double flight = 2 * std::pow(restitution, bounce) * std::sqrt(2 / gravity);
                // And a known failing: an impact is dealt with where the body would strike within
                // the substep, and a rebound that does not come back up to there is given up.
                const double strike = std::pow(restitution, bounce - 1) * std::sqrt(2 * gravity);
                const double h = substep_of(world);
                if (flight < 4 * dt ||
                    std::pow(restitution, 2 * bounce) < 1.2 * h * (strike + h * gravity))
                    break;
                int steps = 0; // a fall takes half a second
                while (velocity_of(world, id).y > 0 && ++steps < 200)
                    world.step(nullptr);
                while (velocity_of(world, id).y <= 0 && ++steps < 200)
                    world.step(nullptr);
                ASSERT_LT(steps, 200) << restitution << " bounce " << bounce;
                const V v = velocity_of(world, id);
                const double apex = position_of(world, id).y - 0.1 + v.y * v.y / (2 * gravity);
                // Roundings of 200 substeps at 5 m/s; the gap's account is exact.
                EXPECT_NEAR(apex, std::pow(restitution, 2 * bounce), 400 * epsilon * 5)
                    << "bounce " << bounce << " dt " << dt;
            }
        }
}

// A box on its flat side bounces like a ball and does not begin to turn.
TEST_P(Impacts, ABoxBouncesFlat) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_body(ground(0.5, 1));
    const BodyId id = world.add_body(
        with_material(dynamic_body(block(V{0.2, 0.1, 0.3}), 1, V{0, 1.1, 0}), 0.5, 1));
    const double before = world.measure().energy();
    run(world, 120);
    EXPECT_NEAR(world.measure().energy(), before, 1e-3 * before);
    EXPECT_LE(glm::length(spin_of(world, id)), 1e-3);
}

// A body that lands level on several supports leaves level: legs of one body on the ground, and a
// board on posts that are separate bodies. Solved leg by leg, the first would turn it, it would hit
// the next one faster, and lose most of its rebound.
TEST_P(Impacts, WhatFallsOnSeveralSupportsLeavesAsItCame) {
    for (const double restitution : {0.5, 1.0})
        for (const bool has_legs : {true, false})
            for (const double yaw : {0.0, 0.7, pi / 2}) {
                World world(GetParam(), settings_for(GetParam()));
                const auto turn = glm::angleAxis(yaw, V{0, 1, 0});
                BodyDef board =
                    dynamic_body(block(V{0.6, 0.05, 0.4}), 5, V{0, 1.05 + (has_legs ? 0.5 : 0), 0});
                board.pose.rotation = narrow(turn);
                if (has_legs)
                    world.add_body(ground(0.5, restitution));
                for (const double x : {-0.5, 0.5})
                    for (const double z : {-0.3, 0.3}) {
                        Box leg = block(V{0.05, 0.25, 0.05});
                        leg.center = narrow(V{x, -0.3, z});
                        if (has_legs)
                            board.colliders.emplace_back().shape = leg;
                        else
                            world.add_body(with_material(
                                static_body(block(V{0.05, 0.25, 0.05}), turn * V{x, -0.25, z}), 0.5,
                                restitution));
                    }
                const BodyId id = world.add_body(with_material(board, 0.5, restitution));
                const double start = position_of(world, id).y;
                run(world, 30); // it falls for 27
                const double fastest = restitution * std::sqrt(2 * gravity);
                const V v = velocity_of(world, id);
                const double height = position_of(world, id).y - (start - 1);
                EXPECT_NEAR(std::sqrt(v.y * v.y + 2 * gravity * height), fastest, 1e-3 * fastest)
                    << restitution << ' ' << has_legs << ' ' << yaw;
                EXPECT_LE(glm::length(spin_of(world, id)), 1e-3);
                EXPECT_LE(std::hypot(v.x, v.z), 1e-3);
            }
}

// A ball that strikes k others at once, alike around its way: an impulse p for each, along lines of
// centres at an angle to it of cosine c, so p (1 + k c^2) = (1 + e) m v c.
TEST_P(Impacts, ABallStrikesSeveralAtOnce) {
    for (const int others : {2, 3})
        for (const double restitution : {0.5, 1.0}) {
            StepSettings settings = weightless(settings_for(GetParam()));
            settings.substeps = 1;
            World world(GetParam(), settings);
            const double sine = others == 2 ? 0.5 : 1 / std::sqrt(3.0); // they touch each other
            const double cosine = std::sqrt(1 - sine * sine);
            const double speed = 2;
            const BodyId first = world.add_body(
                with_material(dynamic_body(ball(0.25), 1, V{0}, V{speed, 0, 0}), 0, restitution));
            std::vector<BodyId> struck;
            for (int k = 0; k < others; ++k) {
                const double around = 2 * pi * k / others;
                const V way{cosine, sine * std::cos(around), sine * std::sin(around)};
                struck.push_back(world.add_body(
                    with_material(dynamic_body(ball(0.25), 1, 0.50001 * way), 0, restitution)));
            }
            world.step(nullptr);
            const double p = (1 + restitution) * speed * cosine / (1 + others * cosine * cosine);
            EXPECT_LE(
                glm::distance(velocity_of(world, first), V{speed - others * p * cosine, 0, 0}),
                200 * epsilon);
            for (const BodyId id : struck) {
                const V way = glm::normalize(position_of(world, id));
                EXPECT_NEAR(glm::length(velocity_of(world, id)), p, 200 * epsilon);
                EXPECT_NEAR(velocity_of(world, id).x, p * cosine, 200 * epsilon) << way.x;
            }
        }
}

// A dozen bodies that meet in one place almost simultaneously: whatever they do, they create no
// energy.
TEST_P(Impacts, AHuddleGainsNothing) {
    Random random(11);
    for (int trial = 0; trial < 60; ++trial) {
        const double friction = 0.25 * random.next_index(3);
        World world(GetParam(), weightless(settings_for(GetParam())));
        for (int i = 0; i < 12; ++i) {
            const V from = any_rotation(random) * V{random.next_in(0.8, 1.6), 0, 0};
            const double radius = random.next_in(0.1, 0.2);
            BodyDef def = dynamic_body(ball(radius), random.next_in(0.5, 5), from,
                                       -2.0 * from + any_vector(random, 0.2));
            world.add_body(with_material(def, friction, 0.25 * random.next_index(5)));
        }
        const Measures before = world.measure();
        std::size_t impacts = 0;
        for (int i = 0; i < 60; ++i) {
            const double energy = world.energy();
            world.step(nullptr);
            impacts += world.impacts().size();
            EXPECT_LE(world.energy() - energy, 100 * epsilon * before.energy()) << trial;
        }
        EXPECT_GT(impacts, 6u);
        EXPECT_LE(glm::distance(world.measure().linear_momentum, before.linear_momentum),
                  2000 * epsilon * 100);
    }
}

// What lands and stays is recorded once, with its momentum; what rests is not, nor what slides.
TEST_P(Bounce, WithoutRestitutionIsABlow) {
    const double mass = 2, height = 1;
    const double speed = std::sqrt(2 * gravity * height);
    for (const bool is_ball : {true, false}) {
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(ground(0.5, 0));
        const Shape shape = is_ball ? Shape{ball(0.1)} : Shape{block(V{0.1})};
        world.add_body(dynamic_body(shape, mass, V{0, 0.1 + height, 0}));
        world.add_body(dynamic_body(block(V{0.2}), 1, V{3, 0.2, 0}, V{2, 0, 0}));
        std::vector<double> blows;
        for (int i = 0; i < 120; ++i) {
            world.step(nullptr);
            EXPECT_EQ(world.report().impacts, world.impacts().size());
            for (const Impact &impact : world.impacts()) {
                EXPECT_EQ(impact.key.b, 1U);
                EXPECT_NEAR(std::abs(double(impact.normal.y)), 1, 1e-3);
                EXPECT_NEAR(impact.position.y, 0, 0.1);
                blows.push_back(double(impact.impulse));
            }
        }
        ASSERT_GE(blows.size(), 1U) << is_ball;
        double sum = 0;
        for (const double blow : blows)
            sum += blow;
        // These take more than one step to stop it, and a blow is of one.
        const bool is_slow =
            GetParam() == "xpbd" || GetParam() == "avbd" || GetParam() == "naive_impulses";
        EXPECT_LT(sum, 1.2 * mass * speed) << is_ball;
        EXPECT_GT(sum, (is_slow ? 0.2 : 0.8) * mass * speed) << is_ball;
    }
}

// Below the threshold there is no bounce, so that things come to rest.
TEST_P(Impacts, SlowImpactsDoNotBounce) {
    World world(GetParam(), weightless(settings_for(GetParam())));
    world.add_body(ground(0, 1));
    const BodyId id = world.add_body(
        with_material(dynamic_body(ball(0.1), 1, V{0, 0.101, 0}, V{0, -0.019, 0}), 0, 1));
    run(world, 60);
    EXPECT_LE(velocity_of(world, id).y, 1e-3);
    EXPECT_GE(position_of(world, id).y, 0.1 - 1e-3);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
