#include "app/sandbox/draw/framing.h"

#include "app/render/culling.h"
#include "app/sandbox/draw/world_draw.h"
#include "engine/scene/cloth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace plumb {

namespace {

constexpr float widest_view = 16.0f / 9;
constexpr float air_around = 1.1f;
// A shape whose bounding radius exceeds this many camera distances is a floor or a wall.
constexpr float wide = 0.8f;

// Whether anything holds particles up.
bool is_pinned(const SceneDesc &scene) {
    return std::ranges::any_of(scene.particles, &ParticleDesc::pinned) ||
           std::ranges::any_of(scene.cloths,
                               [](const ClothDesc &cloth) { return !cloth.pins.empty(); }) ||
           std::ranges::any_of(scene.springs, [](const SpringDesc &spring) {
               return spring.a.empty() || spring.b.empty();
           });
}

} // namespace

float aspect_needed(const DrawList &list) {
    const Camera &camera = list.camera;
    float half_width = 0; // of the picture, relative to half its height
    const auto add = [&](const glm::vec3 &place, float radius) {
        const glm::vec3 d = place - camera.eye();
        const float depth = glm::dot(d, camera.forward());
        if (!finite(place) || depth <= radius + camera.near_plane())
            return;
        const float aside = std::abs(glm::dot(d, camera.right())) + radius;
        half_width = std::max(half_width, aside / (depth * std::tan(0.5f * camera.fov)));
    };
    for (const DrawShape &shape : list.shapes)
        if (const float radius = bounding_radius(shape); radius < wide * camera.distance)
            add(shape.position, radius);
    for (const DrawMesh &mesh : list.meshes)
        for (const glm::vec3 &corner : *mesh.corners)
            add(mesh.position + mesh.rotation * corner, 0);
    for (const DrawLine &line : list.lines) {
        add(line.a, 0);
        add(line.b, 0);
    }
    for (const DrawPoint &point : list.points)
        add(point.position, 0);
    return std::clamp(air_around * half_width, 1.0f, widest_view);
}

glm::vec3 shift_to_see(const Camera &camera, float aspect, std::span<const glm::vec3> places) {
    const float up = std::tan(0.5f * camera.fov) / air_around; // half the height, at unit depth
    const float aside = up * aspect;
    glm::vec3 least(0);
    float least_length = std::numeric_limits<float>::max();
    for (const glm::vec3 &place : places) {
        if (!finite(place))
            continue;
        const glm::vec3 d = place - camera.target;
        const float z = glm::dot(d, camera.forward());
        const float x = std::abs(glm::dot(d, camera.right()));
        const float y = std::abs(glm::dot(d, camera.up()));
        // At target + s d the place is visible if s x <= aside (distance + s z), the same for y,
        // and s z <= distance.
        float s = 1;
        for (const float limit : {aside / (x - aside * z), up / (y - up * z), 1 / z})
            if (limit > 0)
                s = std::min(s, limit * camera.distance);
        const glm::vec3 shift = (1 - s) * d;
        if (const float length = glm::length(shift); length < least_length) {
            least = shift;
            least_length = length;
        }
    }
    return least;
}

std::optional<DrawPlane> plane_behind(const SceneDesc &scene) {
    bool is_held = !scene.joints.empty() || is_pinned(scene) ||
                   scene.world.settings.applied().gravity == glm::dvec3(0);
    double lowest = std::numeric_limits<double>::max();
    for (const BodyDesc &body : scene.bodies) {
        if (has_plane(body))
            return std::nullopt;
        is_held = is_held || body.kind == BodyKind::static_body;
        for (const ColliderDesc &collider : body.colliders)
            lowest = std::min(lowest, bounds(collider.shape,
                                             body.position + body.orientation * collider.position,
                                             body.orientation * collider.orientation)
                                          .min.y);
    }
    for (const ParticleDesc &particle : scene.particles)
        lowest = std::min(lowest, particle.position.y - particle.radius);
    for (const ClothDesc &cloth : scene.cloths)
        for (std::uint32_t i = 0; i < particle_count(cloth); ++i)
            lowest = std::min(lowest, start_of(cloth, i).position.y - cloth.radius);
    const Camera camera = camera_of(scene.camera);
    const float half_height = camera.distance * std::tan(0.5f * camera.fov);
    DrawPlane plane;
    plane.position = camera.target;
    if (is_held) {
        const float border = camera.target.y - 0.85f * half_height * camera.up().y;
        plane.position.y = std::min(border, static_cast<float>(lowest));
        return plane;
    }
    const glm::vec3 towards(std::sin(camera.yaw), 0, std::cos(camera.yaw));
    plane.position -= 0.5f * half_height * towards;
    plane.rotation = glm::angleAxis(camera.yaw, glm::vec3(0, 1, 0)) *
                     glm::angleAxis(glm::radians(90.0f), glm::vec3(1, 0, 0));
    return plane;
}

} // namespace plumb
