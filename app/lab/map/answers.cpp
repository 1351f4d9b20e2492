#include "app/lab/map/answers.h"

#include "app/lab/map/failing.h"
#include "app/lab/run/accurate_run.h"
#include "app/lab/run/judged_run.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace plumb {

namespace {

bool is_gravity(const MapAxis &axis) {
    return axis.setting && axis.setting->setting().member == SettingMember(&StepSettings::gravity);
}

bool has_soft_joints(const SceneDesc &scene) {
    return std::ranges::any_of(scene.joints,
                               [](const JointDesc &joint) { return joint.frequency > 0; });
}

// Allows for errors only: at most something from 0 upwards, at least something from 0 downwards.
bool bounds_an_error(const ExpectDesc &expect) {
    return expect.relation == ExpectDesc::Relation::at_most    ? expect.value >= 0
           : expect.relation == ExpectDesc::Relation::at_least ? expect.value <= 0
                                                               : false;
}

bool only_forbids_gain(const ExpectDesc &expect) {
    return expect.relation == ExpectDesc::Relation::at_most && expect.reduce != "drift" &&
           expect.reduce != "max_abs";
}

// Whether the axis may make a motor, a spring joint, a torque or a moving body of what was none, or
// joints that start apart.
bool may_drive(const SceneDesc &scene, const MapAxis &axis) {
    return std::ranges::any_of(
        changed_numbers(axis, axis.values.front()), [&](const ChangedNumber &number) {
            const std::string &path = number.path;
            return path.starts_with("joint.") || path.find(".torque.") != std::string::npos ||
                   std::ranges::any_of(scene.bodies, [&](const BodyDesc &body) {
                       return body.kind == BodyKind::kinematic &&
                              path.starts_with("body." + body.name + ".");
                   });
        });
}

bool is_law(const SceneDesc &scene, const ExpectDesc &expect, const MapAxis &axis) {
    static constexpr std::array<std::string_view, 5> of_contacts{
        "penetration", "mean_penetration", "signorini_residual", "cone_residual",
        "dissipation_residual"};
    if (!bounds_an_error(expect))
        return false;
    if (std::ranges::find(of_contacts, expect.quantity) != of_contacts.end())
        return true;
    if (may_drive(scene, axis))
        return false;
    return (expect.quantity == "joint_drift" && !has_soft_joints(scene)) ||
           (expect.quantity == "energy_error" && only_forbids_gain(expect) &&
            !brings_energy_in(scene));
}

using MapPlace = std::vector<double>; // a value for each axis

// The corners of the part that varies the scene, and its middle.
std::vector<MapPlace> places_to_try(std::span<const MapAxis> axes) {
    std::vector<MapPlace> places{{}};
    MapPlace middle;
    for (const MapAxis &axis : axes) {
        const bool varies = varies_the_scene(axis) && axis.values.size() > 1;
        std::vector<MapPlace> longer;
        for (const MapPlace &place : places)
            for (const double end : {axis.values.front(), axis.values.back()}) {
                longer.push_back(place);
                longer.back().push_back(end);
                if (!varies)
                    break;
            }
        places = std::move(longer);
        middle.push_back(varies ? axis.values[axis.values.size() / 2] : axis.values.front());
    }
    if (std::ranges::find(places, middle) == places.end())
        places.push_back(middle);
    return places;
}

} // namespace

bool varies_the_scene(const MapAxis &axis) {
    if (axis.setting)
        return is_gravity(axis);
    return !axis.name.starts_with("methods.") && !axis.name.starts_with("expect.");
}

bool holds_whatever(const SceneDesc &scene, const ExpectDesc &expect, const MapAxis &axis) {
    return is_law(scene, expect, axis) || (axis.name.ends_with(".repeat.count") &&
                                           expect.relation != ExpectDesc::Relation::equals);
}

std::vector<std::string> outdated_answers(const SceneDesc &scene, std::span<const MapAxis> axes,
                                          const AnswerOptions &options) {
    std::vector<std::string> doubtful, outdated;
    for (const ExpectDesc &expect : scene.expects)
        if (std::ranges::any_of(axes, [&](const MapAxis &axis) {
                return varies_the_scene(axis) && !holds_whatever(scene, expect, axis);
            }))
            doubtful.push_back(expect.name);
    if (doubtful.empty())
        return {};
    const auto is_in = [](const std::vector<std::string> &names, const std::string &name) {
        return std::ranges::find(names, name) != names.end();
    };
    for (const MapPlace &at : places_to_try(axes)) {
        SceneDesc there = options.scene_at(at);
        std::erase_if(there.expects, [&](const ExpectDesc &expect) {
            return !is_in(doubtful, expect.name) || is_in(outdated, expect.name);
        });
        if (there.expects.empty())
            continue;
        RunOptions base = options.base;
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (is_gravity(axes[i]))
                base.settings.give(*axes[i].setting, at[i]);
        constexpr int substeps = 16;
        const double dt = resolve_run(there, base).settings.dt;
        const auto simulation =
            Simulation::create(there, accurate_run(there, base, dt, substeps), nullptr);
        JudgeOptions judging;
        judging.stop = options.stop;
        const JudgedRun run = judge_run(*simulation, there, judging);
        if (run.stopped)
            break;
        for (const ExpectOutcome &outcome : run.outcomes)
            if (outcome.verdict != Verdict::met)
                outdated.push_back(outcome.desc.name);
    }
    return outdated;
}

std::string outdated_text(std::span<const MapAxis> axes, const std::vector<std::string> &outdated) {
    std::string along, names;
    for (const MapAxis &axis : axes)
        if (varies_the_scene(axis))
            along += (along.empty() ? "" : " and ") + axis.name;
    for (const std::string &name : outdated)
        names += (names.empty() ? "\"" : ", \"") + name + "\"";
    return names.empty() ? "" : "stated for the file's own " + along + ": " + names;
}

} // namespace plumb
