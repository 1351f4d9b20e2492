#include "app/lab/tune/plainer.h"

#include "app/lab/run/sweep.h"
#include "app/lab/timing.h"
#include "app/lab/tune/trial.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace plumb {

namespace {

// What the copies of a `repeat` have in common: "crate" of "crate_12".
std::string stem(const std::string &name) {
    const std::size_t end = name.find_last_not_of("0123456789");
    return end != std::string::npos && end > 0 && end + 1 < name.size() && name[end] == '_'
               ? name.substr(0, end)
               : name;
}

bool turns(const BodyDesc &body) {
    return body.kind == BodyKind::dynamic && !(body.locked[3] && body.locked[4] && body.locked[5]);
}

void lock_rotation(BodyDesc &body) {
    std::fill(body.locked.begin() + 3, body.locked.end(), true);
    body.angular_velocity = glm::dvec3(0);
}

// Of the one shape of a dynamic body that a sphere could stand for; else empty.
std::string_view shape_name(const BodyDesc &body) {
    if (body.kind != BodyKind::dynamic || body.colliders.size() != 1 || body.colliders[0].sensor)
        return {};
    const ShapeDesc &shape = body.colliders[0].shape;
    return std::holds_alternative<BoxDesc>(shape)        ? "box"
           : std::holds_alternative<CapsuleDesc>(shape)  ? "capsule"
           : std::holds_alternative<CylinderDesc>(shape) ? "cylinder"
           : std::holds_alternative<HullDesc>(shape)     ? "hull"
                                                         : "";
}

void make_sphere(BodyDesc &body) {
    if (shape_name(body).empty())
        return;
    ColliderDesc &collider = body.colliders[0];
    const BoundsDesc box = bounds(collider.shape, collider.position, collider.orientation);
    const double radius = std::cbrt(volume(collider.shape) * 3 / (4 * std::numbers::pi));
    collider.shape = SphereDesc{radius};
    collider.position = (box.min + box.max) / 2.0;
}

// Of all bodies with that stem.
Simplification of_bodies(std::string what, const std::string &name, void (*apply)(BodyDesc &)) {
    return {std::move(what), [name, apply](SceneDesc &scene, RunOptions &) {
                for (BodyDesc &body : scene.bodies)
                    if (body.kind == BodyKind::dynamic && stem(body.name) == name)
                        apply(body);
            }};
}

} // namespace

std::vector<Simplification> simplifications(const SceneDesc &scene, const RunOptions &options) {
    std::vector<Simplification> all;
    const ResolvedRun run = resolve_run(scene, options);
    const SettingRow &sleep = *find_setting("sleep_after");
    if (reads(*run.method, sleep) && run.settings.sleep_after > 0 && !options.settings.has(sleep))
        all.push_back({"sleep", [](SceneDesc &, RunOptions &plain) {
                           plain.settings.give(&StepSettings::sleep_after, 0.0);
                       }});
    std::set<std::string> done;
    for (const BodyDesc &body : scene.bodies) {
        const std::string name = stem(body.name);
        if (!done.insert(name).second)
            continue;
        if (turns(body))
            all.push_back(of_bodies("the rotation of " + name, name, lock_rotation));
        if (const std::string_view shape = shape_name(body); !shape.empty())
            all.push_back(
                of_bodies("the " + std::string(shape) + " of " + name + " (a sphere will do)", name,
                          make_sphere));
    }
    return all;
}

void leave_out(const std::vector<SceneDesc> &starts, const TuneOptions &options, Tuning &tuning,
               const Progress &progress) {
    const auto stopped = [&] { return options.stop && options.stop(); };
    std::vector<SceneDesc> model = starts;
    TunedRun full = tuning.runs[*tuning.chosen];
    for (const Simplification &less : simplifications(starts.front(), full.options)) {
        std::vector<SceneDesc> plain = model;
        RunOptions run = full.options;
        for (SceneDesc &start : plain)
            less.apply(start, run);
        const Trial trial(plain, options), fuller(model, options);
        PlainerModel tried{less.what, trial.run(run, progress)};
        if (tried.run.verdict == TuneVerdict::met)
            time_in_turns({{&fuller, &full}, {&trial, &tried.run}}, options, progress);
        if (stopped())
            return;
        if (!tried.run.timings.empty()) {
            tried.times_as_dear = median_ratio(tried.run.timings, full.timings);
            tried.is_enough = !is_always_dearer(tried.run, full);
        }
        if (tried.is_enough) {
            model = std::move(plain);
            full = tried.run;
        }
        tuning.plainer.push_back(std::move(tried));
    }
}

} // namespace plumb
