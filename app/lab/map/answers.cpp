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

using Place = std::pair<double, double>;

// The corners of the map's part that varies the scene, and its middle.
std::vector<Place> places_to_try(const MapAxis &x, const MapAxis &y) {
    const auto ends = [](const MapAxis &axis) {
        return varies_the_scene(axis) ? std::vector{axis.values.front(), axis.values.back()}
                                      : std::vector{axis.values.front()};
    };
    const auto middle = [](const MapAxis &axis) {
        return varies_the_scene(axis) ? axis.values[axis.values.size() / 2] : axis.values.front();
    };
    std::vector<Place> places;
    for (const double at_x : ends(x))
        for (const double at_y : ends(y))
            places.emplace_back(at_x, at_y);
    if (const Place at(middle(x), middle(y)); std::ranges::find(places, at) == places.end())
        places.push_back(at);
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

std::vector<std::string> outdated_answers(const SceneDesc &scene, const MapAxis &x,
                                          const MapAxis &y, const AnswerOptions &options) {
    std::vector<std::string> doubtful, outdated;
    for (const ExpectDesc &expect : scene.expects)
        if (std::ranges::any_of(std::array{&x, &y}, [&](const MapAxis *axis) {
                return varies_the_scene(*axis) && !holds_whatever(scene, expect, *axis);
            }))
            doubtful.push_back(expect.name);
    if (doubtful.empty())
        return {};
    const auto is_in = [](const std::vector<std::string> &names, const std::string &name) {
        return std::ranges::find(names, name) != names.end();
    };
    for (const auto &[at_x, at_y] : places_to_try(x, y)) {
        SceneDesc there = options.scene_at(at_x, at_y);
        std::erase_if(there.expects, [&](const ExpectDesc &expect) {
            return !is_in(doubtful, expect.name) || is_in(outdated, expect.name);
        });
        if (there.expects.empty())
            continue;
        RunOptions base = options.base;
        for (const auto &[axis, value] : {std::pair{&x, at_x}, std::pair{&y, at_y}})
            if (is_gravity(*axis))
                base.settings.give(*axis->setting, value);
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

} // namespace plumb
