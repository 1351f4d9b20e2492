// What joints press together goes on turning: loads that bodies put on each other neither turn nor
// stop the whole.
#include "tests/dynamics/worlds.h"

#include <cmath>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

constexpr double size = 0.1;
// Below the jaws, whose middle is the world's origin.
constexpr V beam_at{0, -2 * size, 0};

enum class Held { freely, by_a_point, by_two_points };

struct Clamp {
    std::string name;
    Shape between;
    bool has_round_jaws = false;
    bool has_hinges = false; // the jaws have; their limits hold them
    double restitution = 0;
};

struct Outcome {
    double energy = 0;        // of what it was
    double most_gained = 0;   // J
    double momentum_lost = 0; // angular, of what it was
};

// Two jaws on a beam, each 1 mm too close to what is between them, spin.
Outcome spin(const Clamp &clamp, Held held, double rate, double dt) {
    StepSettings settings = weightless(settings_for("soft_step"));
    settings.dt = dt;
    World world("soft_step", settings);
    const V axis = rate * glm::normalize(V{0.3, 0.2, 1});
    const V pivot = beam_at - V{0, 0, size};
    const auto add = [&](const Shape &shape, double mass, const V &at) {
        const V arm = held == Held::freely ? at : at - pivot;
        BodyDef def = dynamic_body(shape, mass, at, glm::cross(axis, arm));
        def.angular_velocity = narrow(axis);
        return world.add_body(with_material(def, 0.5, clamp.restitution));
    };
    const auto join = [&](BodyId a, BodyId b, const V &at) {
        JointDef joint;
        joint.a = a;
        joint.b = b;
        joint.anchor_a_local = narrow(at - position_of(world, a));
        joint.anchor_b_local = narrow(at - position_of(world, b));
        joint.type = clamp.has_hinges ? JointType::hinge : JointType::fixed;
        if (clamp.has_hinges) {
            joint.frame_a_local = joint.frame_b_local = narrow(glm::angleAxis(pi / 2, V{0, -1, 0}));
            joint.limits = {Real(0), Real(0)};
        }
        world.add_joint(joint);
    };
    const BodyId beam = add(block(size * V{2.5, 0.2, 1}), 2, beam_at);
    for (const double side : {-1.0, 1.0}) {
        const Shape jaw =
            clamp.has_round_jaws
                ? Shape(Capsule{narrow(V{0, 0, -size}), narrow(V{0, 0, size}), Real(0.5 * size)})
                : Shape(block(size * V{0.5, 1.7, 1}));
        join(beam, add(jaw, 1, V{side * 1.49 * size, 0, 0}), size * V{2 * side, -1.9, 0});
    }
    add(clamp.between, 1, size * V{0, clamp.has_round_jaws ? 0 : 0.3, 0.2});
    const auto hang = [&](const V &at) {
        JointDef joint;
        joint.a = beam;
        joint.anchor_a_local = narrow(at - beam_at);
        joint.anchor_b_local = narrow(at);
        world.add_joint(joint);
    };
    if (held != Held::freely)
        hang(pivot);
    if (held == Held::by_two_points)
        hang(pivot + size * glm::normalize(axis));
    const double energy = world.energy();
    const V momentum = world.measure().angular_momentum;
    Outcome out;
    for (int step = 0; step < 3 / dt; ++step) {
        world.step(nullptr);
        out.most_gained = std::max(out.most_gained, world.energy() - energy);
    }
    out.energy = world.energy() / energy;
    out.momentum_lost =
        glm::length(world.measure().angular_momentum - momentum) / glm::length(momentum);
    return out;
}

// With arms held for the step a ball between jaws took on 1e5 times its energy, and a box lost four
// fifths of it.
TEST(Clamps, TurnOn) {
    const Shape box = block(size * V{1, 0.5, 1.5});
    const Shape roll = Cylinder{narrow(V{0, 0, -size}), narrow(V{0, 0, size}), Real(size)};
    const Shape pill = Capsule{narrow(V{0, 0, -size}), narrow(V{0, 0, size}), Real(size)};
    const Clamp clamps[] = {
        {.name = "box", .between = box},
        {.name = "bouncing box", .between = box, .restitution = 0.5},
        {.name = "box by hinges", .between = box, .has_hinges = true},
        {.name = "ball", .between = ball(size)},
        {.name = "ball by hinges", .between = ball(size), .has_hinges = true},
        {.name = "cylinder", .between = roll},
        {.name = "ball by round jaws", .between = ball(size), .has_round_jaws = true},
        {.name = "capsule by round jaws", .between = pill, .has_round_jaws = true}};
    for (const Clamp &clamp : clamps)
        for (const Held held : {Held::freely, Held::by_a_point})
            for (const double rate : {4.0, 15.0}) {
                const double dt = rate < 10 ? 1.0 / 60 : 1.0 / 30;
                const Outcome out = spin(clamp, held, rate, dt);
                const std::string what =
                    clamp.name + ", held " + std::to_string(static_cast<int>(held)) + ", " +
                    std::to_string(rate) + " rad/s, " + std::to_string(1 / dt) + " Hz";
                EXPECT_GT(out.energy, 0.7) << what;
                EXPECT_LT(out.energy, 1.1) << what;
                EXPECT_LT(out.most_gained, 5) << what; // what presses them stores some
                if (held == Held::freely) {
                    EXPECT_LT(out.momentum_lost, 0.03) << what;
                }
            }
}

// A door on two hinges is hung by one body, whose joints' loads come from outside.
TEST(Clamps, OnADoorTurnOn) {
    for (const bool has_hinges : {false, true})
        for (const double rate : {4.0, 15.0, 30.0})
            for (const double dt : {1.0 / 30, 1.0 / 60}) {
                const Outcome out =
                    spin({.name = "ball", .between = ball(size), .has_hinges = has_hinges},
                         Held::by_two_points, rate, dt);
                EXPECT_GT(out.energy, 0.9) << has_hinges << ' ' << rate << ' ' << dt;
                EXPECT_LT(out.most_gained, 0.1) << has_hinges << ' ' << rate << ' ' << dt;
            }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
