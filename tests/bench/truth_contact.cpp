// Bodies that bounce, roll and ride on others.
#include "tests/bench/scene_parts.h"
#include "tests/bench/truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace plumb {

namespace {

using namespace parts;

constexpr double g = 9.81;

struct Motion {
    glm::dvec3 velocity{0}, spin{0}; // m/s, rad/s
};

// After a ball of radius `r` has hit the ground, by Newton's and Coulomb's laws at a single point:
// friction ends the sliding, as 2/7 of m times its speed does, or is all that the blow allows.
Motion bounced(const Motion &before, double r, double friction, double restitution) {
    const glm::dvec3 arm(0, -r, 0);
    glm::dvec3 sliding = before.velocity + glm::cross(before.spin, arm);
    sliding.y = 0;
    const double blow = -before.velocity.y * (1 + restitution); // per kg
    glm::dvec3 rub = -2.0 / 7 * sliding;
    if (glm::length(rub) > friction * blow)
        rub *= friction * blow / glm::length(rub);
    Motion after{before.velocity + rub, before.spin + glm::cross(arm, rub) / (0.4 * r * r)};
    after.velocity.y = -restitution * before.velocity.y;
    return after;
}

// Balls of 0.2 m that hit the ground at 20 m/s, askew and spinning: the worst error of what they
// leave with, in velocity or in spin times radius, as a share of the speed (%).
double spin_bounce(const EngineKind &kind) {
    constexpr double speed = 20, r = 0.2;
    std::mt19937 bits(3);
    const auto any = [&] { return 2 * (static_cast<double>(bits()) / 4294967295.0) - 1; };
    double worst = 0;
    for (int i = 0; i < 36; ++i) {
        const double friction = 0.3 + 0.25 * (i % 3), restitution = 0.5 * (i / 3 % 3);
        const Motion before{{0.8 * speed * any(), -speed, 0.8 * speed * any()},
                            0.7 * speed / r * glm::dvec3(any(), any(), any())};
        SceneDesc scene = on_ground();
        scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
        set_material(scene, friction, restitution);
        BodyDesc &ball =
            add(scene, "ball", SphereDesc{r}, {0, r + speed * (0.04 + 0.02 * any()), 0});
        ball.velocity = before.velocity;
        ball.angular_velocity = before.spin;
        Trial trial(kind, scene);
        trial.go(0.2);
        const Motion truth = bounced(before, r, friction, restitution);
        worst = std::max({worst, glm::distance(trial.body(1).velocity, truth.velocity),
                          r * glm::distance(trial.body(1).angular_velocity, truth.spin)});
    }
    return 100 * worst / speed;
}

// Where a ball that starts to roll at `start` (rad off the top) leaves a fixed ball, rolling and
// then sliding, in rad: Newton's and Coulomb's laws, by the midpoint rule in 10 us steps. `way` is
// how far apart their centres are (m).
double leaves_at(double start, double way, double friction) {
    double angle = start, rate = 0;
    bool slides = false;
    const auto pressed = [&](double a, double w) { return g * std::cos(a) - way * w * w; };
    const auto pull = [&](double a, double w) {
        const double along = g * std::sin(a);
        return (slides ? along - friction * pressed(a, w) : 5.0 / 7 * along) / way;
    };
    constexpr double h = 1e-5;
    while (pressed(angle, rate) > 0) {
        slides = slides || 2.0 / 7 * g * std::sin(angle) > friction * pressed(angle, rate);
        const double middle = rate + 0.5 * h * pull(angle, rate);
        rate += h * pull(angle + 0.5 * h * rate, middle);
        angle += h * middle;
    }
    return angle;
}

// The error (degrees) of where a ball of 0.2 m leaves one of 1 m. In flight its level speed is that
// of the moment it left, when gravity alone held it: v^2 = g l cos a.
double off_sphere(const EngineKind &kind) {
    constexpr double start = 0.1, way = 1.2, friction = 0.5, degree = std::numbers::pi / 180;
    SceneDesc scene;
    set_material(scene, friction, 0);
    add(scene, "fixed", SphereDesc{1}, {0, 0, 0}).kind = BodyKind::static_body;
    add(scene, "ball", SphereDesc{0.2}, way * glm::dvec3(std::sin(start), std::cos(start), 0));
    Trial trial(kind, scene);
    double level = 0;
    trial.go(5, [&] {
        if (level == 0 && glm::length(trial.body(1).position) > way + 0.02)
            level = trial.body(1).velocity.x;
    });
    const double cosine = std::min(1.0, std::cbrt(level * level / (g * way)));
    return std::abs(std::acos(cosine) - leaves_at(start, way, friction)) / degree;
}

// A box that rides 1 m off the middle of a turntable, held by 0.82 of the friction there is: how
// far it is after 10 s from where it should be (mm).
double turntable(const EngineKind &kind) {
    const double spin = std::sqrt(0.82 * 0.5 * g);
    SceneDesc scene;
    set_material(scene, 0.5, 0);
    BodyDesc &table = add(scene, "table", BoxDesc{{3, 0.1, 3}}, {0, -0.1, 0});
    table.kind = BodyKind::kinematic;
    table.angular_velocity = {0, spin, 0};
    BodyDesc &rider = add(scene, "rider", BoxDesc{{0.05, 0.02, 0.05}}, {1, 0.02, 0});
    rider.velocity = {0, 0, -spin};
    rider.angular_velocity = {0, spin, 0};
    Trial trial(kind, scene);
    trial.go(10);
    const double turned = spin * trial.time();
    return 1e3 * glm::distance(trial.body(1).position,
                               glm::dvec3(std::cos(turned), 0.02, -std::sin(turned)));
}

// A ball that rolls over the seams of flush tiles: how far its speed is off (%) after 45 of them.
double rolls_over_seams(const EngineKind &kind, double speed) {
    SceneDesc scene;
    set_material(scene, 0.5, 0);
    for (int i = 0; i < 50; ++i)
        add(scene, "tile", BoxDesc{{0.5, 0.25, 1}}, {i, -0.25, 0}).kind = BodyKind::static_body;
    BodyDesc &ball = add(scene, "ball", SphereDesc{0.2}, {0, 0.2, 0.01});
    ball.velocity = {speed, 0, 0};
    ball.angular_velocity = {0, 0, -speed / 0.2};
    Trial trial(kind, scene);
    trial.go(45 / speed);
    return 100 * std::abs(trial.body(50).velocity.x / speed - 1);
}

} // namespace

std::vector<Problem> contact_problems() {
    return {
        {"spin_bounce", "velocity and spin of balls bounced at 20 m/s, worst of 36", "%", 1,
         spin_bounce},
        {"off_sphere", "where a ball that rolls off another leaves it", "deg", 0.1, off_sphere},
        {"turntable", "place after 10 s at 0.82 of what friction holds", "mm", 0.1, turntable},
        {"tiles_1", "speed of a ball after 45 seams at 1 m/s", "%", 0.1,
         [](const EngineKind &kind) { return rolls_over_seams(kind, 1); }},
        {"tiles_10", "the same at 10 m/s", "%", 0.1,
         [](const EngineKind &kind) { return rolls_over_seams(kind, 10); }},
    };
}

} // namespace plumb
