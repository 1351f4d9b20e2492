#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The rebound speed of one contact point that approaches with `speed` < 0 at distance `gap`, under
// a relative acceleration `pull` along the normal (negative: towards each other); empty when it is
// not struck within h, or too slow to come back to where it is.
struct Rebound {
    bool struck = false;
    Real speed = Real(0);
};

Rebound rebound(Real gap, Real speed, Real pull, Real restitution, const StepSettings &settings,
                Real h) {
    const auto threshold = static_cast<Real>(settings.restitution_threshold);
    const auto lookahead = static_cast<Real>(settings.impact_lookahead);
    if (speed >= -threshold || gap + lookahead * h * (speed + h * pull) > Real(0))
        return {};
    const Real height = std::max(gap, Real(0));
    // Energy from here to the surface and back: v^2 - 2 a s.
    const Real surface_squared = std::max(speed * speed - Real(2) * pull * height, Real(0));
    const Real back_squared = restitution * restitution * surface_squared + Real(2) * pull * height;
    if (back_squared <= threshold * threshold)
        return {};
    return {true, std::sqrt(back_squared)};
}

// The impact at the middle of where it acts.
void record(StepContext &context, const ContactConstraint &contact,
            const std::array<Real, 4> &normal_impulse) {
    Impact impact;
    impact.key = context.contacts[contact.contact].key;
    impact.normal = contact.normal;
    Vec3 sum{Real(0)};
    for (int k = 0; k < contact.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        impact.impulse += normal_impulse[index];
        sum += normal_impulse[index] * contact.points[index].r_a;
    }
    if (!(impact.impulse > Real(0)))
        return;
    impact.position = context.bodies[contact.a].position + sum / impact.impulse;
    context.impacts.push_back(impact);
}

// Newton's law for all points of one pair of bodies together. Returns whether anything was struck.
bool strike(StepContext &context, const ContactConstraint &contact, Real h) {
    SolverBody &a = context.bodies[contact.a];
    SolverBody &b = context.bodies[contact.b];
    const Vec3 gravity{context.settings.gravity};
    const Vec3 pull_a = gravity_on(context.model.bodies[contact.a], gravity);
    const Vec3 pull_b = gravity_on(context.model.bodies[contact.b], gravity);
    const Real pull = glm::dot(pull_b - pull_a, contact.normal);

    const auto normal_speed = [&](const ContactPointConstraint &point) {
        return glm::dot(b.velocity_at(point.r_b) - a.velocity_at(point.r_a), contact.normal);
    };
    std::array<Rebound, 4> rebounds;
    std::array<Real, 4>
        normal_mass{}; // at the present poses: a stale one would gain or lose energy
    bool any = false;
    for (int k = 0; k < contact.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        const ContactPointConstraint &point = contact.points[index];
        rebounds[index] = rebound(present_separation(contact, point, a, b), normal_speed(point),
                                  pull, contact.restitution, context.settings, h);
        const Real inverse = inverse_effective_mass(a, b, point.r_a, point.r_b, contact.normal);
        normal_mass[index] = inverse > Real(0) ? Real(1) / inverse : Real(0);
        any = any || rebounds[index].struck;
    }
    if (!any)
        return false;

    // The points of one manifold share the impulse by Gauss-Seidel.
    const int passes = contact.count == 1 ? 1 : context.settings.impact_passes;
    std::array<Real, 4> normal_impulse{};
    for (int pass = 0; pass < passes; ++pass)
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            if (!rebounds[index].struck)
                continue;
            const ContactPointConstraint &point = contact.points[index];
            const Real change = normal_mass[index] * (rebounds[index].speed - normal_speed(point));
            const Real total = std::max(normal_impulse[index] + change, Real(0));
            const Vec3 impulse = (total - normal_impulse[index]) * contact.normal;
            normal_impulse[index] = total;
            a.apply_impulse(-impulse, point.r_a);
            b.apply_impulse(impulse, point.r_b);
        }
    if (contact.friction > Real(0))
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            ContactPointConstraint point = contact.points[index];
            point.impulse = Vec3{normal_impulse[index], Real(0), Real(0)};
            solve_friction(contact, point, a, b, contact.friction * normal_impulse[index]);
        }
    record(context, contact, normal_impulse);
    return true;
}

} // namespace

void resolve_impacts(StepContext &context, Real h) {
    bool any = context.settings.impact_sweeps > 0;
    for (int sweep = 0; any && sweep < context.settings.impact_sweeps; ++sweep) {
        any = false;
        for (const ContactConstraint &contact : context.scratch.contacts)
            if (contact.restitution > Real(0) && strike(context, contact, h)) {
                any = true;
                ++context.report.impacts;
            }
    }
    if (any)
        ++context.report.unresolved_impacts;
}

} // namespace plumb::inline PLUMB_PRECISION
