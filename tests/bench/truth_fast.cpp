// What is fast for its size: it passes through nothing, and strikes nothing that it passes by.
#include "tests/bench/scene_parts.h"
#include "tests/bench/truth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace plumb {

namespace {

using namespace parts;

SceneDesc weightless() {
    SceneDesc scene;
    set_material(scene, 0, 0);
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    return scene;
}

// In how many of so many phases of the step the second body ends behind the first, a wall.
int through(const EngineKind &kind, int phases, double seconds,
            const std::function<void(SceneDesc &, double phase)> &add_bodies) {
    int count = 0;
    for (int i = 0; i < phases; ++i) {
        SceneDesc scene = weightless();
        add_bodies(scene, static_cast<double>(i) / phases);
        Trial trial(kind, scene);
        trial.go(seconds);
        count += trial.body(1).position.x > 0 ? 1 : 0;
    }
    return count;
}

// A ball of 0.2 m against a wall of 5 cm.
double bullet(const EngineKind &kind) {
    return through(kind, 20, 0.2, [](SceneDesc &scene, double phase) {
        add(scene, "wall", BoxDesc{{0.025, 2, 2}}, {0, 0, 0}).kind = BodyKind::fixed;
        add(scene, "ball", SphereDesc{0.2}, {-12 - 300 * phase / 60, 0, 0}).velocity = {300, 0, 0};
    });
}

// A ball at rest before a wall of 1 cm, struck at 20 m/s by one ten times as heavy.
double struck(const EngineKind &kind) {
    return through(kind, 40, 1, [](SceneDesc &scene, double phase) {
        add(scene, "wall", BoxDesc{{0.005, 2, 2}}, {0, 0, 0}).kind = BodyKind::fixed;
        add(scene, "resting", SphereDesc{0.1}, {-0.205, 0, 0}).mass = 1;
        BodyDesc &heavy = add(scene, "heavy", SphereDesc{0.1}, {-0.7 - 20 * phase / 60, 0, 0});
        heavy.mass = 10;
        heavy.velocity = {20, 0, 0};
    });
}

// The largest speed, over 12 phases, of a ball at rest that another passes at 10 m/s, 2 cm aside.
double passing(const EngineKind &kind) {
    double worst = 0;
    for (int phase = 0; phase < 12; ++phase) {
        SceneDesc scene = weightless();
        add(scene, "resting", SphereDesc{0.2}, {0, 0, 0});
        add(scene, "fast", SphereDesc{0.2}, {-1.5 - phase / 72.0, 0.42, 0}).velocity = {10, 0, 0};
        Trial trial(kind, scene);
        trial.go(0.5);
        worst = std::max(worst, glm::length(trial.body(0).velocity));
    }
    return worst;
}

// How often a rod that turns by a quarter a step is wholly beyond a post after that step, of posts
// at 20 angles from 20 to 60 degrees: some engines turn it by less than 80.
double rod(const EngineKind &kind) {
    constexpr double degree = std::numbers::pi / 180, away = 0.7, half = 0.05;
    const double clear = std::asin((half + std::sqrt(2.0) * half) / away);
    int passed = 0;
    for (int i = 0; i < 20; ++i) {
        const double angle = (20 + 40.0 * i / 19) * degree;
        SceneDesc scene = weightless();
        add(scene, "rod", BoxDesc{{1, half, half}}, {0, 0, 0}).angular_velocity = {
            0, 30 * std::numbers::pi, 0};
        add(scene, "post", BoxDesc{{half, 1, half}},
            {away * std::cos(angle), 0, -away * std::sin(angle)})
            .kind = BodyKind::fixed;
        Trial trial(kind, scene);
        trial.go(trial.scene().dt());
        const glm::dvec3 along = trial.body(0).orientation * glm::dvec3(1, 0, 0);
        passed += std::atan2(-along.z, along.x) > angle + clear ? 1 : 0;
    }
    return passed;
}

} // namespace

std::vector<Problem> fast_problems() {
    return {
        {"bullet", "of 20 balls of 0.2 m at 300 m/s, through a wall of 5 cm", "", 0, bullet},
        {"struck", "of 40 balls struck at 20 m/s, through a wall of 1 cm", "", 0, struck},
        {"rod", "of 20 posts, passed by a rod that turns 90 degrees a step", "", 0, rod},
        {"passing", "speed of what is passed by with 2 cm to spare", "m/s", 1e-6, passing},
    };
}

} // namespace plumb
