// A half-space against any convex shape (Convex, support.h), in closed form.
//
// Off by at most 8 epsilon times the largest coordinate, size or offset. For a point, segment or
// triangle the overlap test is exact for the inputs as given. Touching shapes overlap. An invalid
// shape or an empty Aabb fails a check, except that in `overlaps` an empty Aabb overlaps nothing.
// For contacts see manifold.h, for a surface without depth plane.h.
#pragma once

#include "engine/geometry/gjk.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/shape_cast.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

template <Convex A> bool overlaps(const A &a, const HalfSpace &b) {
    check_valid(b);
    if constexpr (std::same_as<A, Aabb>) {
        check_valid(a);
        if (a.min.x > a.max.x || a.min.y > a.max.y || a.min.z > a.max.z)
            return false;
    }
    return classify(Plane{b.normal, b.offset}, a).side != PlaneSide::in_front;
}
template <Convex B> bool overlaps(const HalfSpace &a, const B &b) {
    return overlaps(b, a);
}
// True unless the planes are exactly parallel, face each other and are apart.
bool overlaps(const HalfSpace &a, const HalfSpace &b);

// As for two convex shapes (gjk.h). If they overlap, the common point is A's deepest.
template <Convex A> ClosestPoints distance(const A &a, const HalfSpace &b) {
    check_valid(b);
    const PlaneTest test = classify(Plane{b.normal, b.offset}, a);
    const Vec3 place = place_of(a);
    const auto core = core_of(a, place);
    ClosestPoints found;
    found.on_a = found.on_b = place + (core.support(-b.normal) - core.radius * b.normal);
    if (test.distance > Real(0)) {
        found.distance = test.distance;
        found.on_b -= test.distance * b.normal;
        found.normal = -b.normal;
    }
    return found;
}
template <Convex B> ClosestPoints distance(const HalfSpace &a, const B &b) {
    ClosestPoints found = distance(b, a);
    std::swap(found.on_a, found.on_b);
    found.normal = -found.normal;
    return found;
}

// As for two convex shapes (shape_cast.h), except that touching is decided by the rounded
// `distance`.
template <Convex A>
std::optional<CastHit> cast(const A &a, const Vec3 &translation, const HalfSpace &b) {
    check_translation(translation);
    const ClosestPoints start = distance(a, b);
    const Real speed = -glm::dot(b.normal, translation);
    CastHit hit;
    hit.normal = -b.normal;
    hit.starts_overlapping = !(start.distance > Real(0));
    if (!hit.starts_overlapping) {
        if (!(speed >= start.distance))
            return std::nullopt;
        hit.t = start.distance / speed;
    }
    hit.point = start.on_a + hit.t * translation;
    return hit;
}
template <Convex B>
std::optional<CastHit> cast(const HalfSpace &a, const Vec3 &translation, const B &b) {
    std::optional<CastHit> hit = cast(b, -translation, a);
    if (hit) {
        hit->point += hit->t * translation; // B stays where it is
        hit->normal = -hit->normal;
    }
    return hit;
}

} // namespace plumb::inline PLUMB_PRECISION
