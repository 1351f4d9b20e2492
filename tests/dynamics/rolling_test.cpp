// Rolling and rocking bodies gain no energy: the contact point moves along within the step, and so
// do its lever arms and the face's normal.
#include "tests/dynamics/worlds.h"
#include "tests/trials.h"

#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// The largest rise of a world's energy above its start within a time (J).
double gain_of(World &world, double seconds) {
    const double before = world.energy();
    double most = before;
    for (int step = 0; step < seconds / world.settings().dt; ++step) {
        world.step(nullptr);
        most = std::max(most, world.energy());
    }
    return most - before;
}

// A capsule or cylinder on its side keeps rolling, like a ball.
TEST(Rolling, WhatIsRoundRollsOnAtAnySpeed) {
    for (const double radius : {0.002, 0.02, 0.3})
        for (const double turn : {0.1, 0.3, 0.5, 1.0, 2.0, 3.0}) // rad per step
            for (const Shape &shape :
                 {Shape{upright_capsule(2 * radius, radius)},
                  Shape{Cylinder{narrow(V{0, -2 * radius, 0}), narrow(V{0, 2 * radius, 0}),
                                 Real(radius)}}}) {
                World world("soft_step", settings_for("soft_step"));
                world.add_body(ground(0.5, 0));
                const double speed = 60 * turn * radius;
                BodyDef roller = dynamic_body(shape, 1, V{0, radius, 0}, V{speed, 0, 0});
                roller.pose.rotation = narrow(glm::angleAxis(pi / 2, V{1, 0, 0}));
                roller.angular_velocity = narrow(V{0, 0, -speed / radius});
                const BodyId id = world.add_body(roller);
                run(world, 120);
                EXPECT_NEAR(velocity_of(world, id).x, speed, 1e-3 * speed)
                    << radius << ", " << turn << ", " << shape.index();
                EXPECT_NEAR(position_of(world, id).y, radius, 0.01 * radius)
                    << radius << ", " << turn << ", " << shape.index();
            }
}

// A cylinder released on a rim rocks and rolls around on it; the support point moves along.
TEST(Rolling, CylindersLetGoOnARimComeToStandUpright) {
    for (const bool on_block : {false, true})
        for (const double radius : {0.02, 0.2, 1.0})
            for (const double height : {1.0, 3.0, 6.0})          // in radii
                for (const double share : {0.05, 0.2, 0.5, 0.8}) // of the tipping angle
                    for (const double friction : {0.3, 0.6, 1.0}) {
                        World world("soft_step", settings_for("soft_step"));
                        world.add_body(
                            on_block
                                ? with_material(static_body(block(V{10 * radius, 1, 10 * radius}),
                                                            V{0, -1, 0}),
                                                friction, 0)
                                : ground(friction, 0));
                        const double half = 0.5 * height * radius;
                        const double lean = std::min(share * std::atan2(radius, half), 0.6);
                        BodyDef cylinder = dynamic_body(
                            Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(radius)},
                            10, V{0, half * std::cos(lean) + radius * std::sin(lean), 0});
                        cylinder.pose.rotation = narrow(glm::angleAxis(lean, V{0, 0, 1}));
                        const BodyId id = world.add_body(with_material(cylinder, friction, 0));
                        const std::string what =
                            std::string(on_block ? "block" : "ground") + ", radius " +
                            std::to_string(radius) + ", height " + std::to_string(height) + ", " +
                            std::to_string(share) + ", friction " + std::to_string(friction);
                        const double gain = gain_of(world, 30 * std::sqrt(radius));
                        EXPECT_LT(gain, 1e-3 * 10 * gravity * radius * lean) << what;
                        EXPECT_GT((wide(motion_of(world, id).rotation) * V{0, 1, 0}).y, 1 - 1e-6)
                            << what;
                        EXPECT_LT(glm::length(velocity_of(world, id)),
                                  1e-3 * std::sqrt(gravity * radius))
                            << what;
                    }
}

// Random cylinders, released on a rim or spun on it: in fewer than one case of eight the energy
// rises above its previous minimum by more than a hundredth of the initial energy.
TEST(Rolling, CylindersSpunOnARimGainLittleEnergy) {
    Random random(5);
    int more = 0;
    constexpr int count = 300;
    for (int trial = 0; trial < count; ++trial) {
        const double friction = random.next_in(0.05, 1.2);
        const double radius = std::pow(10, random.next_in(-1.5, 0));
        const double half = 0.5 * radius * std::pow(10, random.next_in(-0.3, 1));
        const double lean = std::pow(10, random.next_in(-3, -0.3));
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(friction, 0));
        BodyDef cylinder =
            dynamic_body(Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(radius)}, 10,
                         V{0, half * std::cos(lean) + radius * std::sin(lean), 0});
        cylinder.pose.rotation = narrow(glm::angleAxis(random.next_in(0, 2 * pi), V{0, 1, 0}) *
                                        glm::angleAxis(lean, V{0, 0, 1}));
        const double spin = std::sqrt(gravity / radius);
        const std::uint32_t kind = random.next_index(3);
        if (kind == 1)
            cylinder.angular_velocity = narrow(any_vector(random, 0.3 * spin));
        else if (kind == 2)
            cylinder.angular_velocity = narrow(V{0, random.next_in(-2, 2) * spin, 0});
        world.add_body(with_material(cylinder, friction, 0));
        const double begun =
            world.energy() - 10 * gravity * (half - std::min(radius, half) * std::max(lean, 0.01));
        const double gain = regained_energy(world, 600);
        EXPECT_LT(gain, 0.1 * begun) << trial;
        more += gain > 0.01 * begun ? 1 : 0;
    }
    EXPECT_LT(more, count / 8);
}

// A prism of 8 to 27 sides rolls from corner to corner; its contact has only four of them.
TEST(Rolling, PrismsOnACornerGainLittleEnergy) {
    for (const double spin : {0.0, 1.0}) { // times sqrt(g / radius)
        Random random(11);
        int more = 0;
        constexpr int count = 300;
        for (int trial = 0; trial < count; ++trial) {
            const double friction = random.next_in(0.05, 1.2);
            const double radius = std::pow(10, random.next_in(-1.5, 0));
            const int sides = 8 + static_cast<int>(random.next_index(20));
            const double half = 0.5 * radius * random.next_in(0.2, 3);
            std::vector<Vec3> corners;
            for (int i = 0; i < sides; ++i)
                for (const double end : {-half, half})
                    corners.push_back(narrow(V{radius * std::cos(2 * pi * i / sides), end,
                                               radius * std::sin(2 * pi * i / sides)}));
            const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(friction, 0));
            BodyDef prism =
                dynamic_body(ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation}, 10, V{0});
            prism.colliders[0].hull = mesh;
            const glm::dquat rotation = any_rotation(random);
            double lowest = 0;
            for (const Vec3 &corner : corners)
                lowest = std::min(lowest, (rotation * wide(corner)).y);
            prism.pose = {narrow(V{0, -lowest, 0}), narrow(rotation)};
            prism.angular_velocity = narrow(any_vector(random, spin * std::sqrt(gravity / radius)));
            world.add_body(with_material(prism, friction, 0));
            const double begun = world.energy() + 10 * gravity * (radius + lowest);
            const double gain = regained_energy(world, 900);
            EXPECT_LT(gain, 0.15 * begun) << spin << ", " << trial;
            more += gain > 0.01 * begun ? 1 : 0;
        }
        EXPECT_LT(more, count / 10) << spin;
    }
}

// A cylinder on its rim that leans and rolls, at `froude` times the speed at which it turns as fast
// as gravity tips it. Thin ones are coins.
BodyDef leaning_roller(double radius, double thickness, double lean, double froude) {
    const double half = 0.5 * thickness * radius;
    const double speed = froude * std::sqrt(gravity * radius);
    BodyDef roller = dynamic_body(
        Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(radius)}, 1,
        V{0, radius * std::cos(lean) + half * std::abs(std::sin(lean)), 0}, V{speed, 0, 0});
    roller.pose.rotation = narrow(glm::angleAxis(pi / 2 - lean, V{1, 0, 0}));
    roller.angular_velocity = narrow(V{0, 0, -speed / radius});
    return roller;
}

// The largest rise of its energy above the start, in units of its initial kinetic energy.
double gain_of_roller(const BodyDef &roller, const StepSettings &settings, double friction,
                      double restitution, double seconds) {
    World world("soft_step", settings);
    world.add_body(ground(friction, restitution));
    world.add_body(with_material(roller, friction, restitution));
    const double moving = world.measure().kinetic_energy;
    return gain_of(world, seconds) / moving;
}

// It rolls in a circle; only friction may slow it down. Slow coins turn fastest: with lever arms
// frozen for the step they gained twice their energy.
TEST(Rolling, ALeaningCoinRollsWithoutGainingEnergy) {
    const StepSettings settings = settings_for("soft_step");
    for (const double radius : {0.01, 0.1})
        for (const double froude : {0.4, 0.7, 1.0, 2.0, 4.0}) {
            for (const double lean : {0.15, 0.3, 0.5})
                EXPECT_LE(
                    gain_of_roller(leaning_roller(radius, 0.2, lean, froude), settings, 0.5, 0, 6),
                    1e-4)
                    << radius << ", " << froude << ", " << lean;
            EXPECT_LE(
                gain_of_roller(leaning_roller(radius, 0.2, 0.2, froude), settings, 0.9, 0, 10),
                1e-4)
                << radius << ", " << froude;
        }
}

// A thin disc that leans by `lean` from upright and rolls round a circle of `circle` radii without
// slipping, at the rate at which gravity turns its angular momentum (Goldstein 2002, section 5.7;
// a disc without thickness, so this one wobbles a little).
BodyDef circling_disc(double radius, double lean, double circle) {
    const double half = 0.02 * radius;
    const double sine = std::sin(lean), cosine = std::cos(lean);
    const double middle = circle * radius - radius * sine; // the centre's distance from the axis
    const double across = 0.25 * radius * radius + half * half / 3;
    const double about = 0.5 * radius * radius;    // its own axis
    const double spin = -(middle / radius + sine); // of the rate of turning round the circle
    const double turned = about * (sine + spin) * cosine - across * cosine * sine;
    const double rate = std::sqrt(radius * sine * gravity / (radius * cosine * middle - turned));
    const V axis{cosine, sine, 0}; // up and away from the circle's middle
    const V up{-sine, cosine, 0};  // from the lowest point to the centre
    const V from_contact = radius * up + half * axis;
    const V angular = rate * V{0, 1, 0} + rate * spin * axis;
    BodyDef disc =
        dynamic_body(Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(radius)}, 1,
                     V{circle * radius, 0, 0} + from_contact, glm::cross(angular, from_contact));
    disc.pose.rotation = narrow(glm::angleAxis(std::acos(axis.y), V{0, 0, -1}));
    disc.angular_velocity = narrow(angular);
    return disc;
}

// Flat on the floor or nearly upright, it goes on: its contact point runs round the rim by up to
// two radians in a step. Standing on one point in each step, it fell flat if it leaned by 45
// degrees.
TEST(Rolling, DiscsRollRoundInCirclesAtAnyLean) {
    for (const double radius : {0.02, 0.1, 0.5})
        for (const double circle : {1.5, 4.0})
            for (const double lean : {0.4, 0.7, 0.776, 0.79, 0.9, 1.1, 1.3, 1.45}) {
                World world("soft_step", settings_for("soft_step"));
                world.add_body(ground(9, 0));
                const BodyId id =
                    world.add_body(with_material(circling_disc(radius, lean, circle), 9, 0));
                const double begun = world.energy();
                const double rate = glm::length(velocity_of(world, id)) / (circle * radius);
                const int steps = static_cast<int>(60 * 4 * pi / rate); // twice round
                double most = lean, least = lean;
                for (int step = 0; step < steps; ++step) {
                    world.step(nullptr);
                    const V axis = wide(motion_of(world, id).rotation) * V{0, 1, 0};
                    const double now = std::asin(std::abs(axis.y));
                    most = std::max(most, now);
                    least = std::min(least, now);
                }
                EXPECT_NEAR(world.energy() / begun, 1, 2e-3)
                    << radius << ", " << lean << ", " << circle;
                EXPECT_LT(most - least, 0.2) << radius << ", " << lean << ", " << circle;
            }
}

TEST(Rolling, LeaningRollersOfAnySortGainNoEnergy) {
    Random random(5);
    for (int trial = 0; trial < trials(100); ++trial) {
        const double radius = std::pow(10, random.next_in(-2, 0));
        const double thickness = random.next_in(0.05, 1);
        const double lean = random.next_in(-0.8, 0.8);
        const double froude = random.next_in(0.7, 5);
        const double friction = random.next_in(0.3, 1.2);
        const double restitution = trial % 3 == 0 ? 0.4 : 0;
        EXPECT_LE(gain_of_roller(leaning_roller(radius, thickness, lean, froude),
                                 settings_for("soft_step"), friction, restitution, 6),
                  1e-4)
            << trial;
    }
}
TEST(Rolling, ALeaningCoinGainsNoEnergyAtOtherStepsEither) {
    for (const auto &[dt, substeps] :
         {std::pair{1.0 / 60, 4}, std::pair{1.0 / 60, 16}, std::pair{1.0 / 240, 1},
          std::pair{1.0 / 240, 4}, std::pair{1.0 / 960, 1}})
        for (const double lean : {0.3, 0.5}) {
            StepSettings settings = settings_for("soft_step");
            settings.dt = dt;
            settings.substeps = substeps;
            settings.max_substeps = 1;
            EXPECT_LE(gain_of_roller(leaning_roller(0.1, 0.2, lean, 0.6), settings, 0.5, 0, 10),
                      1e-4)
                << dt << ", " << substeps << ", " << lean;
        }
}

// Known failing: thrown coins that spin by up to a radian per step land on parts of the rim without
// contact points. Measured: 1 or 2 of 200 gain more than a twentieth, at worst 0.13.
TEST(Rolling, ThrownCoinsHardlyGainEnergy) {
    Random random(5);
    const int tried = trials(200);
    int gained = 0;
    for (int trial = 0; trial < tried; ++trial) {
        const double radius = std::pow(10, random.next_in(-2, 0));
        const double half = random.next_in(0.025, 0.75) * radius;
        const double friction = random.next_in(0.2, 1);
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(friction, 0));
        BodyDef coin =
            dynamic_body(Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(radius)}, 1,
                         V{0, 2.5 * radius, 0}, any_vector(random, 2 * std::sqrt(radius)));
        coin.pose.rotation = narrow(any_rotation(random));
        coin.angular_velocity = narrow(any_vector(random, 15 / std::sqrt(radius)));
        world.add_body(with_material(coin, friction, 0));
        const double scale = gravity * radius + 0.5 * world.measure().kinetic_energy;
        double least = world.energy(), gain = 0;
        for (int step = 0; step < 240; ++step) {
            world.step(nullptr);
            least = std::min(least, world.energy());
            gain = std::max(gain, world.energy() - least);
        }
        EXPECT_LE(gain, 0.2 * scale) << trial;
        gained += gain > 0.05 * scale ? 1 : 0;
    }
    // With only four points on the rim: one in fifteen, by up to 1.2.
    EXPECT_LE(gained, 1 + tried / 66);
}

// A roly-poly: its centre of mass is below the middle of the round shape. Released at an angle, it
// swings; with lever arms frozen for the step it swung ever wider, and turned over.
TEST(Rolling, WhatIsHeavyOnOneSideSwingsNoWider) {
    for (const double radius : {0.01, 0.1, 0.5})
        for (const double low : {0.2, 0.6}) // of the radius
            for (const double angle : {0.1, 1.0})
                for (const bool is_ball : {true, false}) {
                    const double friction = radius < 0.2 ? 0.8 : 0;
                    World world("soft_step", settings_for("soft_step"));
                    world.add_body(ground(friction, 0));
                    const Shape shape =
                        is_ball ? Shape{ball(radius)}
                                : Shape{Cylinder{narrow(V{0, 0, -radius}), narrow(V{0, 0, radius}),
                                                 Real(radius)}};
                    BodyDef tumbler = dynamic_body(shape, 1, V{0, radius, 0});
                    tumbler.center_of_mass = narrow(V{0, -low * radius, 0});
                    tumbler.inertia = narrow(V{0.4 * radius * radius});
                    tumbler.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
                    world.add_body(with_material(tumbler, friction, 0));
                    const double swing = gravity * low * radius * (1 - std::cos(angle));
                    // The smallest swing by half a radian per step.
                    EXPECT_LE(gain_of(world, 10), (radius < 0.05 ? 0.1 : 1e-4) * swing)
                        << radius << ", " << low << ", " << angle << ", " << is_ball;
                }
}

// It swings on for as long: after 20 swings it has what it had after the first, which settles it
// into its contact.
TEST(Rolling, WhatIsHeavyOnOneSideSwingsOn) {
    for (const double radius : {0.05, 0.3, 1.0})
        for (const double low : {0.1, 0.3, 0.6}) // of the radius
            for (const double angle : {0.1, 0.5, 1.5})
                for (const bool is_ball : {true, false}) {
                    World world("soft_step", settings_for("soft_step"));
                    world.add_body(ground(1, 0));
                    const Shape shape =
                        is_ball ? Shape{ball(radius)}
                                : Shape{Cylinder{narrow(V{0, 0, -radius}), narrow(V{0, 0, radius}),
                                                 Real(radius)}};
                    const double inertia = 0.4 * radius * radius;
                    BodyDef tumbler = dynamic_body(shape, 1, V{0, radius, 0});
                    tumbler.center_of_mass = narrow(V{0, -low * radius, 0});
                    tumbler.inertia = narrow(V{inertia});
                    tumbler.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
                    world.add_body(with_material(tumbler, 1, 0));
                    const double arm = (1 - low) * radius;
                    const double period =
                        2 * pi * std::sqrt((inertia + arm * arm) / (gravity * low * radius));
                    run(world, static_cast<int>(60 * period));
                    const double lowest = gravity * (1 - low) * radius;
                    const double first = world.energy() - lowest;
                    run(world, static_cast<int>(60 * 19 * period));
                    EXPECT_NEAR((world.energy() - lowest) / first, 1, 0.02)
                        << radius << ", " << low << ", " << angle << ", " << is_ball;
                }
}

// A plank rocking on a barrel: stable while it is thinner than the barrel's diameter.
TEST(Rolling, APlankOnABarrelSwingsNoWider) {
    for (const double radius : {0.3, 1.0, 5.0})
        for (const double angle : {0.01, 0.05})
            for (const double friction : {0.3, 1.0}) {
                const double half = 0.05;
                World world("soft_step", settings_for("soft_step"));
                world.add_body(with_material(
                    static_body(Cylinder{narrow(V{0, 0, -1}), narrow(V{0, 0, 1}), Real(radius)}),
                    friction, 0));
                // Rolled to the angle from level on top of the barrel.
                const V out{-std::sin(angle), std::cos(angle), 0};
                const V along{std::cos(angle), std::sin(angle), 0};
                BodyDef plank = dynamic_body(block(V{1.5, half, 0.3}), 1,
                                             (radius + half) * out + radius * angle * along);
                plank.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
                world.add_body(with_material(plank, friction, 0));
                const double swing = gravity * (radius - half) * 0.5 * angle * angle;
                EXPECT_LE(gain_of(world, 10), 1e-4 * swing)
                    << radius << ", " << angle << ", " << friction;
            }
}

// On a wide barrel it lost three quarters of its energy in a minute: it left the barrel a little in
// each step.
TEST(Rolling, APlankOnABarrelSwingsOn) {
    for (const double radius : {1.0, 5.0})
        for (const double angle : {0.05, 0.2}) {
            const double half = 0.05;
            World world("soft_step", settings_for("soft_step"));
            world.add_body(with_material(
                static_body(Cylinder{narrow(V{0, 0, -1}), narrow(V{0, 0, 1}), Real(radius)}), 0.8,
                0));
            const V out{-std::sin(angle), std::cos(angle), 0};
            const V along{std::cos(angle), std::sin(angle), 0};
            BodyDef plank = dynamic_body(block(V{1.5, half, 0.3}), 1,
                                         (radius + half) * out + radius * angle * along);
            plank.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
            world.add_body(with_material(plank, 0.8, 0));
            const double swing = gravity * (radius - half) * 0.5 * angle * angle;
            const double begun = world.energy();
            run(world, 1800);
            EXPECT_NEAR(world.energy(), begun, 0.01 * swing) << radius << ", " << angle;
        }
}

// Rocking so slowly that it hardly turns in a step: with the normal held for each it swung out up
// to four times as far after 40 periods, or died away.
TEST(Rolling, APlankThatRocksSlowlySwingsOn) {
    constexpr double half = 0.05, length = 1;
    for (const double radius : {0.5, 2.0})
        for (const Shape &round :
             {Shape{Cylinder{narrow(V{0, 0, -1}), narrow(V{0, 0, 1}), Real(radius)}},
              Shape{Sphere{Vec3{0}, Real(radius)}}})
            for (const double angle : {0.003, 0.01})
                for (const int rate : {60, 240}) {
                    StepSettings settings = settings_for("soft_step");
                    settings.dt = 1.0 / rate;
                    settings.sleep_after = 0;
                    World world("soft_step", settings);
                    world.add_body(with_material(static_body(round), 0.8, 0));
                    const V out{-std::sin(angle), std::cos(angle), 0};
                    const V along{std::cos(angle), std::sin(angle), 0};
                    BodyDef plank = dynamic_body(block(V{length, half, 0.2}), 5,
                                                 (radius + half) * out + radius * angle * along);
                    plank.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
                    world.add_body(with_material(plank, 0.8, 0));
                    const double inertia = (length * length + half * half) / 3 + half * half;
                    const double period = 2 * pi * std::sqrt(inertia / (gravity * (radius - half)));
                    const auto fastest = [&] {
                        Real spin = 0;
                        for (int step = 0; step < period * rate; ++step) {
                            world.step(nullptr);
                            spin = std::max(spin, glm::length(world.motions()[1].angular_velocity));
                        }
                        return static_cast<double>(spin);
                    };
                    const double first = fastest();
                    run(world, static_cast<int>(38 * period * rate));
                    EXPECT_NEAR(fastest(), first, 0.02 * first)
                        << round.index() << ", " << radius << ", " << angle << ", " << rate;
                }
}

// A ring hanging in another ring swings with a weight.
TEST(Rolling, ALinkThatHangsInALinkSwingsNoWider) {
    const auto add_ring = [](World &world, BodyKind kind, const V &at, bool across) {
        BodyDef ring;
        ring.kind = kind;
        ring.pose.position = narrow(at);
        constexpr int sides = 12;
        for (int i = 0; i < sides; ++i) {
            const auto corner = [&](int k) {
                const double turn = 2 * pi * k / sides;
                const double x = 0.3 * std::cos(turn);
                return narrow(across ? V{0, 0.3 * std::sin(turn), x}
                                     : V{x, 0.3 * std::sin(turn), 0});
            };
            ring.colliders.emplace_back().shape = Capsule{corner(i), corner(i + 1), Real(0.04)};
        }
        if (kind == BodyKind::dynamic)
            ring.mass = Real(5);
        world.add_body(with_material(ring, 0.5, 0));
    };
    for (const double turn : {0.2, 0.6}) {
        World world("soft_step", settings_for("soft_step"));
        add_ring(world, BodyKind::static_body, V{0}, false);
        add_ring(world, BodyKind::dynamic, V{0, -0.52, 0}, true);
        run(world, 120);
        const BodyId ring = world.body_id(1);
        world.set_motion(ring, world.pose_of(ring.index), Vec3{0},
                         narrow(V{8 * turn, 0, 4 * turn}));
        const double swing = world.measure().kinetic_energy;
        EXPECT_LE(gain_of(world, 20), 1e-4 * swing) << turn;
    }
}

// How steep it is where a round body of radius `r` leaves a fixed one, if it starts to roll at rest
// at `start` (rad off the top): by Newton's and Coulomb's laws, with the midpoint rule in small
// steps. `way`: between their centres (m); `inertia`: of the body, in m r^2. Without friction the
// cosine falls to 2/3 of what it was.
double leaves_at(double start, double way, double inertia, double friction) {
    double angle = start, rate = 0;
    bool slides = false;
    const auto pressed = [&](double a, double w) { return gravity * std::cos(a) - way * w * w; };
    const auto pull = [&](double a, double w) {
        const double along = gravity * std::sin(a);
        return (slides ? along - friction * pressed(a, w) : along / (1 + inertia)) / way;
    };
    constexpr double h = 1e-4;
    while (pressed(angle, rate) > 0) {
        const double needed = inertia / (1 + inertia) * gravity * std::sin(angle);
        slides = slides || needed > friction * pressed(angle, rate);
        const double middle = rate + 0.5 * h * pull(angle, rate);
        rate += h * pull(angle + 0.5 * h * rate, middle);
        angle += h * middle;
    }
    return angle;
}

// The normal turns with the line between the centres, within the step. Cylinders come off less
// evenly: their normals are found by GJK.
TEST(Rolling, WhatIsRoundComesOffAnotherWhereItShould) {
    EXPECT_NEAR(leaves_at(0.3, 1.5, 0.4, 0), std::acos(2.0 / 3 * std::cos(0.3)), 2e-4);
    const auto log = [](double radius) {
        return Cylinder{narrow(V{0, 0, -0.5}), narrow(V{0, 0, 0.5}), Real(radius)};
    };
    constexpr double degree = pi / 180;
    for (const bool are_balls : {true, false})
        for (const double under : {0.3, 1.0, 3.0})
            for (const double radius : {0.1, 0.5})
                for (const double friction : {0.0, 0.2, 0.5, 1.0})
                    for (const double restitution : {0.0, 0.3})
                        for (const double rate : {30.0, 60.0, 120.0}) {
                            constexpr double start = 0.1;
                            const auto shape = [&](double r) {
                                return are_balls ? Shape{ball(r)} : Shape{log(r)};
                            };
                            const double way = under + radius;
                            StepSettings settings = settings_for("soft_step");
                            settings.dt = 1 / rate;
                            World world("soft_step", settings);
                            world.add_body(with_material(static_body(shape(under), V{0}), friction,
                                                         restitution));
                            const V from = way * V{std::sin(start), std::cos(start), 0};
                            const BodyId id = world.add_body(with_material(
                                dynamic_body(shape(radius), 1, from), friction, restitution));
                            for (int step = 0; step < 20 * rate; ++step) {
                                const V at = position_of(world, id);
                                if (std::hypot(at.x, at.y) > 1.02 * way)
                                    break;
                                world.step(nullptr);
                            }
                            // Where gravity alone held it: v^2 = g l cos a.
                            const double level = velocity_of(world, id).x;
                            const double cosine = std::cbrt(level * level / (gravity * way));
                            EXPECT_NEAR(std::acos(std::min(1.0, cosine)),
                                        leaves_at(start, way, are_balls ? 0.4 : 0.5, friction),
                                        (are_balls ? 0.1 : 0.9) * degree)
                                << (are_balls ? "balls " : "cylinders ") << under << ", " << radius
                                << ", friction " << friction << ", restitution " << restitution
                                << ", " << rate << " Hz";
                        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
