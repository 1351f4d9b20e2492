// Semi-implicit (symplectic) Euler for free bodies: velocities first, then poses with the new ones.
// First order; keeps energy bounded. Hairer, Lubich, Wanner 2003, "Geometric numerical integration
// illustrated by the Stormer-Verlet method", eq. (1.5).
#include "engine/dynamics/method.h"
#include "engine/dynamics/motion.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance(StepContext &context) {
    const StepSettings &settings = context.settings;
    const auto h = static_cast<Real>(settings.dt / settings.substeps);
    const Vec3 gravity{settings.gravity};
    context.report.body_passes +=
        context.moving().size() * static_cast<std::size_t>(settings.substeps);
    for (int substep = 0; substep < settings.substeps; ++substep)
        for (const std::uint32_t i : context.moving()) {
            const Body &body = context.model.bodies[i];
            SolverBody &motion = context.bodies[i];
            if (body.kind == BodyKind::dynamic) {
                motion.velocity +=
                    h * (gravity_on(body, gravity) - body.linear_damping * motion.velocity);
                // Euler's equations in world axes: w' = -I^-1 (w x I w).
                Vec3 torque_free{Real(0)};
                if (has_gyroscopic_spin(body)) {
                    const Vec3 momentum =
                        spin_momentum(motion.rotation, body.inertia, motion.angular_velocity);
                    torque_free =
                        -(motion.inv_inertia * glm::cross(motion.angular_velocity, momentum));
                }
                motion.angular_velocity +=
                    h * (torque_free - body.angular_damping * motion.angular_velocity);
            }
            motion.position += h * motion.velocity;
            motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
            motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
        }
}

} // namespace

Method semi_implicit_euler() {
    return {{.name = "semi_implicit_euler",
             .title = "Semi-implicit Euler",
             .source = "Hairer, Lubich, Wanner 2003",
             .contacts = false,
             .joints = false,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
