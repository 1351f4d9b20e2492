#include "engine/dynamics/attractor.h"

#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

void attract_bodies(StepContext &context, Real h) {
    if (context.model.attractors.empty())
        return;
    for (const std::uint32_t i : context.moving())
        attract(context.bodies[i], context.model.bodies[i], context.model.attractors, h);
    context.report.body_passes += context.moving().size();
}

void attract_particles(StepContext &context, Real h) {
    if (context.model.attractors.empty())
        return;
    for (std::size_t i = 0; i < context.particles.size(); ++i)
        if (context.model.particles[i].inv_mass > Real(0))
            context.particles[i].velocity +=
                h * attraction(context.model.attractors, context.particles[i].position);
    context.report.body_passes += context.particles.size();
}

} // namespace plumb::inline PLUMB_PRECISION
