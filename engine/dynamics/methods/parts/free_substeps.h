// Shared by methods that differ only in how a free body turns.
#pragma once

#include "engine/dynamics/method.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

// All substeps of free bodies: half a kick, half the damping, the move, then the same in reverse
// (Strang 1968, eq. 5; exact under uniform gravity and constant force alone, second order with
// damping). `turn(motion, body, h)` advances rotation and angular velocity by h seconds
// (torque-free); bodies whose spin is constant simply turn by it.
template <typename Turn> void advance_free_bodies(StepContext &context, const Turn &turn) {
    const Real h = context.substep();
    const Vec3 gravity{context.settings.gravity};
    const bool is_attracted = !context.model.attractors.empty();
    for (const std::uint32_t i : context.moving()) {
        SolverBody &motion = context.bodies[i];
        const Body &body = context.model.bodies[i];
        const bool is_dynamic = body.kind == BodyKind::dynamic;
        const Vec3 push = (Real(0.5) * h) * pull_on(body, gravity);
        const Real kept = is_dynamic ? std::exp(Real(-0.5) * h * body.linear_damping) : Real(1);
        const Real spin_kept =
            is_dynamic ? std::exp(Real(-0.5) * h * body.angular_damping) : Real(1);
        const bool is_gyroscopic = is_dynamic && has_gyroscopic_spin(body);
        for (int substep = 0; substep < context.settings.substeps; ++substep) {
            if (is_attracted)
                attract(motion, body, context.model.attractors, Real(0.5) * h);
            motion.velocity = kept * (motion.velocity + push);
            twist(motion, body, Real(0.5) * h);
            motion.angular_velocity *= spin_kept;
            motion.position += h * motion.velocity;
            if (is_gyroscopic)
                turn(motion, body, h);
            else
                motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
            motion.velocity = kept * motion.velocity + push;
            motion.angular_velocity *= spin_kept;
            twist(motion, body, Real(0.5) * h);
            if (is_attracted)
                attract(motion, body, context.model.attractors, Real(0.5) * h);
        }
    }
    context.report.body_passes +=
        context.moving().size() * static_cast<std::size_t>(context.settings.substeps);
}

} // namespace plumb::inline PLUMB_PRECISION
