#include "app/lab/map/theory.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace plumb {

namespace {

constexpr int curve_points = 400;

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

std::vector<TheoryCurve> theory_of(const StabilityMap &map) {
    const auto is_dt = [](const MapAxis &axis) { return axis.name == "dt"; };
    if (is_dt(map.x) == is_dt(map.y))
        return {};
    const bool dt_along_x = is_dt(map.x);
    const MapAxis &dt_axis = dt_along_x ? map.x : map.y;
    const std::optional<FlownAxis> flown = flown_axis(map.scene, dt_along_x ? map.y : map.x);
    if (!flown)
        return {};
    const std::optional<StruckBody> struck =
        struck_before_wall(map.scene, flown->body, flown->axis);
    if (!struck)
        return {};
    TheoryCurve curve;
    curve.name = "theory: struck to the wall's middle in one step";
    for (const MethodMap &of_method : map.methods)
        if (of_method.method->contacts && !of_method.method->looks_ahead)
            curve.methods.push_back(of_method.method);
    if (curve.methods.empty())
        return {};
    // Beyond both ends, for the halves of the outer cells.
    const double low = 0.5 * dt_axis.values.front(), high = 2 * dt_axis.values.back();
    for (int i = 0; i <= curve_points; ++i) {
        const double dt = low * std::pow(high / low, static_cast<double>(i) / curve_points);
        const double speed = struck->way / (struck->speed_ratio * dt);
        curve.points.push_back(dt_along_x ? glm::dvec2(dt, speed) : glm::dvec2(speed, dt));
    }
    return {curve};
}

} // namespace plumb
