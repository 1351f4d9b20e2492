#include "engine/dynamics/contacts/inner_edges.h"

#include "engine/geometry/gjk.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Directions this close count as equal (rad): a thousandth lets nothing of note through.
constexpr Real small_angle = Real(1e-3);

bool is_along(const Vec3 &unit, const Vec3 &direction) {
    return glm::dot(unit, direction) > Real(1) - small_angle * small_angle;
}

template <typename Visit> auto visit_solid(const FloorPiece &piece, Visit &&visit) {
    if (const auto *triangle = std::get_if<Triangle>(&piece))
        return visit(*triangle);
    return std::visit(visit, std::get<Shape>(piece));
}

// Whether the piece has points in front of the plane through `point`, by more than a small angle as
// seen from there.
bool is_in_front(const FloorPiece &piece, const Vec3 &point, const Vec3 &normal) {
    return visit_solid(piece, [&]<typename Solid>(const Solid &solid) {
        if constexpr (std::same_as<Solid, HalfSpace>) {
            return !is_along(solid.normal, normal);
        } else {
            const auto core = core_of(solid, point);
            const Vec3 farthest = core.support(normal) + core.radius * normal;
            return glm::dot(farthest, normal) > small_angle * glm::length(farthest);
        }
    });
}

Vec3 normal_of(const Triangle &triangle) {
    return glm::normalize(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
}

// Calls visit(plane) for each flat face.
template <typename Visit> void each_face(const FloorPiece &piece, Visit &&visit) {
    visit_solid(piece, [&]<typename Solid>(const Solid &solid) {
        if constexpr (std::same_as<Solid, HalfSpace>) {
            visit(solid);
        } else if constexpr (std::same_as<Solid, Triangle>) {
            const Vec3 normal = normal_of(solid);
            visit(HalfSpace{normal, glm::dot(normal, solid.a)});
        } else if constexpr (std::same_as<Solid, Box>) {
            const Mat3 axes = glm::mat3_cast(solid.rotation);
            for (int i = 0; i < 3; ++i)
                for (const Real side : {Real(-1), Real(1)}) {
                    const Vec3 normal = side * axes[i];
                    visit(
                        HalfSpace{normal, glm::dot(normal, solid.center) + solid.half_extents[i]});
                }
        } else if constexpr (std::same_as<Solid, Cylinder>) {
            const Vec3 axis = glm::normalize(solid.b - solid.a);
            visit(HalfSpace{axis, glm::dot(axis, solid.b)});
            visit(HalfSpace{-axis, glm::dot(-axis, solid.a)});
        } else if constexpr (std::same_as<Solid, ConvexHull>) {
            for (const Plane &plane : solid.mesh->planes) {
                const Vec3 normal = solid.rotation * plane.normal;
                visit(HalfSpace{normal, plane.offset + glm::dot(normal, solid.position)});
            }
        }
    });
}

bool has_face(const FloorPiece &piece, const Vec3 &normal) {
    bool found = false;
    each_face(piece,
              [&](const HalfSpace &face) { found = found || is_along(face.normal, normal); });
    return found;
}

// Whether a neighbour lies against the face with that normal at `point`.
bool is_covered(const FloorPiece &neighbor, const Vec3 &point, const Vec3 &normal, Real flush) {
    if (const auto *triangle = std::get_if<Triangle>(&neighbor))
        return is_along(-normal_of(*triangle), normal) && distance_to(neighbor, point) <= flush;
    return distance_to(neighbor, point + Real(2) * flush * normal) <= flush;
}

// Whether part of the piece's face around the point is free of neighbours.
bool is_free(const FloorPiece &piece, std::span<const FloorPiece> neighbors, const Vec3 &point,
             const Vec3 &normal, Real flush) {
    const TangentBasis tangents = tangent_basis(normal);
    const Real aside = Real(4) * flush;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) {
            const Vec3 beside = point + aside * (static_cast<Real>(i) * tangents.t1 +
                                                 static_cast<Real>(j) * tangents.t2);
            if (distance_to(piece, beside) > Real(0.5) * flush)
                continue; // beyond the face
            if (std::ranges::none_of(neighbors, [&](const FloorPiece &neighbor) {
                    return is_covered(neighbor, beside, normal, flush);
                }))
                return true;
        }
    return false;
}

bool is_inner(const FloorPiece &piece, std::span<const FloorPiece> neighbors, const Vec3 &point,
              const Vec3 &normal, Real flush) {
    const bool goes_on = std::ranges::any_of(neighbors, [&](const FloorPiece &neighbor) {
        return distance_to(neighbor, point) <= flush && is_in_front(neighbor, point, normal);
    });
    return goes_on && !(has_face(piece, normal) && is_free(piece, neighbors, point, normal, flush));
}

// Where a contact point is on the surface of b.
Vec3 on_b(const ManifoldPoint &point, const Vec3 &normal) {
    return point.position + Real(0.5) * point.separation * normal;
}

// How far the lowest point of a solid is above a plane.
Real height_above(const HalfSpace &plane, const Shape &solid) {
    return std::visit(
        [&]<typename Solid>(const Solid &shape) -> Real {
            if constexpr (std::same_as<Solid, HalfSpace>) {
                return std::numeric_limits<Real>::lowest();
            } else {
                const Vec3 origin = place_of(shape);
                const auto core = core_of(shape, origin);
                return glm::dot(plane.normal, origin + core.support(-plane.normal)) - core.radius -
                       plane.offset;
            }
        },
        solid);
}

} // namespace

Real distance_to(const FloorPiece &piece, const Vec3 &point) {
    return visit_solid(piece, [&]<typename Solid>(const Solid &solid) -> Real {
        if constexpr (std::same_as<Solid, HalfSpace>)
            return std::max(glm::dot(solid.normal, point) - solid.offset, Real(0));
        else
            return distance(solid, point).distance;
    });
}

Manifold without_inner_edges(const Manifold &manifold, const Shape &solid, const FloorPiece &piece,
                             std::span<const FloorPiece> neighbors, Real margin, Real flush) {
    const Vec3 out = -manifold.normal;
    Manifold left;
    left.normal = manifold.normal;
    for (int k = 0; k < manifold.count; ++k) {
        const ManifoldPoint &point = manifold.points[static_cast<std::size_t>(k)];
        if (!is_inner(piece, neighbors, on_b(point, manifold.normal), out, flush))
            left.points[static_cast<std::size_t>(left.count++)] = point;
    }
    if (left.count > 0)
        return left;

    const Vec3 near = on_b(manifold.points[0], manifold.normal);
    std::optional<HalfSpace> free_face;
    Real highest = std::numeric_limits<Real>::lowest();
    each_face(piece, [&](const HalfSpace &face) {
        const Vec3 foot = near - (glm::dot(face.normal, near) - face.offset) * face.normal;
        const Real height = height_above(face, solid);
        const bool is_near =
            height >= -near_reach * flush && glm::distance(foot, near) <= near_reach * flush;
        if (height > highest && is_near && !is_along(face.normal, out) &&
            distance_to(piece, foot) <= flush &&
            is_free(piece, neighbors, foot, face.normal, flush)) {
            highest = height;
            free_face = face;
        }
    });
    if (!free_face || highest > margin)
        return {};
    const Manifold over = plumb::collide(solid, Shape{*free_face}, margin);
    left.normal = over.normal;
    for (int k = 0; k < over.count; ++k) {
        const ManifoldPoint &point = over.points[static_cast<std::size_t>(k)];
        if (distance_to(piece, on_b(point, over.normal)) <= flush)
            left.points[static_cast<std::size_t>(left.count++)] = point;
    }
    return left;
}

} // namespace plumb::inline PLUMB_PRECISION
