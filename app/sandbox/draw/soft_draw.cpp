#include "app/sandbox/draw/soft_draw.h"

#include "app/render/palette.h"
#include "app/sandbox/draw/joint_draw.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

bool is_finite(const glm::dvec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_open(const ClothInfo::Triangle &triangle, const SoftView &view) {
    return std::ranges::any_of(triangle.sides,
                               [&](std::uint32_t side) {
                                   return side < view.torn.size() && view.torn[side] != 0;
                               }) ||
           !std::ranges::all_of(triangle.corners, [&](std::uint32_t corner) {
               return is_finite(view.particles[corner].position);
           });
}

const glm::dvec3 &corner_of(const ClothInfo::Triangle &triangle, std::size_t k,
                            const SoftView &view) {
    return view.particles[triangle.corners[k]].position;
}

// Not normalised: its length is twice the triangle's area.
glm::dvec3 normal_of(const ClothInfo::Triangle &triangle, const SoftView &view) {
    const glm::dvec3 &a = corner_of(triangle, 0, view);
    return glm::cross(corner_of(triangle, 1, view) - a, corner_of(triangle, 2, view) - a);
}

// Whether the spring is too short compared with its particles for a coil to show.
bool is_short(const SpringInfo &spring, const SoftView &view) {
    double radius = 0;
    for (const SpringEndInfo *end : {&spring.a, &spring.b})
        if (end->kind == SpringEndInfo::Kind::particle)
            radius = std::max(radius, view.parts.particles[end->index].radius);
    return spring.rest_length < 8 * radius;
}

// Wire radius of a straight spring: half its thinner particle's radius.
double wire_radius(const SpringInfo &spring, const SoftView &view) {
    double radius = spring.rest_length;
    for (const SpringEndInfo *end : {&spring.a, &spring.b})
        if (end->kind == SpringEndInfo::Kind::particle)
            radius = std::min(radius, view.parts.particles[end->index].radius);
    return 0.5 * radius;
}

void draw_springs(DrawList &list, const SoftView &view) {
    for (std::size_t i = 0; i < view.parts.springs.size(); ++i) {
        const SpringInfo &spring = view.parts.springs[i];
        if (spring.cloth || (i < view.torn.size() && view.torn[i] != 0))
            continue;
        const glm::dvec3 a = place_of(spring.a, view.bodies, view.particles);
        const glm::dvec3 b = place_of(spring.b, view.bodies, view.particles);
        if (is_short(spring, view))
            draw_wire(list, a, b, wire_radius(spring, view));
        else
            draw_spring(list, a, b, spring.rest_length);
    }
}

void draw_particles(DrawList &list, const SoftView &view,
                    const std::optional<std::size_t> &selected,
                    const std::optional<std::size_t> &hovered) {
    for (std::size_t i = 0; i < view.parts.particles.size(); ++i) {
        const ParticleInfo &particle = view.parts.particles[i];
        const bool is_marked = selected == i || hovered == i;
        if (particle.cloth && !particle.pinned && !is_marked)
            continue;
        DrawShape ball;
        ball.position = glm::vec3(view.particles[i].position);
        ball.size = glm::vec3(static_cast<float>((particle.cloth ? 1.5 : 1.0) * particle.radius));
        ball.colour =
            particle.pinned
                ? colours::static_body
                : particle.colour.value_or(palette_colour(particle.cloth ? *particle.cloth : i));
        ball.selected = selected == i;
        ball.highlighted = hovered == i;
        list.shapes.push_back(ball);
    }
}

// Ray parameter where the ray hits the triangle, from either side.
std::optional<double> meet(const std::array<glm::dvec3, 3> &corners, const glm::dvec3 &origin,
                           const glm::dvec3 &direction) {
    // Moeller and Trumbore 1997.
    const glm::dvec3 ab = corners[1] - corners[0];
    const glm::dvec3 ac = corners[2] - corners[0];
    const glm::dvec3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0)
        return std::nullopt;
    const glm::dvec3 s = origin - corners[0];
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(ac, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? std::optional(t) : std::nullopt;
}

} // namespace

ClothSurface cloth_surface(const ClothInfo &cloth, const SoftView &view) {
    std::vector<glm::dvec3> sums(cloth.particle_count);
    for (const ClothInfo::Triangle &triangle : cloth.triangles)
        if (!is_open(triangle, view))
            for (const std::uint32_t corner : triangle.corners)
                sums[corner - cloth.first_particle] += normal_of(triangle, view);
    const auto corners = std::make_shared<Corners>();
    const auto normals = std::make_shared<Corners>();
    for (const ClothInfo::Triangle &triangle : cloth.triangles) {
        const glm::dvec3 own = normal_of(triangle, view);
        if (is_open(triangle, view) || !(glm::length(own) > 0))
            continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3 &sum = sums[triangle.corners[k] - cloth.first_particle];
            // Where folds cancel each other, use the triangle's own normal.
            const glm::dvec3 normal = glm::dot(sum, own) > 0 ? sum : own;
            corners->emplace_back(corner_of(triangle, k, view));
            normals->emplace_back(glm::normalize(normal));
        }
    }
    return {corners, normals};
}

void draw_soft_parts(DrawList &list, const SoftView &view,
                     const std::optional<std::size_t> &selected,
                     const std::optional<std::size_t> &hovered) {
    draw_particles(list, view, selected, hovered);
    draw_springs(list, view);
    for (std::size_t i = 0; i < view.parts.cloths.size(); ++i) {
        const ClothInfo &cloth = view.parts.cloths[i];
        const ClothSurface surface = cloth_surface(cloth, view);
        if (surface.corners->empty())
            continue;
        DrawMesh mesh;
        mesh.corners = surface.corners;
        mesh.normals = surface.normals;
        mesh.colour = cloth.colour.value_or(palette_colour(i));
        list.meshes.push_back(std::move(mesh));
    }
}

std::optional<ParticlePick> pick_particle(const SoftView &view, const glm::dvec3 &origin,
                                          const glm::dvec3 &direction, double aperture) {
    std::optional<ParticlePick> nearest;
    const auto offer = [&](std::size_t particle, double t) {
        if (!nearest || t < nearest->t)
            nearest = ParticlePick{particle, t, view.particles[particle].position};
    };
    for (std::size_t i = 0; i < view.parts.particles.size(); ++i) {
        if (view.parts.particles[i].cloth)
            continue;
        const glm::dvec3 way = view.particles[i].position - origin;
        const double t = glm::dot(way, direction);
        const double radius = std::max(view.parts.particles[i].radius, aperture * t);
        const double aside = glm::length(way - t * direction);
        if (t > 0 && aside <= radius)
            offer(i, t - std::sqrt(radius * radius - aside * aside));
    }
    for (const ClothInfo &cloth : view.parts.cloths)
        for (const ClothInfo::Triangle &triangle : cloth.triangles) {
            if (is_open(triangle, view))
                continue;
            const std::array corners{corner_of(triangle, 0, view), corner_of(triangle, 1, view),
                                     corner_of(triangle, 2, view)};
            const std::optional<double> t = meet(corners, origin, direction);
            if (!t)
                continue;
            const glm::dvec3 point = origin + *t * direction;
            const auto *const corner = std::ranges::min_element(
                corners, {}, [&](const glm::dvec3 &at) { return glm::distance(at, point); });
            offer(triangle.corners[static_cast<std::size_t>(corner - corners.begin())], *t);
        }
    return nearest;
}

} // namespace plumb
