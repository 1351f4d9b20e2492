// Pendulums, cradles, chains, nets and tops.
#include "tests/bench/scene_parts.h"
#include "tests/bench/truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

using namespace parts;

constexpr double g = 9.81;
constexpr double degree = std::numbers::pi / 180;

// A 1 kg ball of radius 0.1 m on a ball joint 1 m from its centre, `angle` off the vertical.
std::size_t hang(SceneDesc &scene, const glm::dvec3 &pivot, double angle) {
    const glm::dvec3 arm(-std::sin(angle), -std::cos(angle), 0);
    BodyDesc &ball = add(scene, "ball", SphereDesc{0.1}, pivot + arm);
    ball.mass = 1;
    add_joint(scene, JointType::ball, the_world, scene.bodies.size() - 1, pivot);
    return scene.bodies.size() - 1;
}

// Period of a ball rigidly attached to its arm: 4 K(sin(amplitude / 2)) / w, by the
// arithmetic-geometric mean.
double period(double amplitude) {
    const double w = std::sqrt(g / (1 + 0.4 * 0.1 * 0.1));
    double a = 1, b = std::cos(0.5 * amplitude);
    while (std::abs(a - b) > 1e-15) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 2 * std::numbers::pi / (w * a);
}

double pendulum_energy(const EngineKind &kind) {
    SceneDesc scene;
    hang(scene, {0, 1, 0}, 60 * degree);
    Trial trial(kind, scene);
    const double begin = trial.energy(); // zero at the lowest point
    return 100 * trial.worst(60, [&] { return std::abs(trial.energy() / begin - 1); });
}

// Error (%) of the period of a pendulum that hangs at x = `away`.
double pendulum_period(const EngineKind &kind, double away, Precision precision) {
    SceneDesc scene;
    scene.world.precision = precision;
    hang(scene, {away, 1, 0}, 60 * degree);
    Trial trial(kind, scene);
    double before = -1, first = 0, last = 0;
    int crossings = 0; // upward, through x = 0
    trial.go(60, [&] {
        const double now = trial.body(0).position.x - away;
        if (before < 0 && now >= 0) {
            last = trial.time() - trial.scene().dt() * now / (now - before);
            first = crossings++ == 0 ? last : first;
        }
        before = now;
    });
    if (crossings < 2)
        return 100;
    return 100 * std::abs((last - first) / (crossings - 1) / period(60 * degree) - 1);
}

// The worst angle error of any ball, in degrees, when the struck balls are at their highest; with
// gaps, of the last ball.
double cradle(const EngineKind &kind, int balls, int raised, double gap) {
    SceneDesc scene;
    set_material(scene, 0, 1);
    const auto pivot = [&](int i) { return glm::dvec3(i * (0.2 + gap), 1, 0); };
    for (int i = 0; i < balls; ++i)
        hang(scene, pivot(i), i < raised ? 30 * degree : 0);
    Trial trial(kind, scene);
    // With gaps, every ball but the last stops where it hits the next, and keeps the potential
    // energy of that place.
    const double stopped = 1 - std::sqrt(1 - gap * gap);
    const double risen =
        std::acos(std::cos(30 * degree) + (gap > 0 ? (balls - 1) * stopped : 0)) / degree;
    const auto angle = [&](int i) {
        const glm::dvec3 arm = trial.body(static_cast<std::size_t>(i)).position - pivot(i);
        return std::atan2(arm.x, -arm.y) / degree;
    };
    if (gap > 0) {
        const double highest =
            trial.worst(0.8 * period(30 * degree), [&] { return angle(balls - 1); });
        return std::abs(highest - risen);
    }
    trial.go(0.5 * period(30 * degree));
    double worst = 0;
    for (int i = 0; i < balls; ++i)
        worst = std::max(worst, std::abs(angle(i) - (i >= balls - raised ? risen : 0)));
    return worst;
}

double cradles(const EngineKind &kind, int balls) {
    double worst = 0;
    for (int raised = 1; raised <= 3; ++raised)
        worst = std::max(worst, cradle(kind, balls, raised, 0));
    return worst;
}

// Ten 1 kg links and a 100 kg ball, released at 45 degrees.
double heavy_chain(const EngineKind &kind) {
    SceneDesc scene;
    const glm::dvec3 along(std::sqrt(0.5), -std::sqrt(0.5), 0);
    for (int link = 0; link < 10; ++link) {
        BodyDesc &body = add(scene, "link", CapsuleDesc{0.2, 0.05}, (0.5 * link + 0.25) * along);
        body.mass = 1;
        body.orientation = from_y_to(-along);
        add_joint(scene, JointType::ball, link > 0 ? scene.bodies.size() - 2 : the_world,
                  scene.bodies.size() - 1, 0.5 * link * along);
    }
    add(scene, "weight", SphereDesc{0.4}, 5.4 * along).mass = 100;
    add_joint(scene, JointType::ball, 9, 10, 5.0 * along);
    Trial trial(kind, scene);
    return 1e3 * trial.worst(10, [&] { return trial.measures().joint_drift(trial.states()); });
}

double net(const EngineKind &kind, int side) {
    SceneDesc scene;
    add_net(scene, side, false);
    Trial trial(kind, scene);
    return 1e3 * trial.worst(10, [&] { return trial.measures().joint_drift(trial.states()); });
}

// A plate on a ball joint at its side, spun to precess without sinking: the steady solution of the
// heavy top.
double precession(const EngineKind &kind) {
    SceneDesc scene;
    BodyDesc &plate = add(scene, "plate", BoxDesc{{0.2, 0.02, 0.2}}, {0.3, 0, 0});
    plate.mass = 1;
    plate.orientation = from_y_to({1, 0, 0});
    const double about_axis = (0.16 + 0.16) / 12, spin = 100, round = g * 0.3 / (about_axis * spin);
    plate.angular_velocity = {spin, round, 0};
    plate.velocity = {0, 0, -0.3 * round};
    add_joint(scene, JointType::ball, the_world, 0, {0, 0, 0});
    Trial trial(kind, scene);
    return 1e3 * trial.worst(5, [&] { return std::abs(trial.body(0).position.y); });
}

// A rod spinning about its end.
double spun_rod(const EngineKind &kind) {
    SceneDesc scene;
    BodyDesc &rod = add(scene, "rod", BoxDesc{{0.5, 0.05, 0.05}}, {0.5, 0, 0});
    rod.mass = 1;
    rod.angular_velocity = {0, 50, 0};
    rod.velocity = {0, 0, -25};
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    add_joint(scene, JointType::ball, the_world, 0, {0, 0, 0});
    Trial trial(kind, scene);
    const double begin = trial.energy();
    trial.go(5);
    return 100 * std::abs(trial.energy() / begin - 1);
}

} // namespace

std::vector<Problem> joint_problems() {
    std::vector<Problem> problems{
        {"pendulum_energy", "worst in 60 s from 60 degrees", "%", 0.05, pendulum_energy},
        {"pendulum_period", "mean of 60 s", "%", 0.005,
         [](const EngineKind &kind) { return pendulum_period(kind, 0, Precision::f32); }},
        {"pendulum_far", "the same at 100 km, Plumb in double", "%", 0.005,
         [](const EngineKind &kind) { return pendulum_period(kind, 1e5, Precision::f64); }},
    };
    for (const int balls : {5, 9}) {
        const std::string name = "cradle_" + std::to_string(balls);
        problems.push_back({name, "worst ball, touching, 1 to 3 raised by 30 degrees", "deg", 0.1,
                            [=](const EngineKind &kind) { return cradles(kind, balls); }});
        problems.push_back({name + "_gaps", "last ball, gaps of 1 cm, 1 raised", "deg", 0.1,
                            [=](const EngineKind &kind) { return cradle(kind, balls, 1, 0.01); }});
    }
    problems.push_back(
        {"chain_100", "worst drift in 10 s, the end 100 times as heavy", "mm", 2, heavy_chain});
    for (const int side : {10, 20, 40})
        problems.push_back({"net_" + std::to_string(side), "worst drift in 10 s, by two corners",
                            "mm", 50, [=](const EngineKind &kind) { return net(kind, side); }});
    problems.push_back(
        {"precession", "sinking in 5 s of a plate that goes round", "mm", 5, precession});
    problems.push_back(
        {"spun_rod", "energy after 5 s at 50 rad/s about its end", "%", 0.1, spun_rod});
    return problems;
}

} // namespace plumb
