#include "engine/dynamics/contacts/friction_patch.h"

#include "engine/dynamics/method.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr Real of_line = Real(0.5);
constexpr Real of_disc = Real(2) / Real(3);
// Of regular polygons with n corners, from three on: with a = pi / n,
// (1 + cos^2 a ln((1 + sin a) / cos a) / sin a) / 3; the last for all that have more.
constexpr std::array polygons{Real(0.460), Real(0.541), Real(0.584), Real(0.608),
                              Real(0.623), Real(0.634), Real(0.650)};

Real of_polygon(std::size_t corners) {
    return polygons[std::min(corners - 3, polygons.size() - 1)];
}

// Whether two bodies spin flat on each other: about the contact normal, and too fast for friction
// to stop within a step or so. While a body tips, its load moves to other points from one substep
// to the next.
bool spin_flat(const StepContext &context, const Contact &contact) {
    constexpr Real slow = Real(0.25), flat = Real(0.125);
    const Vec3 &n = contact.manifold.normal;
    const Vec3 spin = context.bodies[contact.key.b].angular_velocity -
                      context.bodies[contact.key.a].angular_velocity;
    const Real along = glm::dot(spin, n);
    const Vec3 across = spin - along * n;
    if (!(glm::dot(across, across) < flat * flat * along * along))
        return false;
    const Vec3 &first = contact.anchors[0].arm_a;
    Real squared = Real(0);
    for (std::size_t k = 1; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        const Vec3 from = contact.anchors[k].arm_a - first;
        squared = std::max(squared, glm::dot(from, from));
    }
    const Real gravity = glm::length(Vec3{context.settings.gravity});
    const Real pull = std::max(greatest_pull(context.model.bodies[contact.key.a], gravity),
                               greatest_pull(context.model.bodies[contact.key.b], gravity));
    const Real speed = slow * static_cast<Real>(context.settings.dt) * pull;
    return along * along * squared > speed * speed;
}

// The spread of the face that a solid touches with, if all contact points are on that face's
// outline; else 0. Points and `out`, the normal away from the solid, are in its body's frame.
Real face_spread(const Shape &solid, std::span<const Vec3> points, const Vec3 &out) {
    constexpr Real near = Real(0.01); // as a share of the size
    if (const auto *cylinder = std::get_if<Cylinder>(&solid)) {
        const Vec3 axis = glm::normalize(cylinder->b - cylinder->a);
        const auto is_on_rim = [&](const Vec3 &point) {
            const Vec3 from = point - cylinder->a;
            const Real radius = glm::length(from - glm::dot(from, axis) * axis);
            return radius > (Real(1) - near) * cylinder->radius;
        };
        return std::ranges::all_of(points, is_on_rim) ? of_disc : Real(0);
    }
    const auto *hull = std::get_if<ConvexHull>(&solid);
    if (hull == nullptr)
        return Real(0);
    const HullMesh &mesh = *hull->mesh;
    const Quat back = glm::conjugate(hull->rotation);
    const HullMesh::Face &face = mesh.faces[supporting_face(mesh, back * out)];
    const auto is_corner = [&](const Vec3 &point) {
        const Vec3 local = back * (point - hull->position);
        return std::ranges::any_of(std::span(mesh.vertex_indices).subspan(face.first, face.count),
                                   [&](std::uint32_t v) {
                                       return glm::distance(mesh.vertices[v], local) <
                                              near * glm::distance(mesh.center, local);
                                   });
    };
    return std::ranges::all_of(points, is_corner) ? of_polygon(face.count) : Real(0);
}

// The spread of a rectangle with the given corners. It grows from that of a line to that of a
// square about as x (2 - x) with the ratio x of its sides.
Real rectangle_spread(std::span<const ContactAnchor> corners, const Vec3 &normal) {
    Vec3 middle{Real(0)};
    for (const ContactAnchor &corner : corners)
        middle += corner.arm_a / static_cast<Real>(corners.size());
    const TangentBasis tangents = tangent_basis(normal);
    Real xx = Real(0), xy = Real(0), yy = Real(0);
    for (const ContactAnchor &corner : corners) {
        const Vec3 from = corner.arm_a - middle;
        const Real x = glm::dot(from, tangents.t1), y = glm::dot(from, tangents.t2);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const Real half_difference = Real(0.5) * (xx - yy);
    const Real mean = Real(0.5) * (xx + yy);
    const Real apart = std::sqrt(half_difference * half_difference + xy * xy);
    const Real ratio = std::sqrt(std::max(mean - apart, Real(0)) / (mean + apart));
    return of_line + (of_polygon(4) - of_line) * ratio * (Real(2) - ratio);
}

} // namespace

Real patch_spread(const StepContext &context, const Contact &contact) {
    const auto count = static_cast<std::size_t>(contact.manifold.count);
    if (count == 1 || !spin_flat(context, contact))
        return Real(1);
    if (count == 2)
        return of_line;
    if (count == 3)
        return of_polygon(3);
    std::array<Vec3, 4> on_a{}, on_b{};
    for (std::size_t k = 0; k < count; ++k) {
        on_a[k] = contact.anchors[k].core_a;
        on_b[k] = contact.anchors[k].core_b;
    }
    const auto spread_on = [&](std::uint32_t collider, std::uint32_t body,
                               std::span<const Vec3> points, const Vec3 &out) {
        return face_spread(context.model.colliders[collider].shape, points,
                           glm::conjugate(context.bodies[body].rotation) * out);
    };
    const Vec3 &n = contact.manifold.normal;
    const Real face = std::max(spread_on(contact.collider_a, contact.key.a, on_a, n),
                               spread_on(contact.collider_b, contact.key.b, on_b, -n));
    return face > of_polygon(4) ? face
                                : rectangle_spread(std::span(contact.anchors).first(count), n);
}

} // namespace plumb::inline PLUMB_PRECISION
