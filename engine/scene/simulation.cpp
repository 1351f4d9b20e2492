#include "engine/scene/simulation.h"

#include "engine/core/check.h"
#include "engine/dynamics/method.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/probe_simulation.h"
#include "engine/scene/real/world_simulation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace plumb {

// The header above declares the f32 version; this is its f64 twin, compiled from the same source.
namespace f64 {
std::unique_ptr<Simulation> make_world_simulation(const SceneDesc &, const ResolvedRun &,
                                                  TaskPool *);
}

std::span<const MethodInfo> method_infos() {
    // The registry is the same in both precisions.
    static const std::vector<MethodInfo> infos = [] {
        std::vector<MethodInfo> all;
        for (const Method &method : methods())
            all.push_back(method.info);
        return all;
    }();
    return infos;
}

const MethodInfo *find_method_info(std::string_view name) {
    const auto found = std::ranges::find(method_infos(), name, &MethodInfo::name);
    return found == method_infos().end() ? nullptr : &*found;
}

bool reads(const MethodInfo &method, const SettingRow &setting) {
    return setting.group == SettingGroup::world || setting.group == SettingGroup::step ||
           std::ranges::find(method.reads, setting.group) != method.reads.end();
}

ResolvedRun resolve_run(const SceneDesc &scene, const RunOptions &options) {
    const std::string &name = options.method.empty() ? scene.world.method : options.method;
    ResolvedRun run;
    run.method = find_method_info(name);
    if (run.method == nullptr) {
        std::ostringstream text;
        text << "there is no method '" << name << "'; ";
        std::vector<std::string_view> names;
        for (const MethodInfo &info : method_infos())
            names.push_back(info.name);
        text << did_you_mean(name, names);
        throw std::invalid_argument(text.str());
    }
    run.settings = settings_of(scene.world, *run.method);
    options.settings.apply_to(run.settings);
    for (const SettingNumber number : setting_numbers())
        if (const std::string why = why_refused(number, setting_value(run.settings, number));
            !why.empty())
            throw std::invalid_argument(why);
    run.precision = options.precision.value_or(scene.world.precision);
    return run;
}

StepSettings settings_of(const WorldDesc &world, const MethodInfo &method) {
    GivenSettings given = world.settings;
    if (method.name != world.method) {
        given.erase_if([](const SettingRow &row) { return row.group != SettingGroup::world; });
        const auto other = world.other_methods.find(std::string(method.name));
        if (other != world.other_methods.end())
            given.give(other->second);
    }
    StepSettings settings = method.defaults;
    given.apply_to(settings);
    return settings;
}

void set_run(WorldDesc &world, const MethodInfo &method, const StepSettings &settings) {
    if (method.name != world.method) {
        GivenSettings &left = world.other_methods[world.method] = world.settings;
        left.erase_if([](const SettingRow &row) { return row.group == SettingGroup::world; });
        world.method = method.name;
        world.other_methods.erase(world.method);
    }
    world.settings = GivenSettings::differences(method.defaults, settings);
}

std::string why_not(const MethodInfo &method, const SceneDesc &scene) {
    const std::string name(method.name);
    if (!method.joints && !scene.joints.empty())
        return name + " does not support joints, and the scene has " +
               std::to_string(scene.joints.size());
    if (!method.springs && has_soft_parts(scene))
        return name + " does not support particles and springs, and the scene has some";
    if (!method.contacts && !scene.bodies.empty() &&
        (!scene.particles.empty() || !scene.cloths.empty()))
        return name + " does not support contacts, and the scene has particles and bodies that "
                      "could touch";
    const bool any_dynamic = std::ranges::any_of(
        scene.bodies, [](const BodyDesc &b) { return b.kind == BodyKind::dynamic; });
    if (!method.contacts && any_dynamic && scene.bodies.size() > 1)
        return name + " does not support contacts, and the scene has " +
               std::to_string(scene.bodies.size()) + " bodies that could touch";
    return {};
}

const SoftParts &Simulation::soft_parts() const {
    static const SoftParts none;
    return none;
}

std::optional<std::size_t> Simulation::find_joint(std::string_view name) const {
    for (std::size_t i = 0; i < joint_count(); ++i)
        if (const JointDesc *desc = joint(i); desc != nullptr && desc->name == name)
            return i;
    return {};
}

std::string Simulation::free_name(const std::string &name) const {
    std::string free = name;
    for (int number = 2; find_body(free) || soft_parts().has_name(free); ++number)
        free = name + "_" + std::to_string(number);
    return free;
}

std::size_t Simulation::add_body(BodyDesc body) {
    body.name = free_name(body.name);
    const std::string name = body.name;
    apply(AddBody{std::move(body)});
    return *find_body(name);
}

void Simulation::remove_body(std::size_t body) {
    if (!body_info(body).alive)
        throw std::invalid_argument("body " + std::to_string(body) + " is not alive");
    apply(RemoveBody{body_info(body).name});
}

std::unique_ptr<Simulation> Simulation::create(const SceneDesc &scene, const RunOptions &options,
                                               TaskPool *tasks) {
    const ResolvedRun run = resolve_run(scene, options);
    if (const std::string reason = why_not(*run.method, scene); !reason.empty())
        throw std::invalid_argument(reason);
    if (!plumb::has_world(scene))
        return make_probe_simulation(scene, run);
    try {
        return run.precision == Precision::f64 ? f64::make_world_simulation(scene, run, tasks)
                                               : f32::make_world_simulation(scene, run, tasks);
    } catch (const CheckFailure &failure) {
        throw std::invalid_argument(failure.what());
    }
}

} // namespace plumb
