// Bodies that are fast for their size: no tunnelling, and no ghost hits on bodies they pass by.
#include "tests/bench/scene_parts.h"
#include "tests/bench/truth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace plumb {

namespace {

using namespace parts;

SceneDesc weightless() {
    SceneDesc scene;
    set_material(scene, 0, 0);
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    return scene;
}

// In how many of `phases` step phases the second body ends up behind the first, a wall.
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

// A ball of radius 0.2 m against a 5 cm wall.
double bullet(const EngineKind &kind) {
    return through(kind, 20, 0.2, [](SceneDesc &scene, double phase) {
        add(scene, "wall", BoxDesc{{0.025, 2, 2}}, {0, 0, 0}).kind = BodyKind::static_body;
        add(scene, "ball", SphereDesc{0.2}, {-12 - 300 * phase / 60, 0, 0}).velocity = {300, 0, 0};
    });
}

// A ball at rest in front of a 1 cm wall, hit at 20 m/s by one ten times as heavy.
double struck(const EngineKind &kind) {
    return through(kind, 40, 1, [](SceneDesc &scene, double phase) {
        add(scene, "wall", BoxDesc{{0.005, 2, 2}}, {0, 0, 0}).kind = BodyKind::static_body;
        add(scene, "resting", SphereDesc{0.1}, {-0.205, 0, 0}).mass = 1;
        BodyDesc &heavy = add(scene, "heavy", SphereDesc{0.1}, {-0.7 - 20 * phase / 60, 0, 0});
        heavy.mass = 10;
        heavy.velocity = {20, 0, 0};
    });
}

// Boxes of 4 x 10 x 20 cm, turned anyhow, that fly at a 1 cm wall askew.
double thrown(const EngineKind &kind, double speed) {
    std::mt19937 bits(5);
    const auto any = [&] { return 2 * (static_cast<double>(bits()) / 4294967295.0) - 1; };
    return through(kind, 40, 9 / speed, [&](SceneDesc &scene, double) {
        set_material(scene, 0.3, 0);
        add(scene, "wall", BoxDesc{{0.005, 50, 50}}, {0, 0, 0}).kind = BodyKind::static_body;
        const glm::dvec3 way = glm::normalize(glm::dvec3(std::abs(any()) + 0.3, any(), any()));
        BodyDesc &box = add(scene, "box", BoxDesc{{0.05, 0.1, 0.02}}, -(3.5 + 0.5 * any()) * way);
        box.orientation = glm::normalize(glm::dquat(any(), any(), any(), any()));
        box.velocity = speed * way;
    });
}

// The largest speed, over 12 phases, of a resting ball that another passes with that clearance (m).
double passing(const EngineKind &kind, double speed, double clearance) {
    double worst = 0;
    for (int phase = 0; phase < 12; ++phase) {
        SceneDesc scene = weightless();
        add(scene, "resting", SphereDesc{0.2}, {0, 0, 0});
        add(scene, "fast", SphereDesc{0.2}, {-1.5 - speed * phase / 720, 0.4 + clearance, 0})
            .velocity = {speed, 0, 0};
        Trial trial(kind, scene);
        trial.go(5 / speed);
        worst = std::max(worst, glm::length(trial.body(0).velocity));
    }
    return worst;
}

// A rod turning 90 degrees a step: how often it is past a post after that step, for posts at 20
// angles from 20 to 60 degrees. A rod that hits the post turns on about it and stays on the near
// side.
double rod(const EngineKind &kind) {
    constexpr double degree = std::numbers::pi / 180, away = 0.7, half = 0.05;
    int passed = 0;
    for (int i = 0; i < 20; ++i) {
        const double angle = (20 + 40.0 * i / 19) * degree;
        const glm::dvec3 post{away * std::cos(angle), 0, -away * std::sin(angle)};
        SceneDesc scene = weightless();
        add(scene, "rod", BoxDesc{{1, half, half}}, {0, 0, 0}).angular_velocity = {
            0, 30 * std::numbers::pi, 0};
        add(scene, "post", BoxDesc{{half, 1, half}}, post).kind = BodyKind::static_body;
        Trial trial(kind, scene);
        trial.go(trial.scene().dt());
        const glm::dvec3 ahead = trial.body(0).orientation * glm::dvec3(0, 0, -1);
        passed += glm::dot(post - trial.body(0).position, ahead) < 0 ? 1 : 0;
    }
    return passed;
}

// A ball hits a resting one at 20 m/s, off centre by `offset` of their diameter; both have radius
// 0.1 m and mass 1 kg. Impact comes `phase` of a step later than at phase 0. Returns what `measure`
// gives afterwards.
template <typename Measure>
double after_collision(const EngineKind &kind, double friction, double restitution, double offset,
                       double phase, const Measure &measure) {
    SceneDesc scene = weightless();
    set_material(scene, friction, restitution);
    add(scene, "resting", SphereDesc{0.1}, {0, 0, 0}).mass = 1;
    const double before = 0.2 * std::sqrt(1 - offset * offset) + 20 * (3 + phase) / 60;
    BodyDesc &striker = add(scene, "striker", SphereDesc{0.1}, {-before, 0.2 * offset, 0});
    striker.mass = 1;
    striker.velocity = {20, 0, 0};
    Trial trial(kind, scene);
    trial.go(0.2);
    return measure(trial);
}

constexpr int phases = 12;

template <typename Error> double worst_collision(const Error &error) {
    double worst = 0;
    for (const double offset : {0.1, 0.3, 0.5, 0.7, 0.9})
        for (int i = 0; i < phases; ++i)
            worst = std::max(worst, error(offset, static_cast<double>(i) / phases));
    return worst;
}

// Smooth and elastic: the struck ball leaves along the line of centres, the other at right angles
// to it. Returns the larger of the two angle errors, in degrees.
double oblique(const EngineKind &kind) {
    return worst_collision([&](double offset, double phase) {
        return after_collision(kind, 0, 1, offset, phase, [&](const Trial &trial) {
            const double along = std::asin(offset);
            const auto off = [&](std::size_t body, double truth) {
                const glm::dvec3 &v = trial.body(body).velocity;
                return std::abs(std::remainder(std::atan2(v.y, v.x) - truth, 2 * std::numbers::pi));
            };
            return std::max(off(0, -along), off(1, 0.5 * std::numbers::pi - along)) * 180 /
                   std::numbers::pi;
        });
    });
}

// Rough balls with restitution 0.5: the error of the angular momentum about the origin, against
// that before the impact (%).
double oblique_momentum(const EngineKind &kind) {
    return 100 * worst_collision([&](double offset, double phase) {
               return after_collision(kind, 0.5, 0.5, offset, phase, [&](const Trial &trial) {
                   // About the resting ball's centre, which is the origin.
                   const double before = -20 * 0.2 * offset;
                   return std::abs(trial.angular_momentum().z / before - 1);
               });
           });
}

// 36 elastic, frictionless boxes in a 4 m room without gravity: the worst energy error (%).
double gas(const EngineKind &kind) {
    SceneDesc scene = weightless();
    set_material(scene, 0, 1);
    for (int side = 0; side < 6; ++side) {
        glm::dvec3 away(0), half(3);
        away[side / 2] = side % 2 == 0 ? 2.5 : -2.5;
        half[side / 2] = 0.5;
        add(scene, "wall", BoxDesc{half}, away).kind = BodyKind::static_body;
    }
    std::mt19937 bits(11);
    const auto any = [&] { return 6 * (static_cast<double>(bits()) / 4294967295.0) - 3; };
    for (int i = 0; i < 36; ++i) {
        BodyDesc &box =
            add(scene, "box", BoxDesc{{0.15, 0.1, 0.2}},
                {-1.2 + 0.8 * (i % 4), -0.8 + 0.8 * (i / 4 % 3), -0.8 + 0.8 * (i / 12)});
        box.mass = 1;
        for (int axis = 0; axis < 3; ++axis) {
            box.velocity[axis] = any();
            box.angular_velocity[axis] = any();
        }
    }
    Trial trial(kind, scene);
    const double before = trial.energy();
    return 100 * trial.worst(60, [&] { return std::abs(trial.energy() / before - 1); });
}

} // namespace

std::vector<Problem> fast_problems() {
    return {
        {"bullet", "of 20 balls of 0.2 m at 300 m/s, through a wall of 5 cm", "", 0, bullet},
        {"struck", "of 40 balls struck at 20 m/s, through a wall of 1 cm", "", 0, struck},
        {"rod", "of 20 posts, passed by a rod that turns 90 degrees a step", "", 0, rod},
        {"thrown_30", "of 40 boxes thrown at 30 m/s, through a wall of 1 cm", "", 0,
         [](const EngineKind &kind) { return thrown(kind, 30); }},
        {"thrown_100", "the same at 100 m/s", "", 0,
         [](const EngineKind &kind) { return thrown(kind, 100); }},
        {"passing", "speed of what is passed by at 10 m/s with 2 cm to spare", "m/s", 1e-6,
         [](const EngineKind &kind) { return passing(kind, 10, 0.02); }},
        {"passing_slow", "the same at 2 m/s with 1 mm to spare", "m/s", 1e-6,
         [](const EngineKind &kind) { return passing(kind, 2, 0.001); }},
        {"passing_fast", "the same at 50 m/s with 20 cm to spare", "m/s", 1e-6,
         [](const EngineKind &kind) { return passing(kind, 50, 0.2); }},
        {"oblique", "directions of smooth elastic balls after 20 m/s, worst of 60", "deg", 0.1,
         oblique},
        {"oblique_momentum", "angular momentum of rough balls after 20 m/s", "%", 0.1,
         oblique_momentum},
        {"gas", "worst energy in 60 s of 36 elastic boxes", "%", 0.1, gas},
    };
}

} // namespace plumb
