#include "engine/dynamics/contacts/approach.h"
#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The rebound speed of a contact point that approaches with `speed` < 0 at distance `gap`, under a
// relative acceleration `pull` along the normal (negative: towards each other). Empty if it is not
// struck within h, or is too slow to come back to where it is. The energy is that of a bounce at
// the surface, whatever the gap.
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
    if (!(restitution > Real(0)))
        return {true, Real(0), height / -speed};
    // Energy from here to the surface and back: v^2 - 2 a s.
    const Real surface_squared = std::max(speed * speed - Real(2) * pull * height, Real(0));
    const Real back_squared = restitution * restitution * surface_squared + Real(2) * pull * height;
    if (back_squared <= threshold * threshold)
        return {};
    return {true, std::sqrt(back_squared), height / -speed};
}

// One contact that is struck, point by point.
struct Blow {
    ContactConstraint *contact = nullptr;
    std::size_t first = 0; // the first blow of those resolved together with it
    Real pull = Real(0);   // see rebound
    std::array<Rebound, 4> rebounds;
    std::array<Real, 4> approaches{}; // normal speeds before
    // Whether a point crosses the other body's plane beside that body.
    std::array<bool, 4> passes_by{};
    // At the present poses: a stale one would gain or lose energy.
    std::array<Real, 4> normal_mass{};
    std::array<Vec3, 4> impulses{}; // along the normal and the tangents
    bool is_plastic() const { return contact->restitution == Real(0); }
};

Real normal_speed(const StepContext &context, const ContactConstraint &contact, std::size_t k) {
    const ContactPointConstraint &point = contact.points[k];
    return glm::dot(context.bodies[contact.b].velocity_at(point.r_b) -
                        context.bodies[contact.a].velocity_at(point.r_a),
                    contact.normal);
}

void apply_along_normal(StepContext &context, const ContactConstraint &contact, std::size_t k,
                        Real impulse) {
    const ContactPointConstraint &point = contact.points[k];
    context.bodies[contact.a].apply_impulse(-impulse * contact.normal, point.r_a);
    context.bodies[contact.b].apply_impulse(impulse * contact.normal, point.r_b);
}

bool is_struck(const Blow &blow) {
    return std::ranges::any_of(blow.rebounds, &Rebound::struck);
}

// How each point of the contact approaches and rebounds.
void look_at(const StepContext &context, Blow &blow, Real h) {
    const ContactConstraint &contact = *blow.contact;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        if (blow.passes_by[k])
            continue;
        blow.approaches[k] = normal_speed(context, contact, k);
        const Real gap = present_separation(contact, contact.points[k], context.bodies[contact.a],
                                            context.bodies[contact.b]);
        blow.rebounds[k] =
            rebound(gap, blow.approaches[k], blow.pull, contact.restitution, context.settings, h);
    }
}

// Round surfaces meet on the line between their cores, unless the cores coincide or the line is far
// off the present normal.
void meet_between_cores(ContactConstraint &contact, const Contact &found, const SolverBody &a,
                        const SolverBody &b, const Vec3 &between) {
    const auto points = std::span(contact.points).first(static_cast<std::size_t>(contact.count));
    Vec3 line{Real(0)};
    for (const ContactPointConstraint &point : points)
        line += between + b.rotation * point.core_b - a.rotation * point.core_a;
    if (glm::dot(line, contact.normal) > Real(0.5) * glm::length(line))
        contact.normal = glm::normalize(line);
    contact.tangents = tangent_basis(contact.normal);
    for (ContactPointConstraint &point : points) {
        const Vec3 core_a = a.rotation * point.core_a;
        const Vec3 core_b = b.rotation * point.core_b;
        const Real half = Real(0.5) * (glm::dot(between + core_b - core_a, contact.normal) -
                                       found.rounding_a - found.rounding_b);
        point.r_a = core_a + (found.rounding_a + half) * contact.normal;
        point.r_b = core_b - (found.rounding_b + half) * contact.normal;
    }
}

Blow blow_on(const StepContext &context, ContactConstraint &contact, Real h) {
    const auto pull_on = [&](std::uint32_t body) {
        return plumb::pull_on(
            context.model.bodies[body],
            Vec3{context.settings.gravity} +
                attraction(context.model.attractors, context.bodies[body].position));
    };
    const Contact &found = context.contacts[contact.contact];
    const SolverBody &a = context.bodies[contact.a];
    const SolverBody &b = context.bodies[contact.b];
    // As one rolls over the other it would be struck by the plane that it leaves behind.
    if (found.goes_round_the_other())
        meet_between_cores(contact, found, a, b, b.position - a.position);
    Blow blow;
    blow.contact = &contact;
    blow.pull = glm::dot(pull_on(contact.b) - pull_on(contact.a), contact.normal);
    look_at(context, blow, h);
    return blow;
}

void weigh(const StepContext &context, Blow &blow) {
    const ContactConstraint &contact = *blow.contact;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        const ContactPointConstraint &point = contact.points[k];
        const Real inverse =
            inverse_effective_mass(context.bodies[contact.a], context.bodies[contact.b], point.r_a,
                                   point.r_b, contact.normal);
        blow.normal_mass[k] = inverse > Real(0) ? Real(1) / inverse : Real(0);
    }
}

// Sorts blows so that those resolved together are next to each other: those of a moving body, or of
// bodies whose joints are solved together.
void gather_together(const StepContext &context, std::vector<Blow> &blows) {
    using Taken = std::pair<std::size_t, std::size_t>; // a body or joint group, and its blow
    std::vector<Taken> taken;
    for (std::size_t i = 0; i < blows.size(); ++i)
        for (const std::uint32_t body : {blows[i].contact->a, blows[i].contact->b}) {
            if (context.model.bodies[body].kind != BodyKind::dynamic)
                continue;
            const std::uint32_t group = context.scratch.joint_system->group_of(body);
            taken.emplace_back(group == JointSystem::none ? body : context.bodies.size() + group,
                               i);
        }
    std::ranges::sort(taken);
    for (std::size_t i = 0; i < blows.size(); ++i)
        blows[i].first = i;
    const auto first_of = [&](std::size_t i) {
        while (blows[i].first != i)
            i = blows[i].first = blows[blows[i].first].first;
        return i;
    };
    for (std::size_t i = 1; i < taken.size(); ++i)
        if (taken[i].first == taken[i - 1].first) {
            const auto [low, high] =
                std::minmax({first_of(taken[i].second), first_of(taken[i - 1].second)});
            blows[high].first = low;
        }
    for (std::size_t i = 0; i < blows.size(); ++i)
        blows[i].first = first_of(i);
    std::ranges::stable_sort(blows, {}, &Blow::first);
}

// The joints of struck bodies, if they are solved together, respond to each impulse: the bodies are
// then as heavy as the joints make them.
class Answers {
  public:
    Answers(StepContext &context, std::span<const Blow> blows) : context_(context) {
        std::vector<std::uint32_t> groups;
        for (const Blow &blow : blows)
            for (const std::uint32_t body : {blow.contact->a, blow.contact->b})
                if (group_of(body) != JointSystem::none)
                    groups.push_back(group_of(body));
        std::ranges::sort(groups);
        groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
        JointSystem &system = *context.scratch.joint_system;
        for (const std::uint32_t group : groups)
            for (std::uint32_t i = system.groups()[group].first; i < system.groups()[group].last;
                 ++i) {
                const JointConstraint &joint = context.scratch.joints[system.block(i)];
                struck_.emplace_back(system.block(i), joint.struck);
                for (const std::uint32_t body : {joint.a, joint.b})
                    if (body != Joint::world)
                        before_.push_back({body, context.bodies[body].velocity,
                                           context.bodies[body].angular_velocity});
            }
    }
    bool are_any() const { return !before_.empty(); }
    bool are_any(const ContactConstraint &contact) const {
        return group_of(contact.a) != JointSystem::none || group_of(contact.b) != JointSystem::none;
    }
    void give(const ContactConstraint &contact) {
        answer_impact(context_, group_of(contact.a));
        if (group_of(contact.b) != group_of(contact.a))
            answer_impact(context_, group_of(contact.b));
    }
    // Restores the joined bodies' velocities, and what their joints passed on, from when this was
    // made.
    void take_back() {
        for (const auto &[joint, struck] : struck_)
            context_.scratch.joints[joint].struck = struck;
        for (const Before &one : before_) {
            context_.bodies[one.body].velocity = one.velocity;
            context_.bodies[one.body].angular_velocity = one.angular_velocity;
        }
    }

  private:
    std::uint32_t group_of(std::uint32_t body) const {
        return context_.scratch.joint_system->group_of(body);
    }
    struct Before {
        std::uint32_t body;
        Vec3 velocity;
        Vec3 angular_velocity;
    };
    StepContext &context_;
    std::vector<Before> before_;
    std::vector<std::pair<std::uint32_t, Vec3>> struck_; // by joint constraint
};

// Finds the effective masses by applying a unit impulse.
void weigh_with_joints(StepContext &context, Blow &blow, Answers &joints) {
    const ContactConstraint &contact = *blow.contact;
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        const SolverBody a_before = context.bodies[contact.a];
        const SolverBody b_before = context.bodies[contact.b];
        joints.give(contact);
        const Real speed = normal_speed(context, contact, k);
        apply_along_normal(context, contact, k, Real(1));
        joints.give(contact);
        const Real inverse = normal_speed(context, contact, k) - speed;
        blow.normal_mass[k] = inverse > Real(0) ? Real(1) / inverse : Real(0);
        joints.take_back();
        context.bodies[contact.a] = a_before;
        context.bodies[contact.b] = b_before;
    }
}

// Friction under the points' loads so far.
void add_friction(StepContext &context, Blow &blow, Answers &joints) {
    const ContactConstraint &contact = *blow.contact;
    SolverBody &a = context.bodies[contact.a];
    SolverBody &b = context.bodies[contact.b];
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        ContactPointConstraint point = contact.points[k];
        point.impulse = blow.impulses[k];
        point.tangent_mass = tangent_mass_of(point, contact.tangents, a, b);
        solve_friction(contact, point, a, b, contact.friction * point.impulse.x);
        blow.impulses[k] = point.impulse;
        joints.give(contact);
    }
}

// Shares the impulses out by Gauss-Seidel, so that no struck point leaves slower than it should,
// and none that leaves faster carries an impulse.
void share_out(StepContext &context, std::span<Blow> blows, Answers &joints) {
    constexpr Real enough = Real(8) * std::numeric_limits<Real>::epsilon();
    // Plastic impacts are solved with their friction, since they leave no spare speed along the
    // normal: with friction after that, some would gain energy.
    const auto has_friction = [](const Blow &blow) {
        return blow.is_plastic() && blow.contact->friction > Real(0);
    };
    const bool any_friction = std::ranges::any_of(blows, has_friction);
    const bool is_one = blows.size() == 1 && blows.front().contact->count == 1;
    const int passes = is_one && !any_friction ? 1 : context.settings.impact_passes;
    bool agree = false;
    for (int pass = 0; pass < passes && !agree; ++pass) {
        agree = !any_friction;
        for (Blow &blow : blows) {
            for (std::size_t k = 0; k < static_cast<std::size_t>(blow.contact->count); ++k) {
                if (!blow.rebounds[k].struck)
                    continue;
                const Real missing =
                    blow.rebounds[k].speed - normal_speed(context, *blow.contact, k);
                Real &impulse = blow.impulses[k].x;
                const Real total = std::max(impulse + blow.normal_mass[k] * missing, Real(0));
                const Real change = total - impulse;
                agree = agree && std::abs(change) <= enough * total;
                impulse = total;
                apply_along_normal(context, *blow.contact, k, change);
                joints.give(*blow.contact);
            }
            if (has_friction(blow))
                add_friction(context, blow, joints);
        }
    }
    if (is_one || std::ranges::all_of(blows, &Blow::is_plastic))
        return;
    // What the passes have not shared out yet is made up as a whole, so that they leave the energy
    // that the law leaves: half the impulses times the sums of the speeds before and after.
    Real wanted = Real(0);
    Real reached = Real(0);
    for (const Blow &blow : blows)
        for (std::size_t k = 0; k < static_cast<std::size_t>(blow.contact->count); ++k) {
            const Real after = normal_speed(context, *blow.contact, k);
            wanted += blow.impulses[k].x * (blow.rebounds[k].speed - blow.approaches[k]);
            reached += blow.impulses[k].x * (after - blow.approaches[k]);
        }
    const Real missing = reached > Real(0) ? wanted / reached - Real(1) : Real(0);
    for (Blow &blow : blows)
        for (std::size_t k = 0; k < static_cast<std::size_t>(blow.contact->count); ++k) {
            apply_along_normal(context, *blow.contact, k, missing * blow.impulses[k].x);
            blow.impulses[k].x *= Real(1) + missing;
            joints.give(*blow.contact);
        }
}

// How long these bodies go on as before (s): the new velocities act from where they touch, with the
// arms there. Without that they would lose angular momentum. Bodies held by joints stay with them.
Real time_to_touch(const StepContext &context, std::span<const Blow> blows, Real h) {
    Real time = h;
    for (const Blow &blow : blows) {
        if (context.contacts[blow.contact->contact].found_at != FoundAt::touch ||
            blow.pull != Real(0))
            return Real(0);
        for (const Rebound &point : blow.rebounds)
            if (point.struck)
                time = std::min(time, point.time);
    }
    return std::max(time, Real(0));
}

// The offset between a contact point's places on the two bodies.
Vec3 between_points(const ContactPointConstraint &point, const Vec3 &between) {
    return between + point.r_b - point.r_a;
}

// Whether the points are off to the side of each other by more than rounding.
bool are_apart(const ContactConstraint &contact, const Vec3 &between) {
    constexpr Real enough = Real(1e-4); // of the arms
    const auto is_apart = [&](const ContactPointConstraint &point) {
        const Vec3 off = between_points(point, between);
        const Vec3 aside = off - glm::dot(off, contact.normal) * contact.normal;
        return glm::dot(aside, aside) >
               enough * enough * (glm::dot(point.r_a, point.r_a) + glm::dot(point.r_b, point.r_b));
    };
    return std::any_of(contact.points.begin(), contact.points.begin() + contact.count, is_apart);
}

// Where the points of two dynamic bodies will coincide when they touch, so that the angular
// momentum one loses is what the other gains: between round cores, else on the round body, or
// midway. Balls are left as found, since the impact does not turn them.
void meet(StepContext &context, Blow &blow, Real time, Real h) {
    ContactConstraint &contact = *blow.contact;
    const Contact &found = context.contacts[contact.contact];
    const SolverBody &a = context.bodies[contact.a];
    const SolverBody &b = context.bodies[contact.b];
    const Vec3 between = (b.position - a.position) + time * (b.velocity - a.velocity);
    if (!are_both_dynamic(context, found) || are_balls(context, found) ||
        !are_apart(contact, between))
        return;
    const bool round_a = found.rounding_a > Real(0);
    const bool round_b = found.rounding_b > Real(0);
    if (round_a && round_b && contact.count == 1) {
        meet_between_cores(contact, found, a, b, between);
    } else {
        const Real share_a = round_a == round_b ? Real(0.5) : round_b ? Real(1) : Real(0);
        for (ContactPointConstraint &point :
             std::span(contact.points).first(static_cast<std::size_t>(contact.count))) {
            const Vec3 off = between_points(point, between);
            point.r_a += share_a * off;
            point.r_b -= (Real(1) - share_a) * off;
        }
    }
    contact.has_met = true;
    look_at(context, blow, h);
}

// Whether the bodies touch `time` from now, as far as that is known: to second order in their
// turns.
bool touch(const StepContext &context, const Contact &contact, Real time) {
    constexpr Real enough = Real(1e-4); // of the smaller one's half width
    const Collider &on_a = context.model.colliders[contact.collider_a];
    const Collider &on_b = context.model.colliders[contact.collider_b];
    const Motion a = ahead(context.bodies[contact.key.a], time);
    const Motion b = ahead(context.bodies[contact.key.b], time);
    const auto strays = [&](const Collider &collider, const Motion &motion) {
        const Vec3 &spin = motion.angular_velocity;
        return Real(0.5) * time * time * glm::dot(spin, spin) * collider.extent;
    };
    const Real near =
        enough * std::min(on_a.half_width, on_b.half_width) + strays(on_a, a) + strays(on_b, b);
    return collide(placed(on_a.shape, mass_pose(a)), placed(on_b.shape, mass_pose(b)), near,
                   contact.manifold.normal)
               .count > 0;
}

// Whether a lone pair does touch when a point crosses the other body's plane: a body that passes by
// an edge or round a ball does not. Bouncing bodies other than balls count as touching, since the
// passes give back no speed.
bool comes_to_touch(const StepContext &context, Blow &blow, Real h) {
    const Contact &contact = context.contacts[blow.contact->contact];
    if (contact.found_at != FoundAt::touch || !touch_nothing_else(context, contact) ||
        (!blow.is_plastic() && !are_balls(context, contact)))
        return true;
    if (blow.pull != Real(0))
        return !blow.is_plastic();
    while (is_struck(blow)) {
        std::size_t first = 4;
        for (std::size_t k = 0; k < 4; ++k)
            if (blow.rebounds[k].struck &&
                (first == 4 || blow.rebounds[k].time < blow.rebounds[first].time))
                first = k;
        if (touch(context, contact, std::min(blow.rebounds[first].time, h)))
            return true;
        blow.rebounds[first] = {};
        blow.passes_by[first] = true;
    }
    return false;
}

std::array<Real, 4> along_normal(const std::array<Vec3, 4> &impulses) {
    return {impulses[0].x, impulses[1].x, impulses[2].x, impulses[3].x};
}

// Newton's impact law for all points that are struck together.
void strike(StepContext &context, std::span<Blow> blows, Real h) {
    Answers joints(context, blows);
    const Real time = joints.are_any() ? Real(0) : time_to_touch(context, blows, h);
    for (Blow &blow : blows) {
        meet(context, blow, time, h);
        weigh(context, blow);
        if (joints.are_any(*blow.contact))
            weigh_with_joints(context, blow, joints);
    }
    std::vector<std::pair<std::uint32_t, Vec3>> before; // bodies and their velocities
    for (const Blow &blow : blows)
        for (const std::uint32_t body : {blow.contact->a, blow.contact->b})
            before.emplace_back(body, context.bodies[body].velocity);
    share_out(context, blows, joints);
    for (Blow &blow : blows)
        if (!blow.is_plastic() && blow.contact->friction > Real(0))
            add_friction(context, blow, joints);
    const std::size_t recorded = context.impacts.size();
    for (const Blow &blow : blows)
        record_impact(context, *blow.contact, along_normal(blow.impulses));
    context.report.impacts += static_cast<std::uint32_t>(context.impacts.size() - recorded);
    if (!(time > Real(0)))
        return;
    std::ranges::sort(before, {}, [](const auto &one) { return one.first; });
    const auto is_same = [](const auto &one, const auto &other) {
        return one.first == other.first;
    };
    before.erase(std::unique(before.begin(), before.end(), is_same), before.end());
    for (const auto &[index, velocity] : before) {
        SolverBody &body = context.bodies[index];
        const Vec3 way = time * (velocity - body.velocity);
        body.position += way;
        body.moved += way;
    }
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
    std::vector<Blow> blows;
    bool any = context.settings.impact_sweeps > 0;
    for (int sweep = 0; any && sweep < context.settings.impact_sweeps; ++sweep) {
        blows.clear();
        for (ContactConstraint &contact : context.scratch.contacts) {
            if (!contact.strikes)
                continue;
            Blow blow = blow_on(context, contact, h);
            if (is_struck(blow) && comes_to_touch(context, blow, h))
                blows.push_back(blow);
        }
        any = !blows.empty();
        gather_together(context, blows);
        for (auto begin = blows.begin(), end = begin; begin != blows.end(); begin = end) {
            end = std::ranges::upper_bound(begin, blows.end(), begin->first, {}, &Blow::first);
            strike(context, std::span(begin, end), h);
        }
    }
    if (any)
        ++context.report.unresolved_impacts;
}

} // namespace plumb::inline PLUMB_PRECISION
