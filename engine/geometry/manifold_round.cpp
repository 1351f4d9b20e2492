// Contacts of spheres, capsules and half-spaces.
#include "engine/geometry/closest.h"
#include "engine/geometry/manifold_pairs.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Capsules whose axes form an angle with a sine below this count as parallel and get a contact at
// each end of their overlap. At this sine, axes overlapping by one metre are 2 cm apart at the far
// end.
constexpr Real side_by_side_sine = Real(0.02);

// Adds the contact of two balls, given the normal between their centres and their separation.
void add_ball_contact(Manifold &manifold, const Vec3 &center_a, Real radius_a, const Vec3 &center_b,
                      Real radius_b, const Vec3 &normal, Real separation) {
    const Vec3 on_a = center_a + radius_a * normal;
    const Vec3 on_b = center_b - radius_b * normal;
    add_point(manifold, Real(0.5) * (on_a + on_b), separation, 0);
}

// The contact of two balls, given the normal and distance between their centres.
Manifold ball_contact(const Vec3 &center_a, Real radius_a, const Vec3 &center_b, Real radius_b,
                      const Vec3 &normal, Real distance, Real margin) {
    Manifold manifold;
    const Real separation = distance - (radius_a + radius_b);
    if (separation > margin)
        return manifold;
    manifold.normal = normal;
    add_ball_contact(manifold, center_a, radius_a, center_b, radius_b, normal, separation);
    return manifold;
}

// `v` without its component along `axis`. Done twice, because when v is nearly parallel to the axis
// the first pass leaves rounding along it.
Vec3 without(Vec3 v, const Vec3 &axis) {
    const Real squared = glm::dot(axis, axis);
    for (int pass = 0; pass < 2; ++pass)
        v -= axis * (glm::dot(v, axis) / squared);
    return v;
}

// Whether v is longer than the rounding of points computed from lengths of this size.
bool is_significant(const Vec3 &v, Real squared_size) {
    constexpr Real noise = Real(16) * std::numeric_limits<Real>::epsilon();
    const Real squared = glm::dot(v, v);
    return squared >= std::numeric_limits<Real>::min() && squared > noise * noise * squared_size;
}

Real squared_length(const Capsule &capsule) {
    const Vec3 along = capsule.b - capsule.a;
    return glm::dot(along, along);
}

// Moves the contact of nearly parallel capsules, the first no shorter than the second, to both ends
// of the overlap of their axes, unless the axes cross there.
[[gnu::noinline]] void spread_to_ends(Manifold &manifold, const Capsule &a, const Capsule &b,
                                      Real margin) {
    const Vec3 along_a = a.b - a.a;
    const Vec3 along_b = b.b - b.a;
    const Vec3 offset = b.a - a.a;
    const Real squared_a = glm::dot(along_a, along_a);
    // The overlap of the axes, in the parameter of A's axis.
    const Real at_start = glm::dot(offset, along_a) / squared_a;
    const Real at_end = glm::dot(offset + along_b, along_a) / squared_a;
    const bool same_way = at_start <= at_end;
    const Real low_b = same_way ? at_start : at_end;
    const Real high_b = same_way ? at_end : at_start;
    const Real low = std::max(Real(0), low_b);
    const Real high = std::min(Real(1), high_b);
    if (!(high > low))
        return;

    Manifold two;
    two.normal = manifold.normal;
    // Both contacts share the normal. If a pair of axis points is offset sideways from it by e, the
    // contact point is e / 2 off each axis, and so off a surface of radius r by (e / 2)^2 / (2 r).
    const Real thinner = std::min(a.radius, b.radius);
    const Real sideways_limit =
        std::max(Real(2) * feature_tolerance, std::sqrt(Real(8) * thinner * feature_tolerance));
    bool is_straight = true;
    const auto add_end = [&](Real s, bool from_b, Real t_of_b, std::uint32_t feature) {
        const Real t = from_b ? t_of_b : closest_parameter(offset, along_b, s * along_a);
        const Vec3 difference = (offset + t * along_b) - s * along_a;
        const Real distance = glm::dot(difference, two.normal);
        if (glm::length(difference - distance * two.normal) > sideways_limit)
            is_straight = false;
        // Nothing is deeper than where the axes are closest.
        const Real separation =
            std::max(distance - (a.radius + b.radius), manifold.points[0].separation);
        if (separation > margin)
            return;
        const Vec3 on_a = a.a + s * along_a + a.radius * two.normal;
        const Vec3 on_b = b.a + t * along_b - b.radius * two.normal;
        add_point(two, Real(0.5) * (on_a + on_b), separation, feature);
    };
    // Features: 1..4 name the end that bounds the overlap: 1, 2 for A's ends and 3, 4 for B's.
    if (low_b > Real(0))
        add_end(low, true, same_way ? Real(0) : Real(1), same_way ? 3 : 4);
    else
        add_end(low, false, Real(0), 1);
    if (high_b < Real(1))
        add_end(high, true, same_way ? Real(1) : Real(0), same_way ? 4 : 3);
    else
        add_end(high, false, Real(0), 2);

    // If the axes cross between the ends, the ends are not the deepest points.
    Real deepest = std::numeric_limits<Real>::infinity();
    for (int i = 0; i < two.count; ++i)
        deepest = std::min(deepest, two.points[static_cast<std::size_t>(i)].separation);
    if (is_straight && deepest <= manifold.points[0].separation + feature_tolerance)
        manifold = two;
}

} // namespace

Vec3 any_perpendicular(const Vec3 &axis) {
    // The least parallel world axis, made perpendicular. Y is tried first, so that vertical pushes
    // win if possible.
    const Vec3 size = glm::abs(axis);
    const Real squared = glm::dot(axis, axis);
    if (!(squared >= std::numeric_limits<Real>::min()))
        return {Real(0), Real(1), Real(0)};
    Vec3 pick{Real(0)};
    pick[size.y <= size.x || size.y <= size.z ? 1 : (size.x <= size.z ? 0 : 2)] = Real(1);
    return glm::normalize(pick - axis * (glm::dot(pick, axis) / squared));
}

namespace unchecked {

Manifold collide(const Sphere &a, const Sphere &b, Real margin) {
    const Vec3 difference = b.center - a.center;
    const Real distance = glm::length(difference);
    const Vec3 normal = is_significant(difference, Real(0)) ? difference / distance
                                                            : Vec3{Real(0), Real(1), Real(0)};
    return ball_contact(a.center, a.radius, b.center, b.radius, normal, distance, margin);
}

Manifold collide(const Sphere &a, const Capsule &b, Real margin) {
    const Vec3 along = b.b - b.a;
    const Vec3 offset = b.a - a.center;
    const Real t = closest_parameter(offset, along, Vec3{Real(0)});
    const Vec3 difference = offset + t * along;
    const Real distance = glm::length(difference);
    // Beside the segment the normal is perpendicular to it, however close the axis is.
    const bool is_beside = t > Real(0) && t < Real(1);
    const Vec3 away = is_beside ? without(difference, along) : difference;
    const Vec3 normal = is_significant(away, is_beside ? glm::dot(along, along) : Real(0))
                            ? glm::normalize(away)
                            : any_perpendicular(along);
    return ball_contact(a.center, a.radius, b.a + t * along, b.radius, normal, distance, margin);
}

Manifold collide(const Sphere &a, const HalfSpace &b, Real margin) {
    Manifold manifold;
    const Real height = glm::dot(b.normal, a.center) - b.offset;
    const Real separation = height - a.radius;
    if (separation > margin)
        return manifold;
    manifold.normal = -b.normal;
    add_point(manifold, a.center - b.normal * (Real(0.5) * (a.radius + height)), separation, 0);
    return manifold;
}

Manifold collide(const Capsule &a, const HalfSpace &b, Real margin) {
    Manifold manifold;
    manifold.normal = -b.normal;
    std::uint32_t feature = 0;
    for (const Vec3 &end : {a.a, a.b}) {
        const Real height = glm::dot(b.normal, end) - b.offset;
        const Real separation = height - a.radius;
        if (separation <= margin)
            add_point(manifold, end - b.normal * (Real(0.5) * (a.radius + height)), separation,
                      feature);
        ++feature;
        if (a.a == a.b)
            break;
    }
    if (manifold.count == 0)
        return {};
    return manifold;
}

[[gnu::flatten]] Manifold collide(const Capsule &one, const Capsule &two, Real margin) {
    // The longer capsule, or if equal the thicker one, is the reference: a choice that does not
    // change while the bodies move or with the argument order.
    const Real squared_one = squared_length(one), squared_two = squared_length(two);
    const bool is_swapped =
        squared_two > squared_one || (squared_two == squared_one && two.radius > one.radius);
    const Capsule &a = is_swapped ? two : one;
    const Capsule &b = is_swapped ? one : two;
    const Real side = is_swapped ? Real(-1) : Real(1);
    const Vec3 along_a = a.b - a.a;
    const Vec3 along_b = b.b - b.a;
    const Real squared_a = is_swapped ? squared_two : squared_one;
    const Real squared_b = is_swapped ? squared_one : squared_two;

    const Vec3 offset = b.a - a.a;
    const Vec3 cross = glm::cross(along_a, along_b);
    const Real squared_cross = glm::dot(cross, cross);
    const SegmentPair closest = closest_between_segments(Vec3{Real(0)}, along_a, offset, along_b);
    const Real separation = std::sqrt(closest.squared_distance) - (a.radius + b.radius);
    Manifold manifold;
    manifold.normal = side * manifold.normal;
    if (separation > margin)
        return manifold;

    // The normal is perpendicular to each axis that the contact is beside, however close the axes
    // are. Where the axes cross, the shortest way out is along their common perpendicular.
    const bool is_parallel =
        squared_cross <= side_by_side_sine * side_by_side_sine * squared_a * squared_b;
    const bool is_beside_a = closest.s > Real(0) && closest.s < Real(1);
    const bool is_beside_b = closest.t > Real(0) && closest.t < Real(1);
    Vec3 away = closest.difference;
    // The cross product is off by eps / sine, the difference by eps * length / distance.
    const Real squared_sizes = squared_a * squared_b;
    if (is_beside_a && is_beside_b &&
        squared_cross > std::numeric_limits<Real>::epsilon() * squared_sizes) {
        away = glm::dot(closest.difference, cross) < Real(0) ? -cross : cross;
        away /= std::sqrt(squared_cross);
    } else if (is_beside_a) {
        away = without(away, along_a);
    } else if (is_beside_b) {
        away = without(away, along_b);
    }
    const Real squared_size = is_beside_a || is_beside_b ? squared_a : Real(0);
    if (!is_significant(away, squared_size))
        away = is_significant(cross, squared_sizes) ? cross / std::sqrt(squared_cross)
                                                    : any_perpendicular(along_a);
    manifold.normal = glm::normalize(away);
    add_ball_contact(manifold, a.a + closest.s * along_a, a.radius, b.a + closest.t * along_b,
                     b.radius, manifold.normal, separation);
    if (is_parallel && squared_b > Real(0))
        spread_to_ends(manifold, a, b, margin);
    manifold.normal = side * manifold.normal;
    return manifold;
}

} // namespace unchecked

} // namespace plumb::inline PLUMB_PRECISION
