#include "app/lab/map/theory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

namespace plumb {

namespace {

constexpr int curve_points = 400;

// Of an undamped oscillator, by explicit methods; explicit Euler is stable at no step.
struct SpringLimit {
    double omega_h;
    std::string_view text;
    std::array<std::string_view, 3> methods;
};
constexpr std::array spring_limits{
    SpringLimit{2, "2", {"semi_implicit_euler", "stormer_verlet", "velocity_verlet"}},
    SpringLimit{2 * std::numbers::sqrt2, "2√2", {"rk4"}},
};

struct FlownAxis {
    std::string body;
    int axis = 0;
};

// "body.ball.velocity.x" of a body of that name.
std::optional<FlownAxis> flown_axis(const SceneDesc &scene, const MapAxis &axis) {
    for (const BodyDesc &body : scene.bodies)
        for (int component = 0; component < 3; ++component)
            if (axis.name == "body." + body.name + ".velocity." + "xyz"[component])
                return FlownAxis{body.name, component};
    return std::nullopt;
}

double restitution_of(const SceneDesc &scene, const BodyDesc &body) {
    const ColliderDesc &collider = body.colliders.front();
    const std::string &name = collider.material.empty() ? body.material : collider.material;
    const auto material = std::ranges::find(scene.materials, name, &MaterialDesc::name);
    return material == scene.materials.end() ? 0 : material->restitution;
}

bool in_line(const glm::dvec3 &a, const glm::dvec3 &b, int axis) {
    for (int other = 0; other < 3; ++other)
        if (other != axis && a[other] != b[other])
            return false;
    return true;
}

bool stands_across(const BoundsDesc &wall, const BoundsDesc &body, int axis) {
    for (int other = 0; other < 3; ++other)
        if (other != axis &&
            (wall.min[other] > body.min[other] || wall.max[other] < body.max[other]))
            return false;
    return true;
}

// Along the axis, in the direction of flight: positive is ahead.
struct Span {
    double near = 0, far = 0;
    Span(const BoundsDesc &bounds, int axis, bool forwards)
        : near(forwards ? bounds.min[axis] : -bounds.max[axis]),
          far(forwards ? bounds.max[axis] : -bounds.min[axis]) {}
};

// The only one of these bodies; null when there are none or several.
template <typename Is> const BodyDesc *only_body(const SceneDesc &scene, const Is &is) {
    const BodyDesc *found = nullptr;
    for (const BodyDesc &body : scene.bodies)
        if (is(body)) {
            if (found != nullptr)
                return nullptr;
            found = &body;
        }
    return found;
}

} // namespace

std::optional<StruckBody> struck_before_wall(const SceneDesc &scene, const std::string &striker,
                                             int axis) {
    const auto hits = std::ranges::find(scene.bodies, striker, &BodyDesc::name);
    if (hits == scene.bodies.end() || hits->kind != BodyKind::dynamic ||
        hits->velocity[axis] == 0 || !in_line(hits->velocity, glm::dvec3(0), axis))
        return std::nullopt;
    const bool forwards = hits->velocity[axis] > 0;
    const Span own(bounds(*hits), axis, forwards);
    const BodyDesc *struck = only_body(scene, [&](const BodyDesc &body) {
        return body.kind == BodyKind::dynamic && &body != &*hits;
    });
    if (struck == nullptr || struck->velocity != glm::dvec3(0) ||
        !in_line(struck->position, hits->position, axis))
        return std::nullopt;
    const Span target(bounds(*struck), axis, forwards);
    const BodyDesc *wall =
        only_body(scene, [](const BodyDesc &body) { return body.kind != BodyKind::dynamic; });
    if (wall == nullptr || wall->kind != BodyKind::fixed || has_plane(*wall) ||
        !stands_across(bounds(*wall), bounds(*struck), axis))
        return std::nullopt;
    const Span behind(bounds(*wall), axis, forwards);
    if (!(own.far <= target.near && target.far <= behind.near) ||
        std::max(restitution_of(scene, *hits), restitution_of(scene, *struck)) > 0)
        return std::nullopt;
    const double heavy = mass_of(scene, *hits), light = mass_of(scene, *struck);
    return StruckBody{heavy / (heavy + light),
                      0.5 * (behind.near + behind.far) - 0.5 * (target.near + target.far)};
}

bool swings_by_itself(const SceneDesc &scene, const std::string &spring) {
    if (scene.springs.size() != 1 || !scene.cloths.empty() || !scene.joints.empty())
        return false;
    const SpringDesc &only = scene.springs.front();
    return only.name == spring && only.damping == 0 && only.a.empty() != only.b.empty();
}

namespace {

struct DtAxis {
    bool along_x = false;
    const MapAxis &dt, &other;

    [[nodiscard]] glm::dvec2 point(double dt_value, double value) const {
        return along_x ? glm::dvec2(dt_value, value) : glm::dvec2(value, dt_value);
    }
    // A value of the other axis for each dt.
    template <typename Of> [[nodiscard]] std::vector<glm::dvec2> curve(const Of &value) const {
        std::vector<glm::dvec2> points;
        // Beyond both ends, for the halves of the outer cells.
        const double low = 0.5 * dt.values.front(), high = 2 * dt.values.back();
        for (int i = 0; i <= curve_points; ++i) {
            const double at = low * std::pow(high / low, static_cast<double>(i) / curve_points);
            points.push_back(point(at, value(at)));
        }
        return points;
    }
};

void add_struck(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes) {
    const std::optional<FlownAxis> flown = flown_axis(map.scene, axes.other);
    if (!flown)
        return;
    const std::optional<StruckBody> struck =
        struck_before_wall(map.scene, flown->body, flown->axis);
    if (!struck)
        return;
    TheoryCurve curve;
    curve.name = "theory: struck to the wall's middle in one step";
    for (const MethodMap &of_method : map.methods)
        if (of_method.method->contacts && !of_method.method->looks_ahead)
            curve.methods.push_back(of_method.method);
    if (curve.methods.empty())
        return;
    curve.points = axes.curve([&](double dt) { return struck->way / (struck->speed_ratio * dt); });
    curves.push_back(std::move(curve));
}

void add_spring(std::vector<TheoryCurve> &curves, const StabilityMap &map, const DtAxis &axes,
                const RunOptions &base) {
    const std::string_view name = axes.other.name, head = "spring.", tail = ".frequency";
    if (!name.starts_with(head) || !name.ends_with(tail) ||
        name.size() <= head.size() + tail.size() ||
        !swings_by_itself(map.scene, std::string(name.substr(
                                         head.size(), name.size() - head.size() - tail.size()))))
        return;
    // Those of one limit and as many substeps share a curve.
    for (const SpringLimit &limit : spring_limits) {
        std::map<int, std::vector<const MethodInfo *>> by_substeps;
        for (const MethodMap &of_method : map.methods) {
            if (std::ranges::find(limit.methods, of_method.method->name) == limit.methods.end())
                continue;
            RunOptions run = base;
            run.method = std::string(of_method.method->name);
            by_substeps[resolve_run(map.scene, run).settings.substeps].push_back(of_method.method);
        }
        for (const auto &[substeps, methods] : by_substeps) {
            std::string label = "theory: ω dt = ";
            if (substeps > 1)
                label += std::to_string(substeps) + " × ";
            label += limit.text;
            for (const MethodInfo *method : methods)
                label.append(method == methods.front() ? " (" : ", ").append(method->name);
            const double omega_dt = limit.omega_h * substeps;
            curves.push_back({label + ")", methods, axes.curve([&](double dt) {
                                  return omega_dt / (2 * std::numbers::pi * dt);
                              })});
        }
    }
}

} // namespace

std::vector<TheoryCurve> theory_of(const StabilityMap &map, const RunOptions &base) {
    const auto is_dt = [](const MapAxis &axis) { return axis.name == "dt"; };
    if (is_dt(map.x) == is_dt(map.y))
        return {};
    const DtAxis axes{is_dt(map.x), is_dt(map.x) ? map.x : map.y, is_dt(map.x) ? map.y : map.x};
    std::vector<TheoryCurve> curves;
    add_struck(curves, map, axes);
    add_spring(curves, map, axes, base);
    return curves;
}

} // namespace plumb
