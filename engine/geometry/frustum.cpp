#include "engine/geometry/frustum.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/closest_point.h"
#include "engine/math/printed.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::array<std::array<std::uint8_t, 2>, 12> box_edges{{{0, 4},
                                                                 {1, 5},
                                                                 {2, 6},
                                                                 {3, 7},
                                                                 {0, 1},
                                                                 {0, 2},
                                                                 {2, 3},
                                                                 {1, 3},
                                                                 {4, 5},
                                                                 {4, 6},
                                                                 {6, 7},
                                                                 {5, 7}}};

Vec3 narrow(const glm::dvec3 &v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

// Tests a shape that reaches from `lowest` to `highest` above a face.
void meet(FrustumSide &side, Real lowest, Real highest) {
    if (lowest > Real(0))
        side = FrustumSide::outside;
    else if (highest > Real(0) && side == FrustumSide::inside)
        side = FrustumSide::across;
}

Real height_over(const Plane &plane, const Vec3 &point) {
    return glm::dot(plane.normal, point) - plane.offset;
}

// An oriented box with its axes as a matrix.
struct OpenBox {
    Vec3 center{Real(0)};
    Mat3 axes{Real(1)};
    Vec3 half{Real(0)};
};

FrustumSide classify_box(const Frustum &frustum, const OpenBox &box) {
    FrustumSide side = FrustumSide::inside;
    for (const Plane &plane : frustum.planes) {
        const Real height = height_over(plane, box.center);
        const Real reach = glm::dot(glm::abs(plane.normal * box.axes), box.half);
        meet(side, height - reach, height + reach);
        if (side == FrustumSide::outside)
            break;
    }
    return side;
}

// Whether an axis of the box, or the cross product of an edge of each, separates them.
bool is_separated(const Frustum &frustum, const OpenBox &box) {
    // The frustum in the box's frame.
    std::array<Vec3, 8> corners;
    Vec3 low{std::numeric_limits<Real>::infinity()};
    Vec3 high = -low;
    for (std::size_t k = 0; k < 8; ++k) {
        corners[k] = (frustum.corners[k] - box.center) * box.axes;
        low = glm::min(low, corners[k]);
        high = glm::max(high, corners[k]);
    }
    for (int i = 0; i < 3; ++i)
        if (low[i] > box.half[i] || high[i] < -box.half[i])
            return true;

    for (const auto &[first, second] : box_edges) {
        const Vec3 edge = corners[second] - corners[first];
        for (int i = 0; i < 3; ++i) {
            // The axis e_i x edge, of any length: roundings scale with it, and a zero axis
            // separates nothing.
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const Real y = -edge[k], z = edge[j];
            const Real reach = std::abs(y) * box.half[j] + std::abs(z) * box.half[k];
            Real nearest = std::numeric_limits<Real>::infinity();
            Real furthest = -nearest;
            for (const Vec3 &corner : corners) {
                const Real along = y * corner[j] + z * corner[k];
                nearest = std::min(nearest, along);
                furthest = std::max(furthest, along);
            }
            if (nearest > reach || furthest < -reach)
                return true;
        }
    }
    return false;
}

bool is_behind_all(const Frustum &frustum, const Vec3 &point) {
    return std::ranges::all_of(
        frustum.planes, [&](const Plane &plane) { return height_over(plane, point) <= Real(0); });
}

// A common point that needs no search: the box's centre, or its closest point to the frustum's
// centre. Most boxes across the border have one.
bool has_obvious_point(const Frustum &frustum, const OpenBox &box) {
    if (is_behind_all(frustum, box.center))
        return true;
    Vec3 middle{Real(0)};
    for (const Vec3 &corner : frustum.corners)
        middle += Real(0.125) * corner;
    const Vec3 local = glm::clamp((middle - box.center) * box.axes, -box.half, box.half);
    return is_behind_all(frustum, box.center + box.axes * local);
}

bool overlaps_box(const Frustum &frustum, const OpenBox &box) {
    const FrustumSide side = classify_box(frustum, box);
    return side != FrustumSide::outside &&
           (side == FrustumSide::inside || has_obvious_point(frustum, box) ||
            !is_separated(frustum, box));
}

OpenBox opened(const Aabb &box) {
    const Vec3 half = Real(0.5) * (box.max - box.min);
    return {box.min + half, Mat3{Real(1)}, half};
}

OpenBox opened(const Box &box) {
    return {box.center, rotation_matrix(box.rotation), box.half_extents};
}

void check_box(const Aabb &box) {
    check_valid(box);
    PLUMB_CHECK(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z,
                "an empty box is on no side of a frustum, got min "
                    << Printed{box.min} << " and max " << Printed{box.max});
}

void check_finite(const Mat4 &m) {
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            PLUMB_CHECK(std::isfinite(m[j][i]), "matrix must be finite, got "
                                                    << m[j][i] << " in column " << j << ", row "
                                                    << i);
}

} // namespace

Frustum frustum_of(const Mat4 &view_projection) {
    check_finite(view_projection);
    // In double: the far plane of a perspective is a small difference.
    const glm::dmat4 matrix{view_projection};
    const glm::dmat4 rows = glm::transpose(matrix);
    const glm::dmat4 inverse = glm::inverse(matrix);
    Frustum frustum;
    for (int face = 0; face < 6; ++face) {
        // -w <= x is in front of the plane -x - w == 0, and so on.
        const glm::dvec4 plane = -rows[3] + (face % 2 == 0 ? -1.0 : 1.0) * rows[face / 2];
        const double length = glm::length(glm::dvec3{plane});
        PLUMB_CHECK(length > 0.0 && std::isfinite(length),
                    "a frustum has six planes, but plane "
                        << face << " of this matrix is at infinity: its normal has length "
                        << length);
        frustum.planes[static_cast<std::size_t>(face)] = {narrow(glm::dvec3{plane} / length),
                                                          static_cast<Real>(-plane.w / length)};
    }
    for (int k = 0; k < 8; ++k) {
        const glm::dvec4 corner =
            inverse * glm::dvec4{(k & 1) == 0 ? -1.0 : 1.0, (k & 2) == 0 ? -1.0 : 1.0,
                                 (k & 4) == 0 ? -1.0 : 1.0, 1.0};
        PLUMB_CHECK(corner.w > 0.0 && std::isfinite(corner.w),
                    "a frustum has eight corners, but corner "
                        << k << " of this matrix is at infinity or behind: 1 / w is " << corner.w);
        frustum.corners[static_cast<std::size_t>(k)] = narrow(glm::dvec3{corner} / corner.w);
        PLUMB_CHECK(
            std::isfinite(glm::dot(frustum.corners[static_cast<std::size_t>(k)], Vec3{Real(1)})),
            "the corners of a frustum must be finite, got corner "
                << Printed{frustum.corners[static_cast<std::size_t>(k)]});
    }
    return frustum;
}

FrustumSide classify(const Frustum &frustum, const Vec3 &point) {
    check_point(point);
    FrustumSide side = FrustumSide::inside;
    for (const Plane &plane : frustum.planes) {
        const Real height = height_over(plane, point);
        if (height > Real(0))
            return FrustumSide::outside;
        if (height == Real(0))
            side = FrustumSide::across;
    }
    return side;
}

FrustumSide classify(const Frustum &frustum, const Sphere &sphere) {
    check_valid(sphere);
    FrustumSide side = FrustumSide::inside;
    for (const Plane &plane : frustum.planes) {
        const Real height = height_over(plane, sphere.center);
        meet(side, height - sphere.radius, height + sphere.radius);
        if (side == FrustumSide::outside)
            break;
    }
    return side;
}

FrustumSide classify(const Frustum &frustum, const Aabb &box) {
    check_box(box);
    return classify_box(frustum, opened(box));
}

FrustumSide classify(const Frustum &frustum, const Box &box) {
    check_valid(box);
    return classify_box(frustum, opened(box));
}

FrustumSide classify(const Frustum &frustum, const Capsule &capsule) {
    check_valid(capsule);
    FrustumSide side = FrustumSide::inside;
    for (const Plane &plane : frustum.planes) {
        const Real at_a = height_over(plane, capsule.a), at_b = height_over(plane, capsule.b);
        meet(side, std::min(at_a, at_b) - capsule.radius, std::max(at_a, at_b) + capsule.radius);
        if (side == FrustumSide::outside)
            break;
    }
    return side;
}

bool contains(const Frustum &frustum, const Vec3 &point) {
    check_point(point);
    return is_behind_all(frustum, point);
}

Vec3 closest_point(const Frustum &frustum, const Vec3 &point) {
    if (contains(frustum, point))
        return point;
    // The projection on a face's plane, if it is in the face.
    for (const Plane &plane : frustum.planes) {
        const Real height = height_over(plane, point);
        if (height <= Real(0))
            continue;
        const Vec3 foot = point - height * plane.normal;
        bool is_in_face = true;
        for (const Plane &other : frustum.planes)
            is_in_face = is_in_face && (&other == &plane || height_over(other, foot) <= Real(0));
        if (is_in_face)
            return foot;
    }
    // Otherwise the closest point is on an edge or corner. Several candidates may be equally close
    // up to rounding and yet far apart, because the distance is quadratic in the offset along an
    // edge. So compare instead how far the frustum reaches beyond the plane through the candidate
    // perpendicular to the direction to the point, which is linear in that offset.
    Vec3 closest{Real(0)};
    Real least = std::numeric_limits<Real>::infinity();
    for (const auto &[first, second] : box_edges) {
        const Segment edge{frustum.corners[first], frustum.corners[second]};
        const Vec3 on_edge = closest_point(edge, point);
        const Vec3 way = point - on_edge;
        Real beyond = Real(0);
        for (const Vec3 &corner : frustum.corners)
            beyond = std::max(beyond, glm::dot(way, corner - on_edge));
        if (beyond < least) {
            least = beyond;
            closest = on_edge;
        }
    }
    return closest;
}

bool overlaps(const Frustum &frustum, const Sphere &sphere) {
    if (classify(frustum, sphere) == FrustumSide::outside)
        return false;
    const Vec3 d = sphere.center - closest_point(frustum, sphere.center);
    return glm::dot(d, d) <= sphere.radius * sphere.radius;
}

bool overlaps(const Frustum &frustum, const Aabb &box) {
    check_box(box);
    return overlaps_box(frustum, opened(box));
}

bool overlaps(const Frustum &frustum, const Box &box) {
    check_valid(box);
    return overlaps_box(frustum, opened(box));
}

Vec3 unproject(const Vec2 &pixel, Real depth, const Mat4 &inverse_view_projection,
               const Viewport &viewport) {
    PLUMB_CHECK(viewport.size.x > Real(0) && viewport.size.y > Real(0),
                "viewport must not be empty, got size " << Printed{viewport.size});
    PLUMB_CHECK(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(depth),
                "pixel and depth must be finite, got " << Printed{pixel} << " and " << depth);
    const Vec2 part = (pixel - viewport.origin) / viewport.size;
    const Vec4 clip{Real(2) * part.x - Real(1), Real(1) - Real(2) * part.y,
                    Real(2) * depth - Real(1), Real(1)};
    const Vec4 world = inverse_view_projection * clip;
    const Vec3 point = Vec3{world} / world.w;
    PLUMB_CHECK(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z),
                "a pixel must unproject to a finite point, but pixel "
                    << Printed{pixel} << " gives " << Printed{point});
    return point;
}

Ray pick_ray(const Vec2 &pixel, const Mat4 &inverse_view_projection, const Viewport &viewport) {
    const Vec3 near = unproject(pixel, Real(0), inverse_view_projection, viewport);
    const Vec3 far = unproject(pixel, Real(1), inverse_view_projection, viewport);
    return {near, far - near, Real(1)};
}

} // namespace plumb::inline PLUMB_PRECISION
