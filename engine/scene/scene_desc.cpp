#include "engine/scene/scene_desc.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>

namespace plumb {

namespace {

const MaterialDesc *find_material(const SceneDesc &scene, const std::string &name) {
    const auto found = std::ranges::find(scene.materials, name, &MaterialDesc::name);
    return found == scene.materials.end() ? nullptr : &*found;
}

} // namespace

double density_of(const SceneDesc &scene, const BodyDesc &body, const ColliderDesc &collider) {
    if (collider.density)
        return *collider.density;
    if (const MaterialDesc *material = find_material(scene, collider.material);
        material != nullptr && !collider.material.empty())
        return material->density;
    if (body.density)
        return *body.density;
    const MaterialDesc *material = find_material(scene, body.material);
    return material != nullptr && !body.material.empty() ? material->density
                                                         : MaterialDesc{}.density;
}

double mass_of(const SceneDesc &scene, const BodyDesc &body) {
    if (body.mass)
        return *body.mass;
    double mass = 0;
    for (const ColliderDesc &collider : body.colliders)
        if (!collider.sensor)
            mass += density_of(scene, body, collider) * volume(collider.shape);
    return mass;
}

double smallest_width(const BodyDesc &body) {
    double width = std::numeric_limits<double>::infinity();
    for (const ColliderDesc &collider : body.colliders)
        width = std::min(width, smallest_width(collider.shape));
    return width;
}

BoundsDesc bounds(const BodyDesc &body) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    BoundsDesc all{glm::dvec3(infinite), glm::dvec3(-infinite)};
    for (const ColliderDesc &collider : body.colliders) {
        const BoundsDesc one =
            bounds(collider.shape, body.position + body.orientation * collider.position,
                   body.orientation * collider.orientation);
        all.min = glm::min(all.min, one.min);
        all.max = glm::max(all.max, one.max);
    }
    return all;
}

bool has_plane(const BodyDesc &body) {
    return std::ranges::any_of(body.colliders, [](const ColliderDesc &collider) {
        return std::holds_alternative<PlaneDesc>(collider.shape);
    });
}

} // namespace plumb
