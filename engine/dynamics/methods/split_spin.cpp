// Free bodies whose spin is split into turns about their principal axes (McLachlan 1993, "Explicit
// Lie-Poisson Integration and the Euler Equations"; Touma and Wisdom 1994, "Lie-Poisson Integrators
// for Rigid Body Dynamics in the Solar System"; Hairer, Lubich, Wanner 2006, "Geometric Numerical
// Integration", sec. VII.5.3). Second order and symplectic: the energy error is of the order of the
// step squared and does not grow; world angular momentum is conserved up to rounding. Explicit.
#include "engine/dynamics/methods/parts/free_substeps.h"

#include <array>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The flow of the kinetic energy's part M_k^2 / (2 I_k) over h: the body turns about its axis k by
// h M_k / I_k, and its angular momentum M, in body axes, by the same angle the other way (Hairer,
// Lubich, Wanner 2006, sec. VII.5.3, "Splitting Methods").
void turn_about(std::size_t k, const Body &body, Real h, Quat &rotation, Vec3 &momentum) {
    const int a = static_cast<int>((k + 1) % 3);
    const int b = static_cast<int>((k + 2) % 3);
    const int axis = static_cast<int>(k);
    const Real half_angle = Real(0.5) * h * momentum[axis] * body.inv_inertia[axis];
    const Real s = std::sin(half_angle);
    const Real c = std::cos(half_angle);
    Vec3 part{Real(0)};
    part[axis] = s;
    rotation = rotation * Quat{c, part.x, part.y, part.z};
    // By the double angle, as changes to M by 1 - cos and sin: small when the turn is.
    const Real less = Real(2) * s * s;
    const Real sine = Real(2) * s * c;
    const Real before = momentum[a];
    momentum[a] += sine * momentum[b] - less * before;
    momentum[b] -= sine * before + less * momentum[b];
}

// Strang's composition: half of the first and second, all of the third, then back.
void split_turn(SolverBody &motion, const Body &body, Real h) {
    struct Part {
        std::size_t axis;
        Real share;
    };
    constexpr std::array<Part, 5> parts{
        {{0, Real(0.5)}, {1, Real(0.5)}, {2, Real(1)}, {1, Real(0.5)}, {0, Real(0.5)}}};
    Vec3 momentum =
        body.inertia * rotated(glm::conjugate(motion.rotation), motion.angular_velocity);
    for (const Part &part : parts)
        turn_about(part.axis, body, part.share * h, motion.rotation, momentum);
    motion.rotation = glm::normalize(motion.rotation);
    motion.angular_velocity = rotated(motion.rotation, body.inv_inertia * momentum);
}

void advance_split_spin(StepContext &context) {
    advance_free_bodies(context, split_turn);
}

} // namespace

Method split_spin() {
    return {{.name = "split_spin",
             .title = "Split spin",
             .source = "McLachlan 1993",
             .contacts = false,
             .joints = false,
             .springs = false,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_split_spin};
}

} // namespace plumb::inline PLUMB_PRECISION
