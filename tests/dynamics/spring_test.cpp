// Springs between particles, bodies and the world, against their closed forms.
#include "engine/core/check.h"
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

// A ball placed in equilibrium on a rope of springs, each stretched by g / k times the mass below
// it, stays there: soft or stiff, damped or not, light or heavy, at any step.
TEST(SoftStepSprings, HoldWhatHangsWhereTheyShould) {
    struct Rope {
        double stiffness, damping, particle, ball, dt;
    };
    constexpr int links = 16;
    for (const Rope &rope :
         {Rope{400, 20, 0.05, 1, 1.0 / 120}, Rope{400, 0, 0.05, 1, 1.0 / 60},
          Rope{400, 200, 0.05, 1, 1.0 / 60}, Rope{100, 5, 0.01, 0.5, 1.0 / 60},
          Rope{5000, 20, 0.05, 10, 1.0 / 60}, Rope{40000, 1, 0.05, 100, 1.0 / 60},
          Rope{400, 20, 0.05, 1, 1.0 / 30}}) {
        StepSettings settings = settings_for("soft_step");
        settings.dt = rope.dt;
        World world("soft_step", settings);
        double y = 0;
        SpringEnd above = of_world(V{0});
        for (int i = 0; i < links; ++i) {
            const int below = links - 1 - i;
            const double load = (below * rope.particle + rope.ball) * gravity;
            y -= 0.1 + load / rope.stiffness;
            SpringEnd next;
            if (below == 0)
                next = of_body(world.add_body(dynamic_body(ball(0.1), rope.ball, V{0, y - 0.1, 0})),
                               V{0, 0.1, 0});
            else
                next = of_particle(world.add_particle(particle_at(V{0, y, 0}, rope.particle)));
            world.add_spring(spring(above, next, 0.1, rope.stiffness, rope.damping));
            above = next;
        }
        const double longer = -y - 0.1 * links, at = y - 0.1;
        double off = 0;
        for (int i = 0; i < int(4 / rope.dt); ++i) {
            run(world, 1);
            off = std::max(off, std::abs(position_of(world, world.body_id(0)).y - at));
        }
        EXPECT_LT(off, 1e-3 * longer + 1e-5)
            << rope.stiffness << ' ' << rope.damping << ' ' << rope.ball << ' ' << rope.dt;
    }
}

// Undamped springs between particles, stretched 1.1 to 10 times or slack, thrown about: a pair, a
// row from a pin or free, a net within a frame; swinging at 0.2 to 60 rad a step.
class StretchedSprings : public testing::TestWithParam<std::string> {
  protected:
    static World thrown(Random &random, double turn, const std::string &shape) {
        const auto spread = [&](double low, double high) {
            return low * std::pow(high / low, random.next_in(0, 1));
        };
        StepSettings settings = weightless(settings_for("soft_step"));
        settings.dt = 1 / (random.next_in(0, 1) < 0.5 ? 30.0 : 240.0);
        World world("soft_step", settings);
        const double mass = spread(0.01, 10), rate = turn / settings.dt;
        const double length = spread(0.02, 1);
        const double at = length * (random.next_in(0, 1) < 0.2 ? 0.5 : spread(1.1, 10));
        const auto add = [&](const V &position, bool pinned) {
            ParticleDef def = particle_at(position, mass, pinned);
            if (!pinned)
                def.velocity = narrow(any_vector(random, 0.5 * at * rate));
            return of_particle(world.add_particle(def));
        };
        const auto tie = [&](const SpringEnd &a, const SpringEnd &b) {
            world.add_spring(spring(a, b, length, mass * rate * rate / 2));
        };
        if (shape == "net") {
            constexpr int n = 5;
            std::vector<SpringEnd> all;
            for (int i = 0; i < n * n; ++i) {
                const int x = i % n, z = i / n;
                const bool edge = x % (n - 1) == 0 || z % (n - 1) == 0;
                all.push_back(add(at * (V{x, 0, z} + any_vector(random, 0.2)), edge));
                if (x > 0)
                    tie(all[std::size_t(i - 1)], all.back());
                if (z > 0)
                    tie(all[std::size_t(i - n)], all.back());
            }
            return world;
        }
        const int links = shape == "pair" ? 1 : int(random.next_in(2, 20));
        SpringEnd last = add(V{0}, shape == "row from a pin");
        for (int i = 1; i <= links; ++i) {
            const SpringEnd next = add(at * (V{i, 0, 0} + any_vector(random, 0.2)), false);
            tie(last, next);
            last = next;
        }
        return world;
    }
};
INSTANTIATE_TEST_SUITE_P(Shapes, StretchedSprings,
                         testing::Values("pair", "row from a pin", "free row", "net"),
                         [](const auto &shape) {
                             std::string name = shape.param;
                             std::ranges::replace(name, ' ', '_');
                             return name;
                         });

TEST_P(StretchedSprings, KeepTheirEnergy) {
    Random random(7);
    for (const double turn : {0.3, 0.8, 2.0, 5.0, 12.0, 25.0, 50.0})
        for (int i = 0; i < 4; ++i) {
            World world = thrown(random, turn, GetParam());
            const double before = world.energy();
            double most = before;
            for (int step = 0; step < 240; ++step) {
                run(world, 1);
                most = std::max(most, world.energy());
            }
            ASSERT_TRUE(world.report().finite);
            EXPECT_LT(most, 1.03 * before) << turn << ' ' << i;
            if (turn < 6) { // faster ones may be damped
                EXPECT_GT(world.energy(), 0.97 * before) << turn << ' ' << i;
            }
        }
}

// Free particles and bodies tied together only by springs.
World floating(const std::string &method) {
    World world(method, weightless(settings_for(method)));
    const BodyId first = world.add_body(dynamic_body(ball(0.2), 2, V{0, 0, 0}, V{0.2, 0, -0.1}));
    BodyDef def = dynamic_body(ball(0.2), 1, V{1.5, 0.5, 0});
    def.angular_velocity = narrow(V{1, -2, 0.5});
    const BodyId second = world.add_body(def);
    world.add_particle(moving_particle(V{0.8, 1, 0.3}, V{0, 0.4, 1}, 0.5));
    world.add_particle(moving_particle(V{0.8, -1, -0.4}, V{0.3, -0.2, 0.5}, 0.7));
    world.add_spring(spring(of_body(first, V{0.2, 0, 0}), of_particle(0), 1, 30, 0.2));
    world.add_spring(spring(of_particle(0), of_body(second, V{0, 0.2, 0}), 0.9, 25));
    world.add_spring(spring(of_body(second, V{0, 0, 0.2}), of_particle(1), 1.2, 20));
    world.add_spring(spring(of_particle(1), of_particle(0), 1.8, 20));
    world.add_spring(
        spring(of_body(first, V{0, -0.2, 0}), of_body(second, V{-0.2, 0, 0}), 1.1, 15));
    return world;
}

// Both momenta are conserved to rounding, except the angular one by methods that take force and
// position from different times: they are off by their order.
TEST_P(Springs, KeepMomenta) {
    World world = floating(GetParam());
    const Measures before = world.measure();
    run(world, 300);
    const Measures after = world.measure();
    EXPECT_LT(glm::distance(after.linear_momentum, before.linear_momentum), 3000 * epsilon);
    const double turned = glm::distance(after.angular_momentum, before.angular_momentum);
    if (GetParam() == "explicit_euler" || GetParam() == "backward_euler" || GetParam() == "xpbd" ||
        GetParam() == "avbd") // its forces are not along the current lines
        EXPECT_GT(turned, 1e-3);
    else
        EXPECT_LT(turned, GetParam() == "rk4" ? 1e-4 : 6000 * epsilon);
}

// The elastic catenary (Irvine 1981, "Cable Structures", section 1.5): half the span of a cable of
// unstretched length 2 s, weight w a metre and stiffness EA, under the horizontal pull H, and its
// sag.
struct Catenary {
    double half_length, weight, stiffness;
    double half_span(double pull) const {
        return pull * half_length / stiffness +
               pull / weight * std::asinh(weight * half_length / pull);
    }
    double sag(double half) const {
        double low = 1e-6, high = 1e6;
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            (half_span(middle) < half ? low : high) = middle;
        }
        const double steep = weight * half_length / low;
        return weight * half_length * half_length / (2 * stiffness) +
               low / weight * (std::sqrt(1 + steep * steep) - 1);
    }
};

// The sag of a chain of 40 links between two nails, as a share of the catenary's.
double sag_of_chain(const std::string &method, int substeps) {
    constexpr int links = 40;
    constexpr double link = 0.05, mass = 0.05, stiffness = 4000;
    StepSettings settings = settings_for(method);
    settings.substeps = substeps > 0 ? substeps : settings.substeps;
    World world(method, settings);
    for (int i = 0; i <= links; ++i)
        world.add_particle(particle_at(V{1.6 * i / links, 0, 0}, mass, i == 0 || i == links));
    for (std::uint32_t i = 0; i < links; ++i)
        world.add_spring(spring(of_particle(i), of_particle(i + 1), link, stiffness, 4));
    // It settles in a viscous medium that does not change where it rests.
    for (int step = 0; step < 1500; ++step) {
        run(world, 1);
        for (std::uint32_t i = 1; i < links; ++i)
            world.set_particle(i, world.state().particles[i].position,
                               Real(0.95) * world.state().particles[i].velocity);
    }
    const Catenary cable{links * link / 2, mass * gravity / link, stiffness * link};
    return -particle_position(world, links / 2).y / cable.sag(0.8);
}

// Boxes that tumble on a spring between points inside them, for half a minute.
TEST(SoftStepSprings, BetweenTumblingBodiesTurnNothing) {
    for (const double stiffness : {10.0, 1e2, 1e3, 1e4, 1e5, 1e6})
        for (const double damping_ratio : {0.0, 0.05, 1.0})
            for (int trial = 0; trial < 8; ++trial) {
                Random random(static_cast<std::uint64_t>(trial) + 1);
                World world("soft_step", weightless(settings_for("soft_step")));
                const V velocity = any_vector(random, 1);
                const V at_a = any_vector(random, 0.15), at_b = any_vector(random, 0.15);
                const auto add = [&](const V &half, const V &at, const V &going) {
                    BodyDef def = dynamic_body(block(half), 1, at, going);
                    def.angular_velocity = narrow(any_vector(random, 1));
                    def.colliders[0].filter = {0, 1};
                    return world.add_body(def);
                };
                const BodyId a = add({0.2, 0.1, 0.3}, V{0}, velocity);
                const BodyId b = add({0.1, 0.2, 0.1}, V{1, 0, 0}, -velocity);
                world.add_spring(spring(of_body(a, at_a), of_body(b, at_b),
                                        glm::length(V{1, 0, 0} + at_b - at_a), stiffness,
                                        damping_ratio * std::sqrt(2 * stiffness)));
                const Measures before = world.measure();
                run(world, 1800);
                const Measures after = world.measure();
                SCOPED_TRACE(testing::Message()
                             << stiffness << " N/m, " << damping_ratio << ", " << trial);
                EXPECT_LT(glm::distance(after.angular_momentum, before.angular_momentum),
                          5e-4 * glm::length(before.angular_momentum));
                EXPECT_LT(after.energy(), (damping_ratio > 0 ? 1.001 : 1.02) * before.energy());
            }
}

TEST_P(Springs, AHangingChainIsACatenary) {
    if (GetParam() == "explicit_euler")
        GTEST_SKIP() << "gains energy";
    const bool follows = GetParam() == "backward_euler" || GetParam() == "soft_step";
    const int substeps = follows ? 0 : GetParam() == "xpbd" ? 64 : 32;
    EXPECT_NEAR(sag_of_chain(GetParam(), substeps), 1, 0.005);
}

// Known failing: if the substep is too long to follow stiff springs, the passes do not converge,
// and the chain hangs too low. soft_step takes as many substeps as it needs.
TEST(StiffSprings, StretchWhereTheSubstepIsTooLong) {
    EXPECT_GT(sag_of_chain("tgs_soft", 0), 1.05);
    EXPECT_GT(sag_of_chain("sequential_impulses", 0), 1.1);
}

TEST_P(Springs, TearBeyondTheirStrain) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_particle(particle_at(V{0, -1, 0}, 1));
    SpringDef def = spring(of_world(V{0}), of_particle(0), 1, 100, 5);
    def.tear_strain = Real(0.25); // let go, it is stretched by at most 2 m g / k = 0.2
    world.add_spring(def);
    run(world, 120);
    EXPECT_EQ(world.state().torn[0], 0);
    EXPECT_EQ(world.report().springs, 1U);
    world.set_particle(0, narrow(V{0, -1.2, 0}), narrow(V{0, -3, 0}));
    run(world, 30);
    EXPECT_EQ(world.state().torn[0], 1);
    EXPECT_EQ(world.report().springs, 0U);
    EXPECT_LT(particle_position(world, 0).y, -2); // falls
}

TEST_P(Springs, SavedAndRestoredGoOnWithTheSameBits) {
    World world = floating(GetParam());
    run(world, 20);
    SavedWorld saved;
    world.save(saved);
    const std::uint64_t at_save = world.hash();
    run(world, 40);
    const std::uint64_t end = world.hash();
    world.restore(saved);
    EXPECT_EQ(world.hash(), at_save);
    run(world, 40);
    EXPECT_EQ(world.hash(), end);
    World again = floating(GetParam());
    run(again, 60);
    EXPECT_EQ(again.hash(), end);
}

TEST(SpringEdits, ABodyTakesItsSpringsAlong) {
    World world = floating("soft_step");
    run(world, 5);
    world.remove_body(world.body_id(1));
    EXPECT_EQ(world.state().torn, (std::vector<std::uint8_t>{0, 1, 1, 0, 1}));
    run(world, 5);
    EXPECT_TRUE(world.report().finite);
    EXPECT_EQ(world.report().springs, 2U);
}

TEST(SpringEdits, RefuseWhatMakesNoSense) {
    World world("soft_step", settings_for("soft_step"));
    world.add_particle(particle_at(V{0}));
    EXPECT_THROW(world.add_particle(particle_at(V{0}, 0)), CheckFailure);
    EXPECT_THROW(world.add_particle(particle_at(V{0, NAN, 0})), CheckFailure);
    EXPECT_THROW(world.add_spring(spring(of_particle(0), of_particle(1), 1, 1)), CheckFailure);
    EXPECT_THROW(world.add_spring(spring(of_particle(0), of_particle(0), 1, 1)), CheckFailure);
    EXPECT_THROW(world.add_spring(spring(of_particle(0), of_world(V{0}), -1, 1)), CheckFailure);
    EXPECT_THROW(world.add_spring(spring(of_particle(0), of_world(V{0}), 1, -1)), CheckFailure);
    EXPECT_THROW(world.add_spring(spring(of_body({3, 0}, V{0}), of_world(V{0}), 1, 1)),
                 CheckFailure);
    EXPECT_EQ(world.state().torn.size(), 0U);
}

// Pinned particles stay put bit for bit; so do those without forces.
TEST_P(Springs, PinnedParticlesStay) {
    World world(GetParam(), settings_for(GetParam()));
    world.add_particle(particle_at(V{1, 2, 3}, 1, true));
    world.add_particle(particle_at(V{1, 0.5, 3}));
    world.add_spring(spring(of_particle(0), of_particle(1), 1, 50, 1));
    run(world, 60);
    EXPECT_EQ(particle_position(world, 0), (V{1, 2, 3}));
    const double energy = world.energy();
    EXPECT_NEAR(world.measure().energy(), energy, 1e-12);
}

// A hand lifts a rope of 1 kg by one of its 50 g particles. The hand's spring alone would sag by g
// / omega^2 = 1 cm. Known failing: it sags by 5, as the substep's implicit pull is that on so light
// a particle.
TEST(ParticleGrab, LiftsWhatHangsOnIt) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    for (int i = 0; i < 21; ++i)
        world.add_particle(particle_at(V{0.1 * i, 0.02, 0}, 0.05));
    for (std::uint32_t i = 0; i < 20; ++i)
        world.add_spring(spring(of_particle(i), of_particle(i + 1), 0.1, 500, 0.5));
    world.grab_particle(10, narrow(V{1, 1.5, 0}), Real(100));
    run(world, 240);
    EXPECT_GT(particle_position(world, 10).y, 1.5 - 0.07);
    EXPECT_LT(particle_position(world, 10).y, 1.5 - 0.01);
    world.release();
    run(world, 240);
    EXPECT_LT(particle_position(world, 10).y, 0.1);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
