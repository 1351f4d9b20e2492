#include "engine/geometry/edge_gap.h"

#include "engine/geometry/closest.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/vectors.h"

#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

struct CoreEdge {
    Vec3 start{Real(0)};
    Vec3 along{Real(0)}; // to the other end
};

// Of the edges at the corner farthest along a direction, the one most across it.
CoreEdge edge_along(const BoxCore &box, const Vec3 &direction) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(glm::dot(box.axes[i], direction)) <
            std::abs(glm::dot(box.axes[axis], direction)))
            axis = i;
    const Vec3 corner = box.support(direction);
    const Vec3 &half = box.half_edges[axis];
    const Real side = std::copysign(Real(2), glm::dot(corner - box.center, half));
    return {corner, -side * half};
}

CoreEdge edge_along(const HullCore &hull, const Vec3 &direction) {
    const HullMesh &mesh = *hull.mesh;
    const Vec3 corner = hull.support(direction);
    const Vec3 local = direction * hull.rotation;
    const Vec3 &from = mesh.vertices[hull.last];
    Vec3 most_across{Real(0)};
    Real drop = Real(0);    // of the direction's component along it, squared, ...
    Real squared = Real(0); // ... over this
    for (std::uint32_t i = mesh.first_neighbor[hull.last]; i < mesh.first_neighbor[hull.last + 1];
         ++i) {
        const Vec3 along = mesh.vertices[mesh.neighbors[i]] - from;
        const Real down = glm::dot(along, local);
        const Real length = glm::dot(along, along);
        if (squared == Real(0) || down * down * squared < drop * length) {
            most_across = along;
            drop = down * down;
            squared = length;
        }
    }
    return {corner, hull.rotation * most_across};
}

// The closest points of two edges, and the unit normal there, from A to B.
struct Crossing {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 normal{Real(0)};
    bool is_inside = false; // of both edges, which are not nearly parallel
};

std::optional<Crossing> crossing(const CoreEdge &a, const CoreEdge &b, const Vec3 &guess,
                                 Real rounding) {
    constexpr Real parallel_sine = Real(0.01);
    const SegmentPair closest = closest_between_segments(a.start, a.along, b.start, b.along);
    const auto is_within = [](Real share) { return share > Real(0) && share < Real(1); };
    const Vec3 cross = glm::cross(a.along, b.along);
    const Real squared = glm::dot(cross, cross);
    Crossing found{a.start + closest.s * a.along, b.start + closest.t * b.along};
    found.is_inside = is_within(closest.s) && is_within(closest.t) &&
                      squared > parallel_sine * parallel_sine * glm::dot(a.along, a.along) *
                                    glm::dot(b.along, b.along);
    if (found.is_inside) {
        const Real length = std::sqrt(squared);
        found.normal = cross / (glm::dot(cross, guess) < Real(0) ? -length : length);
        return found;
    }
    // Of shorter ways the direction is mostly rounding.
    constexpr Real roundings = Real(1e4);
    const Real distance = std::sqrt(closest.squared_distance);
    if (!(distance > roundings * rounding))
        return std::nullopt;
    found.normal = closest.difference / distance;
    return found;
}

// Whether the sides of the pyramid on the parallelogram that the edges span in the Minkowski
// difference are at least `depth` from the origin.
bool is_deep_inside(const CoreEdge &a, const CoreEdge &b, const Vec3 &apex, Real depth) {
    const Vec3 first = b.start - a.start;
    const std::array<Vec3, 4> corners = {first, first + b.along, first + b.along - a.along,
                                         first - a.along};
    const Vec3 middle = Real(0.5) * (corners[0] + corners[2]);
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 &corner = corners[k];
        const Vec3 across = glm::cross(corners[(k + 1) % 4] - corner, apex - corner);
        const Real height = -glm::dot(corner, across);
        const Real inner = glm::dot(middle - corner, across);
        if (!(height * inner > Real(0)) ||
            !(height * height >= depth * depth * glm::dot(across, across)))
            return false;
    }
    return true;
}

} // namespace

template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> edge_gap(const A &a, const B &b, const Vec3 &guess, Real far) {
    const CoreEdge edge_a = edge_along(a, guess);
    const CoreEdge edge_b = edge_along(b, -guess);
    const Vec3 size = magnitudes(edge_a.start) + magnitudes(edge_a.along) +
                      magnitudes(edge_b.start) + magnitudes(edge_b.along);
    const Real rounding = rounding_of(size);
    const std::optional<Crossing> found = crossing(edge_a, edge_b, guess, rounding);
    if (!found)
        return std::nullopt;
    const Vec3 &normal = found->normal;
    const Vec3 farthest_a = a.support(normal);
    const Vec3 farthest_b = b.support(-normal);
    const Real height = glm::dot(found->on_b - found->on_a, normal);
    Proximity result{
        .separation = height, .normal = normal, .on_a = found->on_a, .on_b = found->on_b};
    const Real between_planes = glm::dot(farthest_b - farthest_a, normal);
    if (between_planes > far) {
        result.separation = between_planes;
        result.is_beyond = true;
        return result;
    }
    if (between_planes < height - rounding)
        return std::nullopt;
    if (height > Real(0))
        return result;
    const Vec3 apex = b.middle() - a.middle();
    if (!found->is_inside || !is_deep_inside(edge_a, edge_b, apex, -height))
        return std::nullopt;
    return result;
}

template std::optional<Proximity> edge_gap(const BoxCore &, const BoxCore &, const Vec3 &, Real);
template std::optional<Proximity> edge_gap(const HullCore &, const HullCore &, const Vec3 &, Real);
template std::optional<Proximity> edge_gap(const BoxCore &, const HullCore &, const Vec3 &, Real);
template std::optional<Proximity> edge_gap(const HullCore &, const BoxCore &, const Vec3 &, Real);

} // namespace plumb::inline PLUMB_PRECISION
