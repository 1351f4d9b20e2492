#include "engine/scene/file/crowd.h"

#include "engine/dynamics/settings.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/touching_boxes.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace plumb {

namespace {

SceneMessage refusal(const ScenePositions &positions, std::size_t body, std::string what,
                     std::string suggestion) {
    const FilePosition &at = positions.bodies[body];
    return {SceneMessage::Severity::error, at.line, at.column, std::move(what),
            std::move(suggestion)};
}

// How far the world grows a body's boxes in the first step; shapes whose grown boxes touch are a
// broad-phase pair.
double reach(const StepSettings &settings, const BodyDesc &body) {
    double reach = settings.speculative_distance / 2;
    if (body.kind != BodyKind::static_body)
        reach += glm::length(body.velocity) * settings.dt;
    if (body.kind == BodyKind::dynamic)
        reach += glm::length(settings.gravity) * settings.dt * settings.dt;
    return reach;
}

bool reaches_below(const BoundsDesc &box, const BodyDesc &body) {
    return std::ranges::any_of(body.colliders, [&](const ColliderDesc &collider) {
        if (!std::holds_alternative<PlaneDesc>(collider.shape))
            return false;
        const glm::dvec3 normal = body.orientation * (collider.orientation * glm::dvec3(0, 1, 0));
        const glm::dvec3 lowest =
            glm::mix(box.max, box.min, glm::greaterThan(normal, glm::dvec3(0)));
        const glm::dvec3 point = body.position + body.orientation * collider.position;
        return glm::dot(normal, lowest - point) <= 0;
    });
}

} // namespace

std::optional<SceneMessage> too_crowded(const SceneDesc &scene, const ScenePositions &positions) {
    const StepSettings settings = scene.world.settings.applied();
    std::vector<std::size_t> planes;
    std::vector<BoundsDesc> boxes;
    std::vector<std::size_t> body_of; // of each box
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDesc &body = scene.bodies[i];
        if (has_plane(body))
            planes.push_back(i);
        if (planes.size() > max_scene_planes)
            return refusal(positions, i, "too many planes",
                           "a scene holds at most " + std::to_string(max_scene_planes));
        const double grown = reach(settings, body);
        for (const ColliderDesc &collider : body.colliders) {
            if (std::holds_alternative<PlaneDesc>(collider.shape))
                continue;
            const BoundsDesc box =
                bounds(collider.shape, body.position + body.orientation * collider.position,
                       body.orientation * collider.orientation);
            boxes.push_back({box.min - grown, box.max + grown});
            body_of.push_back(i);
        }
    }

    std::size_t pairs = 0;
    std::optional<std::size_t> too_many_at;
    const auto count = [&](std::size_t body) {
        if (++pairs <= max_scene_pairs)
            return true;
        too_many_at = body;
        return false;
    };
    for (std::size_t i = 0; i < boxes.size() && !too_many_at; ++i)
        if (scene.bodies[body_of[i]].kind == BodyKind::dynamic)
            for (const std::size_t plane : planes)
                if (reaches_below(boxes[i], scene.bodies[plane]) && !count(body_of[i]))
                    break;
    if (!too_many_at)
        for_touching_boxes(boxes, [&](std::size_t i, std::size_t) { return count(body_of[i]); });
    if (!too_many_at)
        return std::nullopt;
    return refusal(positions, *too_many_at,
                   "with \"" + scene.bodies[*too_many_at].name + "\" more than " +
                       std::to_string(max_scene_pairs) +
                       " pairs of bodies touch or overlap at the start",
                   "each pair takes memory: move the bodies apart (fast ones reach as far as they "
                   "move in a step)");
}

} // namespace plumb
