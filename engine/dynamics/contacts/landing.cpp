// Blows without a bounce: methods record only the impacts that they resolve as such.
#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// After a step: every new contact without restitution whose bodies came together faster than what
// bounces, with the momentum that its middle lost along the normal. Gravity's share in that step,
// and what other contacts did to the two bodies, are part of it.
void World::record_landings() {
    Scratch &s = scratch_;
    const std::size_t recorded = s.impacts.size();
    const auto threshold = static_cast<Real>(settings_.restitution_threshold);
    for (const Contact &contact : s.contacts) {
        if (!contact.is_new || contact.sensor || contact.restitution > Real(0))
            continue;
        Vec3 arm_a{Real(0)};
        Vec3 arm_b{Real(0)};
        Real load = Real(0);
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
            const Real share = contact.impulses[k].x;
            arm_a += share * contact.anchors[k].arm_a;
            arm_b += share * contact.anchors[k].arm_b;
            load += share;
        }
        if (!(load > Real(0)))
            continue;
        arm_a /= load;
        arm_b /= load;
        const Vec3 &normal = contact.manifold.normal;
        const SolverBody &a = s.bodies[contact.key.a];
        const SolverBody &b = s.bodies[contact.key.b];
        const auto approach_of = [&](const Motion &of_a, const Motion &of_b) {
            return glm::dot(of_a.velocity + glm::cross(of_a.angular_velocity, arm_a) -
                                of_b.velocity - glm::cross(of_b.angular_velocity, arm_b),
                            normal);
        };
        const Real before =
            approach_of(state_.motions[contact.key.a], state_.motions[contact.key.b]);
        const Real stopped = before - approach_of(a, b);
        const Real inverse = inverse_effective_mass(a, b, arm_a, arm_b, normal);
        const auto is_this = [&](const Impact &impact) { return impact.key == contact.key; };
        if (!(before > threshold) || !(stopped > Real(0)) || !(inverse > Real(0)) ||
            std::any_of(s.impacts.begin(),
                        s.impacts.begin() + static_cast<std::ptrdiff_t>(recorded), is_this))
            continue;
        s.impacts.push_back({contact.key, state_.motions[contact.key.a].position + arm_a, normal,
                             stopped / inverse});
    }
    report_.impacts += static_cast<std::uint32_t>(s.impacts.size() - recorded);
}

} // namespace plumb::inline PLUMB_PRECISION
