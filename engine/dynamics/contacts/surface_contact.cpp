#include "engine/dynamics/contacts/surface_contact.h"

#include "engine/dynamics/contacts/triangle_face.h"

#include "engine/geometry/aabb.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/support.h"
#include "engine/geometry/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Cosine of an angle below which two faces lie in a plane.
constexpr Real in_plane = Real(1) - Real(1e-6);

// The solid's deepest point against a face, when the contact is with the face alone.
constexpr std::uint32_t deepest_point_feature = 0xFFFFFFFFU;
// The same, of a solid that is inside.
constexpr std::uint32_t inside_feature = 0xFFFFFFFCU;

// The solid's farthest point along a unit direction.
Vec3 farthest(const Shape &solid, const Vec3 &direction) {
    return std::visit(
        [&]<typename Solid>(const Solid &shape) -> Vec3 {
            if constexpr (std::same_as<Solid, HalfSpace>) {
                return Vec3{Real(0)};
            } else {
                const Vec3 origin = place_of(shape);
                const auto core = core_of(shape, origin);
                return origin + core.support(direction) + core.radius * direction;
            }
        },
        solid);
}

Manifold collide_triangle(const Shape &solid, const Triangle &triangle, Real margin,
                          const Vec3 *load) {
    return std::visit(
        [&]<typename Solid>(const Solid &shape) -> Manifold {
            if constexpr (std::same_as<Solid, HalfSpace>)
                return {};
            else if constexpr (CollidesUnderLoad<Solid, Triangle>)
                return load == nullptr ? unchecked::collide(shape, triangle, margin)
                                       : unchecked::collide_under(shape, triangle, margin,
                                                                  Vec3{Real(0)}, *load);
            else
                return unchecked::collide(shape, triangle, margin);
        },
        solid);
}

// Whether the surface allows a contact at `point` whose normal leans to `out`: over a border, or
// over a ridge by no more than the face beyond it.
bool may_lean(const TriangleSurface &surface, const Transform &pose, std::uint32_t index,
              const TriangleFace &triangle, const Vec3 &point, const Vec3 &out) {
    const Real near = Real(1e-3) * triangle.size;
    for (std::size_t edge = 0; edge < 3; ++edge) {
        const int number = static_cast<int>(edge);
        if (std::abs(triangle.beyond(point, edge)) > near || !surface.is_outer_edge(index, number))
            continue;
        const Vec3 along = triangle.corners[(edge + 1) % 3] - triangle.corners[edge];
        const Vec3 outward = glm::cross(along, triangle.normal);
        if (glm::dot(outward, out) < Real(0))
            continue; // leans to the inside of this edge
        const Vec3 beyond = to_world_vector(pose, surface.normal_beyond(index, number));
        const Real bend = glm::dot(beyond, triangle.normal);
        const bool is_border = bend >= in_plane;
        if (is_border || std::abs(glm::dot(out, triangle.normal)) >= bend - Real(1e-3))
            return true;
    }
    return false;
}

// Whether a point at this depth under a face, and this far beyond its edge, lies where a hollow
// opens: below both faces it is beyond the edge of each. The face that it is deeper under takes it,
// or both do.
bool is_in_hollow(Real bend, Real depth, Real beyond) {
    constexpr Real rounding = Real(1.01);
    return depth > Real(0) && beyond * std::sqrt(std::max(Real(1) + bend, Real(0))) <=
                                  rounding * depth * std::sqrt(std::max(Real(1) - bend, Real(0)));
}

// A manifold's points with the triangle's own normal: their heights above its plane. What lies
// nearly flat over an inner edge comes to rest on both triangles.
Manifold flattened(const Manifold &manifold, const Vec3 &face, const Vec3 &corner, Real margin) {
    constexpr Real nearly_flat = Real(0.98); // cosine
    Manifold result;
    result.normal = -face;
    if (manifold.count < 3 || !(-glm::dot(manifold.normal, face) > nearly_flat))
        return result;
    for (int k = 0; k < manifold.count; ++k) {
        const ManifoldPoint &point = manifold.points[static_cast<std::size_t>(k)];
        const Vec3 on_solid = point.position - (Real(0.5) * point.separation) * manifold.normal;
        const Real height = glm::dot(face, on_solid - corner);
        if (height <= margin)
            result.points[static_cast<std::size_t>(result.count++)] = {
                on_solid - (Real(0.5) * height) * face, height, point.feature};
    }
    return result;
}

} // namespace

Manifold collide_inside(const Shape &solid, const TriangleSurface &surface, const Transform &pose) {
    if (surface.sides() != Sides::solid || std::holds_alternative<HalfSpace>(solid))
        return {};
    const Vec3 middle = middle_of(bounds(solid));
    const Vec3 local = to_local_point(pose, middle);
    if (!is_finite(local) || !surface.encloses(local))
        return {};
    const Vec3 at = to_world_point(pose, surface.closest_point(local));
    const Vec3 way = at - middle;
    const Real depth = glm::length(way);
    if (!(depth > Real(0))) // on the surface: it touches triangles
        return {};
    const Vec3 out = way / depth;
    const Vec3 deepest = farthest(solid, -out);
    const Real separation = glm::dot(out, deepest - at);
    Manifold manifold;
    manifold.normal = -out;
    manifold.count = 1;
    manifold.points[0] = {deepest - Real(0.5) * separation * out, separation, inside_feature};
    return manifold;
}

bool is_behind(const Aabb &solid, const Triangle &triangle) {
    const Vec3 middle = middle_of(solid);
    const Vec3 front = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    return glm::dot(front, middle - triangle.a) < Real(0);
}

Manifold collide(const Shape &solid, const TriangleSurface &surface, const Transform &pose,
                 std::uint32_t index, Real margin, const Vec3 *load) {
    if (std::holds_alternative<HalfSpace>(solid))
        return {};
    const Triangle local = surface.triangle(index);
    const Triangle placed_one = placed(local, pose);
    const std::optional<TriangleFace> face_or_none = face_of(placed_one);
    if (!face_or_none)
        return {};
    const TriangleFace &triangle = *face_or_none;
    const Aabb box = bounds(solid);
    const bool from_behind = is_behind(box, placed_one);
    if (from_behind && surface.sides() != Sides::both)
        return {};
    Manifold manifold = collide_triangle(solid, placed_one, margin, load);
    if (manifold.count == 0)
        return manifold;
    const Vec3 out = -manifold.normal;
    const Vec3 face = from_behind ? -triangle.normal : triangle.normal;
    const Real lean = glm::dot(out, face);
    if (lean >= in_plane)
        return manifold;
    if (lean > Real(0)) {
        if (may_lean(surface, pose, index, triangle, manifold.points[0].position, out))
            return manifold;
    }
    // The face's contact: the deepest point, if it is over this triangle. If it lies over the far
    // side of a ridge, whose own deepest point may lie over this triangle, neither face would have
    // it: then the point on the ridge. (Over a hollow, or in the plane, the other triangle has it.)
    Vec3 deepest = farthest(solid, -face);
    Real separation = glm::dot(face, deepest - placed_one.a);
    if (separation > margin)
        return {};
    bool is_over = true;
    for (std::size_t edge = 0; edge < 3; ++edge)
        if (const Real beyond = triangle.beyond(deepest, edge);
            beyond > Real(1e-4) * triangle.size) {
            const int number = static_cast<int>(edge);
            if (surface.is_outer_edge(index, number)) {
                is_over = false;
            } else {
                const Vec3 other = to_world_vector(pose, surface.normal_beyond(index, number));
                const Real bend = glm::dot(other, triangle.normal);
                if (!is_in_hollow(bend, -separation, beyond))
                    return bend >= in_plane ? flattened(manifold, face, placed_one.a, margin)
                                            : Manifold{};
            }
        }
    if (!is_over) {
        const Vec3 on_ridge = closest_point(placed_one, deepest);
        const Real depth = glm::length(box.max - box.min) + margin;
        const auto inside = ray_interval(solid, {on_ridge - depth * face, face});
        if (!inside || inside->t_enter >= depth) // still above the ridge: comes down beyond it
            return {};
        separation = inside->t_enter - depth;
        deepest = on_ridge + separation * face;
    }
    Manifold result = flattened(manifold, face, placed_one.a, margin);
    const std::span points = std::span(result.points).first(static_cast<std::size_t>(result.count));
    if (is_over && std::ranges::any_of(points, [&](const ManifoldPoint &point) {
            return point.separation <= separation + Real(1e-5) * triangle.size;
        }))
        return result;
    result.count = 1;
    result.points[0] = {deepest - Real(0.5) * separation * face, separation, deepest_point_feature};
    return result;
}

} // namespace plumb::inline PLUMB_PRECISION
