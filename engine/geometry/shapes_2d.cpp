#include "engine/geometry/shapes_2d.h"

#include "engine/core/check.h"
#include "engine/math/constants.h"
#include "engine/math/printed.h"

#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

bool is_finite(const Vec2 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

// a + b, rounded up. The rounding error is computed exactly (Knuth 1969, TAOCP 2, 4.2.2, theorem
// B).
Real sum_above(Real a, Real b) {
    const Real sum = a + b;
    const Real b_kept = sum - a;
    const Real lost = (a - (sum - b_kept)) + (b - b_kept);
    return lost > Real(0) ? std::nextafter(sum, infinity) : sum;
}

Real difference_below(Real a, Real b) {
    return -sum_above(-a, b);
}

// [center - extent, center + extent], rounded outwards.
Rectangle around(const Vec2 &center, const Vec2 &extent) {
    return {
        {difference_below(center.x, extent.x), difference_below(center.y, extent.y)},
        {sum_above(center.x, extent.x), sum_above(center.y, extent.y)},
    };
}

} // namespace

OrientedRectangle oriented_rectangle(const Vec2 &center, Real angle, const Vec2 &half_extents) {
    PLUMB_CHECK(std::isfinite(angle), "rectangle angle must be finite, got " << angle);
    const OrientedRectangle rectangle{center, {std::cos(angle), std::sin(angle)}, half_extents};
    check_valid(rectangle);
    return rectangle;
}

Compound2::Compound2(std::vector<Part2> parts) : parts_(std::move(parts)) {
    PLUMB_CHECK(!parts_.empty(), "a compound needs at least one part, got " << parts_.size());
    for (const Part2 &part : parts_) {
        const Rectangle box = std::visit(
            [](const auto &shape) {
                check_valid(shape);
                return plumb::PLUMB_PRECISION::bounds(shape);
            },
            part);
        PLUMB_CHECK(!is_empty(box), "a part of a compound must not be empty, got min "
                                        << Printed{box.min} << " and max " << Printed{box.max});
        bounds_.min = glm::min(bounds_.min, box.min);
        bounds_.max = glm::max(bounds_.max, box.max);
    }
}

Rectangle bounds(const Segment2 &segment) {
    check_valid(segment);
    return {glm::min(segment.a, segment.b), glm::max(segment.a, segment.b)};
}

Rectangle bounds(const Circle &circle) {
    check_valid(circle);
    return around(circle.center, Vec2{circle.radius});
}

Rectangle bounds(const OrientedRectangle &rectangle) {
    check_valid(rectangle);
    // The sum of the half edges' projections (Ericson 2005, "Real-Time Collision Detection", 4.2.6,
    // in 2D).
    const Vec2 axis = glm::abs(rectangle.axis);
    const Vec2 &half = rectangle.half_extents;
    Vec2 extent{axis.x * half.x + axis.y * half.y, axis.y * half.x + axis.x * half.y};
    // Three roundings, and one of the axis's length; none if turned by a multiple of 90 degrees.
    if (axis.x != Real(0) && axis.y != Real(0))
        extent *= Real(1) + Real(4) * epsilon;
    return around(rectangle.center, extent);
}

Real length(const Segment2 &segment) {
    check_valid(segment);
    return glm::length(segment.b - segment.a);
}

void check_valid(const Vec2 &point) {
    PLUMB_CHECK(is_finite(point), "point must be finite, got " << Printed{point});
}

void check_valid(const Segment2 &segment) {
    PLUMB_CHECK(is_finite(segment.a), "segment end a must be finite, got " << Printed{segment.a});
    PLUMB_CHECK(is_finite(segment.b), "segment end b must be finite, got " << Printed{segment.b});
}

void check_valid(const Ray2 &ray) {
    PLUMB_CHECK(is_finite(ray.origin), "ray origin must be finite, got " << Printed{ray.origin});
    PLUMB_CHECK(is_finite(ray.direction) && ray.direction != Vec2{Real(0)},
                "ray direction must be finite and not zero, got " << Printed{ray.direction});
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

void check_valid(const Circle &circle) {
    PLUMB_CHECK(is_finite(circle.center),
                "circle centre must be finite, got " << Printed{circle.center});
    PLUMB_CHECK(circle.radius >= Real(0) && circle.radius < infinity,
                "circle radius must be finite and not negative, got " << circle.radius);
}

void check_valid(const Rectangle &rectangle) {
    PLUMB_CHECK(is_finite(rectangle.min),
                "rectangle min must be finite, got " << Printed{rectangle.min});
    PLUMB_CHECK(is_finite(rectangle.max),
                "rectangle max must be finite, got " << Printed{rectangle.max});
}

void check_valid(const OrientedRectangle &rectangle) {
    PLUMB_CHECK(is_finite(rectangle.center),
                "rectangle centre must be finite, got " << Printed{rectangle.center});
    PLUMB_CHECK(is_unit(glm::dot(rectangle.axis, rectangle.axis)),
                "rectangle axis must have unit length, got " << Printed{rectangle.axis});
    PLUMB_CHECK(is_finite(rectangle.half_extents) && rectangle.half_extents.x >= Real(0) &&
                    rectangle.half_extents.y >= Real(0),
                "rectangle half extents must be finite and not negative, got "
                    << Printed{rectangle.half_extents});
}

} // namespace plumb::inline PLUMB_PRECISION
