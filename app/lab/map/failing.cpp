#include "app/lab/map/failing.h"

#include "engine/core/check.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <array>
#include <limits>

namespace plumb {

namespace {

constexpr std::array all_failings{
    FailingInfo{Failing::none, "held", '.', 0xa8d5a2, "held"},
    FailingInfo{Failing::not_finite, "not finite", 'N', 0x33373d, "not finite"},
    FailingInfo{Failing::passed_through, "passed through", 'T', 0xd55e00,
                "passed through: a body's centre came out behind a static body"},
    FailingInfo{Failing::energy_grew, "energy grew", 'E', 0xe69f00,
                "energy grew: by over a tenth, or more than the scene allows"},
    FailingInfo{Failing::penetration, "penetration", 'P', 0x0072b2,
                "penetration: over 1/4 of a width at the end, or more than allowed"},
    FailingInfo{Failing::drift, "drift", 'D', 0x56b4e9,
                "joint drift: over 1/4 of a width at the end, or more than allowed"},
    FailingInfo{Failing::fell, "fell", 'F', 0xcc79a7, "fell over, or down from where it stood"},
    FailingInfo{Failing::never_rests, "never rests", 'R', 0xf0e442, "never comes to rest"},
    FailingInfo{Failing::missed, "missed", 'M', 0xa4abb2, "missed an expectation"},
    FailingInfo{Failing::undecided, "undecided", '?', 0xe3e8d9,
                "undecided: by theory it grows without bound, too slowly to show in this time"},
};

bool is_about(const ExpectDesc &expect, std::string_view part) {
    return expect.quantity.find(part) != std::string::npos;
}

bool expects_about(const SceneDesc &scene, std::string_view part) {
    return std::ranges::any_of(scene.expects,
                               [&](const ExpectDesc &each) { return is_about(each, part); });
}

bool has_springs(const SceneDesc &scene) {
    return std::ranges::any_of(scene.joints,
                               [](const JointDesc &joint) { return joint.frequency > 0; });
}

double smallest_moving_width(const SceneDesc &scene) {
    double width = std::numeric_limits<double>::infinity();
    for (const BodyDesc &body : scene.bodies)
        if (body.kind == BodyKind::dynamic)
            width = std::min(width, smallest_width(body));
    return width;
}

// A magnitude, or a distance from a curve, does not tell gain from loss, but the run does.
bool is_too_much_energy(const ExpectOutcome &outcome, const JudgedRun &run) {
    const ReductionInfo *reduction = find_reduction(outcome.desc.reduce);
    if (reduction->reduction == Reduction::drift || reduction->reduction == Reduction::max_abs ||
        !outcome.desc.curve.empty())
        return run.max_energy_gain >= run.max_energy_error;
    return outcome.measured > outcome.desc.value;
}

// Whether a body that should have kept its place is lower now by more than it may be off it, and
// not because it slid or rolled far away: then the drop is at least half of the way.
bool fell_from_its_place(const ExpectOutcome &outcome, double drop) {
    const ExpectDesc &desc = outcome.desc;
    return desc.quantity == "displacement" && desc.relation == ExpectDesc::Relation::at_most &&
           drop > desc.value && drop >= 0.5 * outcome.measured;
}

Failing kind_of_miss(const ExpectOutcome &outcome, const JudgedRun &run, double drop) {
    using Relation = ExpectDesc::Relation;
    const ExpectDesc &desc = outcome.desc;
    if (is_about(desc, "energy") && desc.quantity != "kinetic_energy" &&
        is_too_much_energy(outcome, run))
        return Failing::energy_grew;
    if (is_about(desc, "penetration"))
        return Failing::penetration;
    if (is_about(desc, "joint_drift"))
        return Failing::drift;
    if ((desc.quantity == "position.y" && desc.relation == Relation::at_least) ||
        (desc.quantity == "tilt" && desc.relation == Relation::at_most) ||
        fell_from_its_place(outcome, drop))
        return Failing::fell;
    if ((is_about(desc, "speed") || desc.quantity == "kinetic_energy") &&
        desc.relation == Relation::at_most)
        return Failing::never_rests;
    return Failing::missed;
}

} // namespace

bool brings_energy_in(const SceneDesc &scene) {
    const glm::dvec3 still(0);
    return has_springs(scene) ||
           std::ranges::any_of(
               scene.joints,
               [](const JointDesc &joint) { return joint.motor_speed.has_value(); }) ||
           std::ranges::any_of(scene.bodies, [&](const BodyDesc &body) {
               return body.torque != still ||
                      (body.kind == BodyKind::kinematic &&
                       (body.velocity != still || body.angular_velocity != still));
           });
}

std::span<const FailingInfo> failings() {
    return all_failings;
}

const FailingInfo &info_of(Failing failing) {
    const auto *const found = std::ranges::find(all_failings, failing, &FailingInfo::failing);
    PLUMB_CHECK(found != all_failings.end(), "every kind of failure has a row");
    return *found;
}

std::optional<Failing> find_failing(std::string_view name) {
    const auto *const found = std::ranges::find(all_failings, name, &FailingInfo::name);
    return found == all_failings.end() ? std::nullopt : std::optional(found->failing);
}

ToleratedDepths tolerated_depths(const SceneDesc &scene) {
    constexpr double any = std::numeric_limits<double>::infinity();
    const double depth = tolerated_depth * smallest_moving_width(scene);
    return {expects_about(scene, "penetration") ? any : depth,
            expects_about(scene, "joint_drift") || has_springs(scene) ? any : depth};
}

bool expects_of_bodies(const SceneDesc &scene) {
    return std::ranges::any_of(scene.expects, [](const ExpectDesc &expect) {
        const QuantityInfo *quantity = find_quantity(expect.quantity);
        return quantity != nullptr && quantity->needs_body();
    });
}

RunFailing why_failed(const SceneDesc &scene, const JudgedRun &run, const std::string &passage,
                      const std::string &fallen) {
    if (run.divergence)
        return {Failing::not_finite, run.divergence->body};
    if (!passage.empty())
        return {Failing::passed_through, passage};
    RunFailing worst;
    const auto found = [&](Failing failing, const std::string &what) {
        if (worst.failing == Failing::none || failing < worst.failing)
            worst = {failing, what};
    };
    if (!expects_about(scene, "energy") && !brings_energy_in(scene) &&
        run.max_energy_gain > tolerated_energy_gain)
        found(Failing::energy_grew, "");
    const ToleratedDepths tolerated = tolerated_depths(scene);
    if (run.end_penetration > tolerated.penetration)
        found(Failing::penetration, "");
    if (run.end_joint_drift > tolerated.drift)
        found(Failing::drift, "");
    if (!fallen.empty() && !expects_of_bodies(scene))
        found(Failing::fell, fallen);
    // Of several misses of one kind, the worst.
    double error = 0;
    for (std::size_t i = 0; i < run.outcomes.size(); ++i) {
        const ExpectOutcome &outcome = run.outcomes[i];
        if (outcome.verdict != Verdict::missed)
            continue;
        const Failing kind = kind_of_miss(outcome, run, i < run.drops.size() ? run.drops[i] : 0);
        if (kind == worst.failing && outcome.scaled_error <= error)
            continue;
        if (worst.failing == Failing::none || kind <= worst.failing) {
            worst = {kind, outcome.desc.name};
            error = outcome.scaled_error;
        }
    }
    return worst;
}

} // namespace plumb
