// What a method sees of a world's bodies and joints, for tests of its parts.
#pragma once

#include "engine/dynamics/method.h"
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

struct SolverView {
    StepSettings settings;
    std::vector<SolverBody> bodies;
    std::vector<JointMemory> joints;
    IslandGroup group;
    Grab grab;
    SolverBody world_frame;
    JointSystem joint_system;
    SolverScratch scratch;
    StepReport report;
    std::vector<Impact> impacts;
    StepContext context;

    explicit SolverView(const World &world)
        : settings(world.settings()), joints(world.state().joints), context{world.model(),
                                                                            settings,
                                                                            {},
                                                                            world.state().motions,
                                                                            group,
                                                                            {},
                                                                            joints,
                                                                            grab,
                                                                            world_frame,
                                                                            scratch,
                                                                            report,
                                                                            impacts,
                                                                            {},
                                                                            {},
                                                                            {},
                                                                            {},
                                                                            {},
                                                                            {}} {
        scratch.joint_system = &joint_system;
        for (std::uint32_t i = 0; i < world.bodies().size(); ++i) {
            const Body &body = world.bodies()[i];
            SolverBody &out = bodies.emplace_back();
            static_cast<Motion &>(out) = world.motions()[i];
            if (body.kind == BodyKind::static_body)
                continue;
            group.moving.push_back(i);
            if (body.kind != BodyKind::dynamic)
                continue;
            out.inv_mass = Vec3{Real(1) / body.mass};
            out.inv_inertia = solver_inverse_inertia(body, out.rotation);
            out.has_locks = body.has_locks;
            for (int axis = 0; axis < 3; ++axis)
                if (body.locked[static_cast<std::size_t>(axis)]) {
                    out.inv_mass[axis] = Real(0);
                    out.has_locked_translation = true;
                }
        }
        context.bodies = bodies;
        scratch.rounded_off.resize(bodies.size());
    }
    SolverView(const SolverView &) = delete;
    SolverView &operator=(const SolverView &) = delete;
};

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
