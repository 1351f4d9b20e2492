// The classical fourth-order Runge-Kutta method for free bodies (Kutta 1901; Hairer, Norsett,
// Wanner 1993, "Solving Ordinary Differential Equations I", table II.1.2), on position, velocity,
// orientation and spin.
#include "engine/dynamics/method.h"
#include "engine/dynamics/motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The state of one free body, or its rate of change. Spin in the body's principal axes, where the
// inertia is constant.
struct FreeState {
    Vec3 position{Real(0)};
    Vec3 velocity{Real(0)};
    Quat rotation{Real(0), Real(0), Real(0), Real(0)};
    Vec3 spin{Real(0)};
};

FreeState operator+(const FreeState &state, const FreeState &change) {
    return {state.position + change.position, state.velocity + change.velocity,
            state.rotation + change.rotation, state.spin + change.spin};
}

FreeState operator*(Real scale, const FreeState &rate) {
    return {scale * rate.position, scale * rate.velocity, scale * rate.rotation, scale * rate.spin};
}

FreeState rate_of(const FreeState &state, const Body &body, const Vec3 &gravity) {
    const Vec3 torque_free =
        has_gyroscopic_spin(body)
            ? -body.inv_inertia * glm::cross(state.spin, body.inertia * state.spin)
            : Vec3{Real(0)};
    // q' = q (0, w) / 2 with w in the body's axes.
    const Quat turning =
        Real(0.5) * (state.rotation * Quat{Real(0), state.spin.x, state.spin.y, state.spin.z});
    return {state.velocity, gravity - body.linear_damping * state.velocity, turning,
            torque_free - body.angular_damping * state.spin};
}

void advance(StepContext &context) {
    const StepSettings &settings = context.settings;
    const auto h = static_cast<Real>(settings.dt / settings.substeps);
    context.report.body_passes +=
        4 * context.moving().size() * static_cast<std::size_t>(settings.substeps);
    for (int substep = 0; substep < settings.substeps; ++substep)
        for (const std::uint32_t i : context.moving()) {
            const Body &body = context.model.bodies[i];
            SolverBody &motion = context.bodies[i];
            if (body.kind == BodyKind::kinematic) {
                motion.position += h * motion.velocity;
                motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
            }
            if (body.kind != BodyKind::dynamic)
                continue;
            const Vec3 gravity = gravity_on(body, Vec3{settings.gravity});
            const FreeState start{
                motion.position, motion.velocity, motion.rotation,
                rotated(glm::conjugate(motion.rotation), motion.angular_velocity)};
            const FreeState k1 = rate_of(start, body, gravity);
            const FreeState k2 = rate_of(start + (h / 2) * k1, body, gravity);
            const FreeState k3 = rate_of(start + (h / 2) * k2, body, gravity);
            const FreeState k4 = rate_of(start + h * k3, body, gravity);
            const FreeState end = start + (h / 6) * (k1 + Real(2) * k2 + Real(2) * k3 + k4);
            motion.position = end.position;
            motion.velocity = end.velocity;
            motion.rotation = glm::normalize(end.rotation);
            motion.angular_velocity = rotated(motion.rotation, end.spin);
            motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
        }
}

} // namespace

Method rk4() {
    return {{.name = "rk4",
             .title = "Runge-Kutta 4",
             .source = "Kutta 1901",
             .contacts = false,
             .joints = false,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
