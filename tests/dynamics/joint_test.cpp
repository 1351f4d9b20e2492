// Joints against the mechanics of pendulums.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class Joints : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Joints, testing::ValuesIn(joint_methods()), name_of);

// The period of a pendulum of amplitude a: that of small swings over the arithmetic-geometric mean
// of 1 and cos(a / 2) (Gauss).
double period(double small_rate, double amplitude) {
    double a = 1, g = std::cos(amplitude / 2);
    while (std::abs(a - g) > 1e-15) {
        const double mean = (a + g) / 2;
        g = std::sqrt(a * g);
        a = mean;
    }
    return 2 * pi / (small_rate * a);
}

struct Pendulum {
    World world;
    BodyId bob;
    double arm;
    double angle() const {
        const V p = position_of(world, bob);
        return std::atan2(p.x, -p.y);
    }
};

// A body hung from the origin by a ball joint `arm` from its centre, released at `amplitude` in the
// xy plane.
Pendulum hung(const std::string &method, const StepSettings &settings, const Shape &shape,
              double mass, double arm, double amplitude) {
    World world(method, settings);
    BodyDef def = dynamic_body(shape, mass, arm * V{std::sin(amplitude), -std::cos(amplitude), 0});
    def.pose.rotation = narrow(glm::dquat(std::cos(amplitude / 2), 0, 0, std::sin(amplitude / 2)));
    JointDef joint;
    joint.b = world.add_body(def);
    joint.anchor_b_local = narrow(V{0, arm, 0});
    world.add_joint(joint);
    return {std::move(world), joint.b, arm};
}

// The mean period of the first swings, from interpolated times of passing the bottom.
double measured_period(Pendulum &pendulum, int swings) {
    std::vector<double> crossings;
    double before = pendulum.angle();
    for (int i = 1; i < 100000 && int(crossings.size()) < 2 * swings + 1; ++i) {
        pendulum.world.step(nullptr);
        const double now = pendulum.angle();
        if ((before > 0) != (now > 0))
            crossings.push_back((i - now / (now - before)) * pendulum.world.settings().dt);
        before = now;
    }
    return (crossings.back() - crossings.front()) / swings;
}

double ball_rate(double mass, double arm, double radius) {
    const double moment = mass * (arm * arm + 0.4 * radius * radius);
    return std::sqrt(mass * gravity * arm / moment);
}

// At fine substeps. soft_step is second order: (w h)^2 of the period. Sequential impulses loses
// w^2 h of its energy per second, and the period shortens with the amplitude.
TEST_P(Joints, PendulumPeriod) {
    for (const double amplitude : {0.1, 1.0, 2.0}) {
        StepSettings settings = settings_for(GetParam());
        settings.substeps = 16;
        Pendulum pendulum = hung(GetParam(), settings, ball(0.2), 2, 1, amplitude);
        const double rate = ball_rate(2, 1, 0.2);
        const double expected = period(rate, amplitude);
        const double h = substep_of(pendulum.world);
        const bool second = GetParam() == "soft_step";
        // Single precision: a thousand roundings of the fixing a substep, at random.
        // XPBD loses more energy: the swing's, and the bob's own. So does AVBD, whose gravity also
        // acts at the substep's end.
        const double first = GetParam() == "xpbd" || GetParam() == "avbd" ? 5 : 3;
        const double tolerance =
            (second ? 4 * rate * rate * h * h : first * rate * rate * h) + 1000 * epsilon;
        EXPECT_NEAR(measured_period(pendulum, 3) / expected, 1, tolerance) << amplitude;
    }
}

// A long rod hung by its end, and a brick: the moment of inertia counts.
TEST_P(Joints, CompoundPendulumPeriod) {
    for (const V &half : {V{0.02, 0.5, 0.02}, V{0.3, 0.2, 0.1}}) {
        StepSettings settings = settings_for(GetParam());
        settings.substeps = 16;
        const double arm = half.y;
        Pendulum pendulum = hung(GetParam(), settings, block(half), 3, arm, 0.5);
        const double moment = (half.x * half.x + half.y * half.y) / 3 + arm * arm;
        const double rate = std::sqrt(gravity * arm / moment);
        const double h = substep_of(pendulum.world);
        const bool second = GetParam() == "soft_step";
        const double tolerance =
            (second ? 4 * rate * rate * h * h : 3 * rate * rate * h) + 1000 * epsilon;
        EXPECT_NEAR(measured_period(pendulum, 3) / period(rate, 0.5), 1, tolerance);
    }
}

double energy_change(const std::string &method, int substeps, double seconds) {
    StepSettings settings = settings_for(method);
    settings.substeps = substeps;
    Pendulum pendulum = hung(method, settings, ball(0.2), 2, 1, 1.5);
    const double before = pendulum.world.measure().energy();
    run(pendulum.world, int(seconds * 60));
    const double swing = 2 * gravity * (1 - std::cos(1.5));
    return (pendulum.world.measure().energy() - before) / swing;
}

// soft_step keeps a pendulum's energy to second order or better in the substep.
TEST(SoftStep, PendulumEnergyConvergesToSecondOrder) {
    const double coarse = std::abs(energy_change("soft_step", 2, 10));
    const double middle = std::abs(energy_change("soft_step", 8, 10));
    EXPECT_LT(coarse, 0.05);
    EXPECT_LT(middle, coarse / 8 + 2000 * epsilon); // second order gives 16; 8 leaves slack
}

// Known failing: sequential impulses evaluates the joint at the old poses, which costs energy in
// proportion to the substep: a measured 8.7 % in 4 s at one substep.
TEST(SequentialImpulses, LosesAPendulumsEnergy) {
    const double at_1 = -energy_change("sequential_impulses", 1, 4);
    const double at_8 = -energy_change("sequential_impulses", 8, 4);
    EXPECT_GT(at_1, 0.05);
    EXPECT_LT(at_1, 0.15);
    EXPECT_LT(at_8, at_1 / 3);
}

TEST_P(Joints, DriftIsBounded) {
    Pendulum pendulum = hung(GetParam(), settings_for(GetParam()), ball(0.2), 2, 1, 2.5);
    double worst = 0;
    for (int i = 0; i < 1200; ++i) {
        pendulum.world.step(nullptr);
        worst = std::max(worst, pendulum.world.measure().max_joint_drift);
    }
    // In a substep the path strays from its chord by (v h)^2 / 2 r, with v = 5.9 m/s at the bottom.
    // Baumgarte corrects a fifth of the drift per substep, so five such errors remain.
    const double h = substep_of(pendulum.world);
    const double stray = 5.9 * h * 5.9 * h / 2;
    // TGS Soft's joints, at an eighth of the substep rate with a damping ratio of 10, correct
    // pi / 4 / (20 + pi / 4) of it. XPBD moves an anchor along its error only and turns the body
    // with it: 140 remained.
    const double left = GetParam() == "tgs_soft" ? (20 + pi / 4) / (pi / 4)
                        : GetParam() == "xpbd"   ? 200
                                                 : 6;
    EXPECT_LE(worst, left * stray + 1e-5);
}

// Hanging still, a ball joint carries the weight and no sideways load.
TEST_P(Joints, CarryTheWeight) {
    for (const JointType type : {JointType::ball, JointType::distance}) {
        World world(GetParam(), settings_for(GetParam()));
        JointDef joint;
        joint.type = type;
        set_length(joint, Real(1));
        joint.b = world.add_body(dynamic_body(ball(0.2), 3, V{0, -1, 0}));
        if (type == JointType::ball)
            joint.anchor_b_local = narrow(V{0, 1, 0});
        world.add_joint(joint);
        run(world, 300);
        const V impulse = impulse_of(world, 0);
        const V force = impulse / substep_of(world);
        const double weight = 3 * gravity;
        // XPBD's force is a displacement over h^2: two roundings of a metre.
        const double h = substep_of(world);
        const double noise = GetParam() == "xpbd" ? 3 * 2 * epsilon / (h * h) : 0;
        const double tolerance = weight * (1e-4 + 1000 * epsilon) + noise;
        if (type == JointType::ball) {
            EXPECT_LE(glm::distance(force, V{0, weight, 0}), tolerance);
        } else {
            EXPECT_NEAR(std::abs(force.x), weight, tolerance);
        }
        const double sag = sag_of_joints(world);
        EXPECT_LE(glm::distance(position_of(world, joint.b), V{0, -1 - sag, 0}), 1e-3);
    }
}

// Circling in zero gravity: a force of m w^2 r towards the centre, and constant speed forever.
TEST_P(Joints, CarryTheCentripetalForce) {
    StepSettings settings = weightless(settings_for(GetParam()));
    settings.substeps = 16;
    World world(GetParam(), settings);
    BodyDef def = dynamic_body(ball(0.2), 3, V{0, -1, 0}, V{2, 0, 0});
    def.angular_velocity = narrow(V{0, 0, 2});
    JointDef joint;
    joint.b = world.add_body(def);
    joint.anchor_b_local = narrow(V{0, 1, 0});
    world.add_joint(joint);
    run(world, 60);
    const double force = glm::length(impulse_of(world, 0)) / substep_of(world);
    const double speed = glm::length(velocity_of(world, joint.b));
    const double h = substep_of(world);
    // In single precision Baumgarte's bias picks up the rounding of the anchors: 0.2 m / h^2 times
    // a few roundings of a metre.
    const double noise = 0.2 * 3 / (h * h) * 4 * epsilon;
    // Known failing: XPBD's force swings about its mean by as much as the mean where the anchor is
    // far from the centre: the error's direction is that of a mean of two very different masses.
    EXPECT_NEAR(force, 3 * speed * speed, GetParam() == "xpbd" ? 12 : 0.01 * 12 + noise);
    if (GetParam() == "soft_step") {
        EXPECT_NEAR(speed, 2, 2 * (60 * 16 * 2 * h * 2 * h * 2 * h + 1000 * epsilon));
    } else {
        const double share = GetParam() == "xpbd" ? 2 : 1;
        EXPECT_NEAR(speed, 2, share * 2 * 2 * 2 * h); // w^2 h per second, as above
    }
}

// At the far end of a distance joint: a pendulum with a point-like bob, which keeps its own spin.
TEST_P(Joints, DistancePendulumPeriod) {
    StepSettings settings = settings_for(GetParam());
    settings.substeps = 16;
    World world(GetParam(), settings);
    const double amplitude = 1;
    JointDef joint;
    joint.type = JointType::distance;
    set_length(joint, Real(1));
    joint.b =
        world.add_body(dynamic_body(ball(0.2), 2, V{std::sin(amplitude), -std::cos(amplitude), 0}));
    world.add_joint(joint);
    Pendulum pendulum{std::move(world), joint.b, 1};
    const double rate = std::sqrt(gravity);
    const double h = substep_of(pendulum.world);
    const bool second = GetParam() == "soft_step";
    const double tolerance =
        (second ? 4 * rate * rate * h * h : 3 * rate * rate * h) + 1000 * epsilon;
    EXPECT_NEAR(measured_period(pendulum, 3) / period(rate, amplitude), 1, tolerance);
    EXPECT_EQ(spin_of(pendulum.world, joint.b), V{0});
}

// Ten 1 kg links, held out level and released, with a weight at the end. The largest drift in 10 s;
// infinite if the world diverges.
double chain_drift(const std::string &method, const StepSettings &settings, const Shape &link,
                   double weight) {
    World world(method, settings);
    BodyId before;
    for (int i = 0; i < 11; ++i) {
        const bool last = i == 10;
        JointDef joint;
        joint.a = before;
        joint.b = world.add_body(dynamic_body(last ? Shape{ball(0.3)} : link, last ? weight : 1,
                                              V{0.5 * i + 0.25, 0, 0}));
        if (i > 0)
            joint.anchor_a_local = narrow(V{0.25, 0, 0});
        joint.anchor_b_local = narrow(V{-0.25, 0, 0});
        world.add_joint(joint);
        before = joint.b;
    }
    double worst = 0;
    for (int i = 0; i < 600; ++i) {
        world.step(nullptr);
        if (!world.report().finite)
            return std::numeric_limits<double>::infinity();
        worst = std::max(worst, world.measure().max_joint_drift);
    }
    return worst;
}

// A tenth of a link is the most drift that counts as holding together.
TEST(SoftStep, HoldsAChainWithAHeavyEnd) {
    const StepSettings settings = settings_for("soft_step");
    const Shape link = block(V{0.25, 0.05, 0.05});
    EXPECT_LT(chain_drift("soft_step", settings, link, 1), 0.05);
    EXPECT_LT(chain_drift("soft_step", settings, link, 10), 0.05);
    EXPECT_LT(chain_drift("soft_step", settings, link, 100), 0.1);
}

// Links that are balls far smaller than the joints' lever arms: the joint forces turn them faster
// than four substeps can follow, and the chain gives way; eight hold it.
TEST(SoftStep, HoldsAChainOfSmallBalls) {
    StepSettings settings = settings_for("soft_step");
    EXPECT_LT(chain_drift("soft_step", settings, ball(0.1), 100), 0.1);
    settings.substeps = 8;
    EXPECT_LT(chain_drift("soft_step", settings, ball(0.1), 100), 0.02);
}

// Known failing: a hundredfold weight tears the chain of sequential impulses.
TEST(SequentialImpulses, AHeavyEndTearsAChain) {
    StepSettings settings = settings_for("sequential_impulses");
    const Shape link = block(V{0.25, 0.05, 0.05});
    EXPECT_LT(chain_drift("sequential_impulses", settings, link, 1), 0.15);
    EXPECT_GT(chain_drift("sequential_impulses", settings, link, 100), 1);
    settings.substeps = 4;
    EXPECT_LT(chain_drift("sequential_impulses", settings, link, 100), 0.3);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
