#include "app/lab/tune/plainer.h"

#include "app/lab/run/sweep.h"
#include "app/lab/timing.h"
#include "app/lab/tune/trial.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>

namespace plumb {

namespace {

// The name that the copies of a `repeat` share: "crate" for "crate_12".
std::string stem(const std::string &name) {
    const std::size_t end = name.find_last_not_of("0123456789");
    return end != std::string::npos && end > 0 && end + 1 < name.size() && name[end] == '_'
               ? name.substr(0, end)
               : name;
}

std::uint32_t layers_of(const SceneDesc &scene) {
    std::uint32_t layers = 0;
    for (const BodyDesc &body : scene.bodies)
        for (const ColliderDesc &collider : body.colliders)
            layers |= std::uint32_t{1} << static_cast<unsigned>(collider.filter.layer);
    return layers;
}

// Whether the body does not ignore all of these layers.
bool collides(const BodyDesc &body, std::uint32_t layers) {
    return std::ranges::any_of(body.colliders, [&](const ColliderDesc &collider) {
        return (~collider.filter.ignores & layers) != 0;
    });
}

// Whether any two bodies could collide, wherever they are, leaving out those with stem `but`.
bool any_collide(const SceneDesc &scene, const std::string &but = {}) {
    const std::uint32_t layers = layers_of(scene);
    int bodies = 0;
    bool any_dynamic = false;
    for (const BodyDesc &body : scene.bodies)
        if (collides(body, layers) && stem(body.name) != but) {
            ++bodies;
            any_dynamic = any_dynamic || body.kind == BodyKind::dynamic;
        }
    return bodies > 1 && any_dynamic;
}

void ignore_all(BodyDesc &body) {
    for (ColliderDesc &collider : body.colliders)
        collider.filter.ignores = ~std::uint32_t{0};
}

bool turns(const BodyDesc &body) {
    return body.kind == BodyKind::dynamic && !(body.locked[3] && body.locked[4] && body.locked[5]);
}

void lock_rotation(BodyDesc &body) {
    if (!turns(body))
        return;
    std::fill(body.locked.begin() + 3, body.locked.end(), true);
    body.angular_velocity = glm::dvec3(0);
}

// The name of a dynamic body's only shape, if a sphere could replace it; else empty.
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

// Applies to all bodies with that stem.
Simplification of_bodies(std::string what, const std::string &name, void (*apply)(BodyDesc &)) {
    return {std::move(what), [name, apply](SceneDesc &scene, RunOptions &) {
                for (BodyDesc &body : scene.bodies)
                    if (stem(body.name) == name)
                        apply(body);
            }};
}

// The first body of each stem.
std::vector<const BodyDesc *> kinds_of_bodies(const SceneDesc &scene) {
    std::vector<const BodyDesc *> kinds;
    std::set<std::string> done;
    for (const BodyDesc &body : scene.bodies)
        if (done.insert(stem(body.name)).second)
            kinds.push_back(&body);
    return kinds;
}

std::vector<Simplification> without_sleep(const ResolvedRun &run, const RunOptions &options) {
    const SettingRow &sleep = *find_setting("sleep_after");
    if (!reads(*run.method, sleep) || run.settings.sleep_after <= 0 || options.settings.has(sleep))
        return {};
    return {{"sleep", [](SceneDesc &, RunOptions &plain) {
                 plain.settings.give(&StepSettings::sleep_after, 0.0);
             }}};
}

bool expects_something_of_contacts(const SceneDesc &scene) {
    return std::ranges::any_of(scene.expects, [](const ExpectDesc &expect) {
        const QuantityInfo *quantity = find_quantity(expect.quantity);
        return quantity != nullptr && quantity->of_contacts;
    });
}

// Particles collide with bodies on every layer, and still do. Not tried if the scene expects
// something of contacts: having none would meet it.
std::vector<Simplification> without_collisions(const SceneDesc &scene, const ResolvedRun &run) {
    if (!run.method->contacts || !any_collide(scene) || expects_something_of_contacts(scene))
        return {};
    const bool has_particles = !scene.particles.empty() || !scene.cloths.empty();
    std::vector<Simplification> all;
    all.push_back({.what = has_particles ? "collisions between bodies" : "collisions",
                   .apply = [](SceneDesc &plain,
                               RunOptions &) { std::ranges::for_each(plain.bodies, ignore_all); },
                   .is_all = true});
    const std::uint32_t layers = layers_of(scene);
    for (const BodyDesc *body : kinds_of_bodies(scene))
        if (const std::string name = stem(body->name);
            collides(*body, layers) && any_collide(scene, name)) // else the same as all
            all.push_back(of_bodies("the collisions of " + name, name, ignore_all));
    for (Simplification &less : all)
        less.must_pay = true;
    return all;
}

std::vector<Simplification> without_rotation(const SceneDesc &scene) {
    std::vector<Simplification> all;
    for (const BodyDesc *body : kinds_of_bodies(scene))
        if (const std::string name = stem(body->name); turns(*body))
            all.push_back(of_bodies("the rotation of " + name, name, lock_rotation));
    return all;
}

std::vector<Simplification> with_spheres(const SceneDesc &scene) {
    std::vector<Simplification> all;
    for (const BodyDesc *body : kinds_of_bodies(scene)) {
        const std::string name = stem(body->name);
        if (const std::string_view shape = shape_name(*body); !shape.empty())
            all.push_back(
                of_bodies("the " + std::string(shape) + " of " + name + " (a sphere will do)", name,
                          make_sphere));
    }
    return all;
}

} // namespace

std::string_view about(ModelPart part) {
    switch (part) {
    case ModelPart::sleep:
        return "sleep";
    case ModelPart::collisions:
        return "collisions";
    case ModelPart::rotation:
        return "a body's rotation";
    case ModelPart::shape:
        return "its shape";
    }
    return "";
}

std::string model_parts_text() {
    std::string text;
    constexpr std::size_t count = std::size(all_model_parts);
    for (std::size_t i = 0; i < count; ++i) {
        text += i == 0 ? "" : i + 1 < count ? ", " : " and ";
        text += about(all_model_parts[i]);
    }
    return text;
}

std::vector<Simplification> simplifications(ModelPart part, const SceneDesc &scene,
                                            const RunOptions &options) {
    switch (part) {
    case ModelPart::sleep:
        return without_sleep(resolve_run(scene, options), options);
    case ModelPart::collisions:
        return without_collisions(scene, resolve_run(scene, options));
    case ModelPart::rotation:
        return without_rotation(scene);
    case ModelPart::shape:
        return with_spheres(scene);
    }
    return {};
}

void leave_out(const std::vector<SceneDesc> &starts, const TuneOptions &options, Tuning &tuning,
               const Progress &progress) {
    const auto stopped = [&] { return options.stop && options.stop(); };
    std::vector<SceneDesc> model = starts;
    TunedRun full = tuning.runs[*tuning.chosen];
    // Returns whether it was left out.
    const auto attempt = [&](const Simplification &less) {
        std::vector<SceneDesc> plain = model;
        RunOptions run = full.options;
        for (SceneDesc &start : plain)
            less.apply(start, run);
        const Trial trial(plain, options), fuller(model, options);
        PlainerModel tried{less.what, trial.run(run, progress)};
        if (tried.run.verdict == TuneVerdict::met)
            time_in_turns({{&fuller, &full}, {&trial, &tried.run}}, options, progress);
        if (stopped())
            return false;
        if (!tried.run.timings.empty()) {
            tried.times_as_dear = median_ratio(tried.run.timings, full.timings);
            tried.is_enough = less.must_pay ? tried.times_as_dear < 1 / same_cost
                                            : !is_always_dearer(tried.run, full);
        }
        if (tried.is_enough) {
            model = std::move(plain);
            full = tried.run;
        }
        tuning.plainer.push_back(std::move(tried));
        return tuning.plainer.back().is_enough;
    };
    for (const ModelPart part : all_model_parts)
        for (const Simplification &less : simplifications(part, model.front(), full.options)) {
            const bool is_left_out = attempt(less);
            if (stopped())
                return;
            if (is_left_out && less.is_all)
                break;
        }
}

} // namespace plumb
