#include "engine/scene/start_overlaps.h"

#include "engine/geometry/manifold.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <variant>

namespace plumb {

namespace {

bool do_collide(const ColliderDesc &a, const ColliderDesc &b) {
    const auto ignores = [](const FilterDesc &one, const FilterDesc &other) {
        return (one.ignores >> static_cast<unsigned>(other.layer) & 1U) != 0;
    };
    return !a.sensor && !b.sensor && !ignores(a.filter, b.filter) && !ignores(b.filter, a.filter);
}

} // namespace

// Empty for shapes that are skipped.
std::optional<f32::Shape> StartOverlaps::placed(const ColliderDesc &collider,
                                                const glm::dvec3 &position,
                                                const glm::dquat &orientation) {
    const auto [made, is_new] = made_.try_emplace(&collider);
    if (is_new)
        made->second = f32::solid_shape(collider.shape);
    if (!made->second.shape)
        return std::nullopt;
    const f32::Transform pose{f32::Vec3(position), f32::unit(f32::Quat(orientation))};
    return f32::placed(*made->second.shape, pose);
}

std::optional<double> StartOverlaps::deepest(const BodyDesc &a, const BodyDesc &b, double margin) {
    // Relative to the first body, or to the second if the first has a plane, whose origin may be
    // far away.
    const glm::dvec3 origin = has_plane(a) ? b.position : a.position;
    const auto place = [&](const BodyDesc &body, const ColliderDesc &collider) {
        return placed(collider, body.position - origin + body.orientation * collider.position,
                      body.orientation * collider.orientation);
    };
    std::optional<double> depth;
    for (const ColliderDesc &collider_a : a.colliders) {
        const std::optional<f32::Shape> shape_a = place(a, collider_a);
        for (const ColliderDesc &collider_b : b.colliders) {
            if (!shape_a || !do_collide(collider_a, collider_b))
                continue;
            const std::optional<f32::Shape> shape_b = place(b, collider_b);
            if (!shape_b)
                continue;
            const f32::Manifold manifold =
                f32::collide(*shape_a, *shape_b, static_cast<float>(margin));
            for (int i = 0; i < manifold.count; ++i)
                depth = std::max(
                    depth.value_or(0),
                    -static_cast<double>(manifold.points[static_cast<std::size_t>(i)].separation));
        }
    }
    return depth;
}

} // namespace plumb
