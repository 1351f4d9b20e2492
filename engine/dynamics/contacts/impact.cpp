#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The rebound speed of one contact point that approaches with `speed` < 0 at distance `gap`, under
// a relative acceleration `pull` along the normal (negative: towards each other); empty when it is
// not struck within h, or too slow to come back to where it is. Energy is that of a bounce at the
// surface, whatever the gap.
struct Rebound {
    bool struck = false;
    Real speed = Real(0);
    Real time = Real(0); // s, until it touches
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
    return {true, std::sqrt(back_squared), height / -speed};
}

// The joints of the two bodies, as far as they are solved together, answer each impulse: what is
// struck is then as heavy as they make it.
class Answers {
  public:
    Answers(StepContext &context, const ContactConstraint &contact) : context_(context) {
        JointSystem &system = *context.scratch.joint_system;
        first_ = system.group_of(contact.a);
        second_ = system.group_of(contact.b);
        if (second_ == first_)
            second_ = JointSystem::none;
        for (const std::uint32_t group : {first_, second_})
            if (group != JointSystem::none)
                for (std::uint32_t i = system.groups()[group].first;
                     i < system.groups()[group].last; ++i) {
                    const JointConstraint &joint = context.scratch.joints[system.block(i)];
                    for (const std::uint32_t body : {joint.a, joint.b})
                        if (body != Joint::world)
                            before_.push_back({body, context.bodies[body].velocity,
                                               context.bodies[body].angular_velocity});
                }
    }
    bool are_any() const { return !before_.empty(); }
    void give() {
        answer_impact(context_, first_);
        answer_impact(context_, second_);
    }
    // Undoes what happened to the joined bodies since this was made.
    void take_back() {
        for (const Before &one : before_) {
            context_.bodies[one.body].velocity = one.velocity;
            context_.bodies[one.body].angular_velocity = one.angular_velocity;
        }
    }

  private:
    struct Before {
        std::uint32_t body;
        Vec3 velocity;
        Vec3 angular_velocity;
    };
    StepContext &context_;
    std::uint32_t first_;
    std::uint32_t second_;
    std::vector<Before> before_;
};

// Newton's law for all points of one pair of bodies together. Returns whether anything was struck.
bool strike(StepContext &context, const ContactConstraint &contact, Real h) {
    SolverBody &a = context.bodies[contact.a];
    SolverBody &b = context.bodies[contact.b];
    const Vec3 gravity{context.settings.gravity};
    const auto pull_on = [&](std::uint32_t body) {
        return gravity_on(context.model.bodies[body],
                          gravity +
                              attraction(context.model.attractors, context.bodies[body].position));
    };
    const Vec3 pull_a = pull_on(contact.a);
    const Vec3 pull_b = pull_on(contact.b);
    const Real pull = glm::dot(pull_b - pull_a, contact.normal);

    const auto normal_speed = [&](const ContactPointConstraint &point) {
        return glm::dot(b.velocity_at(point.r_b) - a.velocity_at(point.r_a), contact.normal);
    };
    std::array<Rebound, 4> rebounds;
    std::array<Real, 4> approaches{}; // normal speeds before
    std::array<Real, 4>
        normal_mass{}; // at the present poses: a stale one would gain or lose energy
    bool any = false;
    for (int k = 0; k < contact.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        const ContactPointConstraint &point = contact.points[index];
        approaches[index] = normal_speed(point);
        rebounds[index] = rebound(present_separation(contact, point, a, b), approaches[index], pull,
                                  contact.restitution, context.settings, h);
        const Real inverse = inverse_effective_mass(a, b, point.r_a, point.r_b, contact.normal);
        normal_mass[index] = inverse > Real(0) ? Real(1) / inverse : Real(0);
        any = any || rebounds[index].struck;
    }
    if (!any)
        return false;
    Answers joints(context, contact);
    for (int k = 0; joints.are_any() && k < contact.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        const ContactPointConstraint &point = contact.points[index];
        // A unit impulse, to see what comes of it.
        const SolverBody a_before = a;
        const SolverBody b_before = b;
        joints.give();
        const Real speed = normal_speed(point);
        a.apply_impulse(-contact.normal, point.r_a);
        b.apply_impulse(contact.normal, point.r_b);
        joints.give();
        const Real inverse = normal_speed(point) - speed;
        normal_mass[index] = inverse > Real(0) ? Real(1) / inverse : Real(0);
        joints.take_back();
        a = a_before;
        b = b_before;
    }

    const Vec3 before_a = a.velocity;
    const Vec3 before_b = b.velocity;

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
            joints.give();
        }
    // What the passes have not shared out yet is made good as a whole, so that they leave the
    // energy that the law leaves: half the impulses times the sums of the speeds before and after.
    if (contact.count > 1) {
        Real wanted = Real(0);
        Real reached = Real(0);
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const Real after = normal_speed(contact.points[index]);
            wanted += normal_impulse[index] * (rebounds[index].speed - approaches[index]);
            reached += normal_impulse[index] * (after - approaches[index]);
        }
        const Real missing = reached > Real(0) ? wanted / reached - Real(1) : Real(0);
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const Vec3 impulse = (missing * normal_impulse[index]) * contact.normal;
            normal_impulse[index] *= Real(1) + missing;
            a.apply_impulse(-impulse, contact.points[index].r_a);
            b.apply_impulse(impulse, contact.points[index].r_b);
            joints.give();
        }
    }
    if (contact.friction > Real(0))
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            ContactPointConstraint point = contact.points[index];
            point.impulse = Vec3{normal_impulse[index], Real(0), Real(0)};
            point.tangent_mass = tangent_mass_of(point, contact.tangents, a, b);
            solve_friction(contact, point, a, b, contact.friction * normal_impulse[index]);
            joints.give();
        }
    record_impact(context, contact, normal_impulse);
    // Until they touch they go on as before: the new velocities act from there on, with the arms of
    // then. Without that the two would lose angular momentum. What joints hold stays with them.
    if (context.contacts[contact.contact].moment == Moment::touch && pull == Real(0) &&
        !joints.are_any()) {
        Real time = std::numeric_limits<Real>::infinity();
        for (std::size_t k = 0; k < rebounds.size(); ++k)
            if (rebounds[k].struck && normal_impulse[k] > Real(0))
                time = std::min(time, rebounds[k].time);
        if (time > Real(0) && std::isfinite(time)) {
            time = std::min(time, h);
            for (const auto &[body, before] : {std::pair{&a, before_a}, std::pair{&b, before_b}}) {
                const Vec3 way = time * (before - body->velocity);
                body->position += way;
                body->moved += way;
            }
        }
    }
    return true;
}

} // namespace

void record_impact(StepContext &context, const ContactConstraint &contact,
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
