// Free bodies and bodies on a plane.
#include "tests/bench/scene_parts.h"
#include "tests/bench/truth.h"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

using namespace parts;

constexpr double g = 9.81;

void set_gravity(SceneDesc &scene, const glm::dvec3 &gravity) {
    scene.world.settings.give(&StepSettings::gravity, gravity);
}

double projectile(const EngineKind &kind) {
    SceneDesc scene;
    add(scene, "ball", SphereDesc{0.1}, {0, 0, 0}).velocity = {10, 10, 0};
    Trial trial(kind, scene);
    trial.go(2);
    return 1e3 * glm::distance(trial.body(0).position, glm::dvec3(20, 20 - 2 * g, 0));
}

// Error of the energy after elastic bounces (%). The energy is that of the parabola through three
// poses between two bounces: exact for any integrator that moves along parabolas, whatever
// velocities it reports.
double bounce(const EngineKind &kind) {
    SceneDesc scene = on_ground();
    set_material(scene, 0, 1);
    add(scene, "ball", SphereDesc{0.5}, {0, 5.5, 0});
    Trial trial(kind, scene);
    const double dt = trial.scene().dt();
    double before = 5.5, between = 5.5, energy = 0;
    trial.go(10, [&] {
        const double now = trial.body(1).position.y;
        const double bend = (before - 2 * between + now) / (dt * dt);
        if (std::abs(bend + g) < 0.05 * g) {
            const double speed = (now - before) / (2 * dt);
            energy = 0.5 * speed * speed + g * (between - 0.5);
        }
        before = between;
        between = now;
    });
    return 100 * std::abs(energy / (5 * g) - 1);
}

// How far (m) a 1 m box with friction 0.5 slides along the unit vector (x, z) on a slope
// `steepness` times as steep as friction can hold. Gravity is tilted, not the slope.
double slid(const EngineKind &kind, double steepness, double x, double z, double seconds) {
    SceneDesc scene = on_ground();
    add(scene, "box", BoxDesc{}, {0, 0.5, 0});
    const double angle = std::atan(0.5 * steepness);
    set_gravity(scene, {g * std::sin(angle) * x, -g * std::cos(angle), g * std::sin(angle) * z});
    Trial trial(kind, scene);
    trial.go(seconds);
    const glm::dvec3 at = trial.body(1).position;
    return x * at.x + z * at.z;
}

double slope_holds(const EngineKind &kind) {
    return 1e3 * std::abs(slid(kind, 0.9, 1, 0, 5));
}

double slope_slides(const EngineKind &kind) {
    const double angle = std::atan(0.55);
    const double truth = 0.5 * g * (std::sin(angle) - 0.5 * std::cos(angle)) * 9;
    return 100 * std::abs(slid(kind, 1.1, 1, 0, 3) / truth - 1);
}

double slides_at_45(const EngineKind &kind) {
    const double along = slid(kind, 1.5, 1, 0, 2);
    const double across = slid(kind, 1.5, std::sqrt(0.5), std::sqrt(0.5), 2);
    return 100 * std::abs(across / along - 1);
}

double rolling(const EngineKind &kind) {
    SceneDesc scene = on_ground();
    add(scene, "ball", SphereDesc{0.5}, {0, 0.5, 0}).velocity = {5, 0, 0};
    Trial trial(kind, scene);
    trial.go(2);
    return std::abs(trial.body(1).velocity.x / (5.0 * 5 / 7) - 1);
}

// A book with three different sides, spun about its middle axis.
SceneDesc spinning_book() {
    SceneDesc scene;
    BodyDesc &book = add(scene, "book", BoxDesc{{0.11, 0.02, 0.15}}, {0, 0, 0});
    book.mass = 1;
    book.angular_velocity = {6, 0, 0.5};
    set_gravity(scene, {0, 0, 0});
    return scene;
}

double spin_energy(const EngineKind &kind) {
    Trial trial(kind, spinning_book());
    const double begin = trial.energy();
    return trial.worst(60, [&] { return std::abs(trial.energy() / begin - 1); });
}

double spin_momentum(const EngineKind &kind) {
    Trial trial(kind, spinning_book());
    const glm::dvec3 begin = trial.angular_momentum();
    return trial.worst(
        60, [&] { return glm::distance(trial.angular_momentum(), begin) / glm::length(begin); });
}

// Error in how often the book turns over, against Euler's equations by RK4 in 0.1 ms steps.
double spin_flips(const EngineKind &kind) {
    Trial trial(kind, spinning_book());
    const glm::dvec3 inertia = trial.scene().masses[0].inertia;
    const auto rate = [&](const glm::dvec3 &w) { return -glm::cross(w, inertia * w) / inertia; };
    glm::dvec3 w(6, 0, 0.5);
    constexpr double h = 1e-4;
    int truth = 0;
    for (int i = 0; i < 600'000; ++i) {
        const double sign = w.x;
        const glm::dvec3 a = rate(w), b = rate(w + 0.5 * h * a), c = rate(w + 0.5 * h * b),
                         d = rate(w + h * c);
        w += h / 6 * (a + 2.0 * b + 2.0 * c + d);
        truth += sign * w.x < 0 ? 1 : 0;
    }
    int flips = 0;
    double before = 6;
    trial.go(60, [&] {
        const BodyState &book = trial.body(0);
        const double now = (glm::conjugate(book.orientation) * book.angular_velocity).x;
        flips += before * now < 0 ? 1 : 0;
        before = now;
    });
    return std::abs(flips - truth);
}

// A frictionless box sliding over the seams of flush tiles.
double seams(const EngineKind &kind) {
    SceneDesc scene;
    set_material(scene, 0, 0);
    for (int i = 0; i < 50; ++i)
        add(scene, "tile", BoxDesc{{0.5, 0.25, 1}}, {i, -0.25, 0}).kind = BodyKind::static_body;
    BodyDesc &box = add(scene, "box", BoxDesc{{0.2, 0.2, 0.2}}, {0, 0.2, 0.01});
    box.velocity = {2, 0, 0};
    Trial trial(kind, scene);
    trial.go(20);
    return 100 * std::abs(trial.body(50).velocity.x / 2 - 1);
}

} // namespace

std::vector<Problem> motion_problems() {
    return {
        {"projectile", "place after 2 s", "mm", 0.05, projectile},
        {"bounce", "energy after 10 s of elastic bounces", "%", 0.01, bounce},
        {"slope_holds", "creep in 5 s at 0.9 of the slope that holds", "mm", 0.01, slope_holds},
        {"slope_slides", "distance in 3 s at 1.1 of it", "%", 0.2, slope_slides},
        {"slides_at_45", "distance at 45 degrees against along an axis", "%", 1, slides_at_45},
        {"rolling", "speed against 5/7 of that of sliding", "", 2e-6, rolling},
        {"spin_energy", "worst in 60 s about the middle axis", "", 1e-4, spin_energy},
        {"spin_momentum", "worst angular momentum in 60 s", "", 1e-4, spin_momentum},
        {"spin_flips", "times turned over in 60 s, against Euler's equations", "", 0, spin_flips},
        {"seams", "speed after 40 seams without friction", "%", 0.1, seams},
    };
}

} // namespace plumb
