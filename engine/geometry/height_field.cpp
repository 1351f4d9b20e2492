#include "engine/geometry/height_field.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/closest_point.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "engine/math/constants.h"
#include "engine/math/printed.h"

#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The grid lines across one axis. Positions ascend with the index, even after rounding.
struct Lines {
    Real origin = Real(0);
    Real spacing = Real(1);
    int count = 0;

    Real place(int line) const { return origin + Real(line) * spacing; }

    // The index of the cell that contains x: the last line at or before x, clamped to the first and
    // the last but one.
    int cell_of(Real x) const {
        const Real guess = glm::clamp((x - origin) / spacing, Real(0), Real(count - 2));
        int cell = static_cast<int>(guess);
        while (cell > 0 && place(cell) > x)
            --cell;
        while (cell < count - 2 && place(cell + 1) <= x)
            ++cell;
        return cell;
    }
    // The cells that touch [low, high], half-open.
    std::array<int, 2> cells_touching(Real low, Real high) const {
        if (!(low <= high && high >= place(0) && low <= place(count - 1)))
            return {0, 0};
        int first = cell_of(low);
        if (first > 0 && place(first) == low)
            --first;
        return {first, cell_of(high) + 1};
    }
};

Lines lines_across(const HeightField &field, int axis) {
    return {field.origin[axis], field.spacing, axis == 0 ? field.columns : field.rows};
}

void check_counts(const HeightField &field) {
    PLUMB_CHECK(field.rows >= 2 && field.columns >= 2,
                "a height field needs two rows and columns, got " << field.rows << " and "
                                                                  << field.columns);
    PLUMB_CHECK(field.heights.size() == std::size_t(field.rows) * std::size_t(field.columns),
                "a height field of " << field.rows << " rows and " << field.columns
                                     << " columns needs rows x columns heights, got "
                                     << field.heights.size());
    PLUMB_CHECK(field.spacing > Real(0) && std::isfinite(field.spacing) && is_finite(field.origin),
                "a height field's spacing must be positive and its origin finite, got "
                    << field.spacing << " and " << Printed{field.origin});
}

// Calls visit(row, column) for every cell the ray may cross up to ray.max_t (which `visit` may
// lower), roughly in order along the ray, until it returns false. A zero direction is a point.
template <typename Visit> void walk(const HeightField &field, const Ray &ray, Visit &&visit) {
    // Step through lines of cells along the major axis, so that the ray crosses few cells per line.
    const int major = std::abs(ray.direction.x) >= std::abs(ray.direction.z) ? 0 : 2;
    const int minor = 2 - major;
    const Lines along = lines_across(field, major);
    const Lines across = lines_across(field, minor);
    const Vec3 &origin = ray.origin;
    const Real direction = ray.direction[major];
    const Real slope = direction == Real(0) ? Real(0) : ray.direction[minor] / direction;
    const Real climb = direction == Real(0) ? Real(0) : ray.direction.y / direction;

    // |slope| <= 1, so a position on the ray carries less than 8 roundings of coordinates as large
    // as these.
    const auto farthest = [](const Lines &lines) {
        return std::max(std::abs(lines.place(0)), std::abs(lines.place(lines.count - 1)));
    };
    const Real room =
        Real(8) * epsilon *
        (std::abs(origin.x) + std::abs(origin.z) + farthest(along) + farthest(across));
    const bool is_forward = direction >= Real(0);
    const auto end = [&] { return origin[major] + ray.max_t * direction; };
    const Real begin_low = is_forward ? origin[major] : end();
    const Real begin_high = is_forward ? end() : origin[major];
    const auto [first, last] = direction == Real(0)
                                   ? along.cells_touching(origin[major], origin[major])
                                   : along.cells_touching(begin_low - room, begin_high + room);
    for (int step = 0; step < last - first; ++step) {
        const int line = is_forward ? first + step : last - 1 - step;
        Real low = along.place(line), high = along.place(line + 1);
        if (direction != Real(0)) {
            // Clip the line of cells to the part between the ray's origin and end.
            const Real until = end();
            if (is_forward ? low > until + room : high < until - room)
                return;
            low = std::max(low, is_forward ? origin[major] : until - room);
            high = std::min(high, is_forward ? until + room : origin[major]);
        } else {
            low = high = origin[major];
        }
        const Real at_low = origin[minor] + slope * (low - origin[major]);
        const Real at_high = origin[minor] + slope * (high - origin[major]);
        const auto [first_across, last_across] = across.cells_touching(
            std::min(at_low, at_high) - room, std::max(at_low, at_high) + room);
        // The ray's range of heights there. A vertical ray has all heights, and so does one whose
        // quotient overflows.
        const Real rise_low = climb * (low - origin[major]);
        const Real rise_high = climb * (high - origin[major]);
        const Real height_room =
            Real(8) * epsilon * (std::abs(origin.y) + std::abs(rise_low) + std::abs(rise_high)) +
            room * std::abs(climb);
        const Real bottom = origin.y + std::min(rise_low, rise_high) - height_room;
        const Real top = origin.y + std::max(rise_low, rise_high) + height_room;
        const bool is_bounded = direction != Real(0) && std::isfinite(top - bottom);
        for (int i = first_across; i < last_across; ++i) {
            const int row = major == 0 ? i : line;
            const int column = major == 0 ? line : i;
            if (is_bounded) {
                const std::size_t corner =
                    std::size_t(row) * std::size_t(field.columns) + std::size_t(column);
                const std::size_t next = corner + std::size_t(field.columns);
                const auto [least, greatest] =
                    std::minmax({field.heights[corner], field.heights[corner + 1],
                                 field.heights[next], field.heights[next + 1]});
                if (field.origin.y + greatest < bottom || field.origin.y + least > top)
                    continue;
            }
            if (!visit(row, column))
                return;
        }
    }
}

} // namespace

void check_valid(const HeightField &field) {
    check_counts(field);
    for (const Real height : field.heights)
        PLUMB_CHECK(std::isfinite(height) && std::isfinite(field.origin.y + height),
                    "heights must be finite, got " << height);
    for (const int axis : {0, 2}) {
        const Lines lines = lines_across(field, axis);
        for (int i = 0; i + 1 < lines.count; ++i)
            PLUMB_CHECK(lines.place(i) < lines.place(i + 1) && std::isfinite(lines.place(i + 1)),
                        "a spacing of " << field.spacing << " is lost to rounding at "
                                        << lines.place(i));
    }
}

Aabb bounds(const HeightField &field) {
    check_counts(field);
    const auto [least, greatest] = std::minmax_element(field.heights.begin(), field.heights.end());
    Aabb box{sample_point(field, 0, 0), sample_point(field, field.rows - 1, field.columns - 1)};
    box.min.y = field.origin.y + *least;
    box.max.y = field.origin.y + *greatest;
    return box;
}

Vec3 sample_point(const HeightField &field, int row, int column) {
    const std::size_t index = std::size_t(row) * std::size_t(field.columns) + std::size_t(column);
    return {lines_across(field, 0).place(column), field.origin.y + field.heights[index],
            lines_across(field, 2).place(row)};
}

std::uint32_t triangle_count(const HeightField &field) {
    return first_triangle(field, field.rows - 1, 0);
}

Triangle triangle(const HeightField &field, std::uint32_t index) {
    PLUMB_DEBUG_CHECK(index < triangle_count(field), "triangle index must be below "
                                                         << triangle_count(field) << ", got "
                                                         << index);
    const int cell = static_cast<int>(index / 2);
    const int row = cell / (field.columns - 1);
    const int column = cell % (field.columns - 1);
    const Vec3 least = sample_point(field, row, column);
    const Vec3 greatest = sample_point(field, row + 1, column + 1);
    if (index % 2 == 0)
        return {least, sample_point(field, row + 1, column), greatest};
    return {least, greatest, sample_point(field, row, column + 1)};
}

std::optional<Real> height_at(const HeightField &field, Real x, Real z) {
    check_counts(field);
    PLUMB_CHECK(!std::isnan(x) && !std::isnan(z),
                "x and z must be numbers, got " << x << " and " << z);
    const Lines columns = lines_across(field, 0);
    const Lines rows = lines_across(field, 2);
    if (x < columns.place(0) || x > columns.place(columns.count - 1) || z < rows.place(0) ||
        z > rows.place(rows.count - 1))
        return std::nullopt;
    const int column = columns.cell_of(x);
    const int row = rows.cell_of(z);
    const Vec3 least = sample_point(field, row, column);
    const Vec3 greatest = sample_point(field, row + 1, column + 1);
    const Real u = (x - least.x) / (greatest.x - least.x);
    const Real v = (z - least.z) / (greatest.z - least.z);
    // Barycentric weights: at a corner two are exactly 0 and one is exactly 1.
    if (v >= u)
        return (Real(1) - v) * least.y + (v - u) * sample_point(field, row + 1, column).y +
               u * greatest.y;
    return (Real(1) - u) * least.y + (u - v) * sample_point(field, row, column + 1).y +
           v * greatest.y;
}

CellRange cells_touching(const HeightField &field, const Aabb &box) {
    check_counts(field);
    const auto [first_row, end_row] = lines_across(field, 2).cells_touching(box.min.z, box.max.z);
    const auto [first_column, end_column] =
        lines_across(field, 0).cells_touching(box.min.x, box.max.x);
    return {first_row, end_row, first_column, end_column};
}

std::optional<RayHit> raycast(const HeightField &field, const Ray &ray) {
    check_counts(field);
    check_ray(ray);
    std::optional<RayHit> best;
    Ray left = ray;
    walk(field, left, [&](int row, int column) {
        const std::uint32_t first = first_triangle(field, row, column);
        for (std::uint32_t index = first; index < first + 2; ++index) {
            const std::optional<RayHit> hit = raycast(triangle(field, index), left);
            if (hit && (!best || hit->t < best->t)) {
                best = hit;
                left.max_t = hit->t;
            }
        }
        return true;
    });
    return best;
}

bool linetest(const HeightField &field, const Vec3 &a, const Vec3 &b) {
    check_counts(field);
    check_point(a);
    check_point(b);
    bool any = false;
    walk(field, Ray{a, b - a, Real(1)}, [&](int row, int column) {
        const std::uint32_t first = first_triangle(field, row, column);
        any = linetest(triangle(field, first), a, b) || linetest(triangle(field, first + 1), a, b);
        return !any;
    });
    return any;
}

Vec3 closest_point(const HeightField &field, const Vec3 &point) {
    check_counts(field);
    check_point(point);
    Vec3 best{Real(0)};
    Real best_squared = std::numeric_limits<Real>::infinity();
    const auto look_at = [&](int row, int column) {
        const std::uint32_t first = first_triangle(field, row, column);
        for (std::uint32_t index = first; index < first + 2; ++index) {
            const Vec3 candidate = closest_point(triangle(field, index), point);
            const Vec3 d = point - candidate;
            const Real squared = glm::dot(d, d);
            if (squared < best_squared) {
                best_squared = squared;
                best = candidate;
            }
        }
    };
    // The cell below, or the closest one to that, gives a first bound.
    look_at(lines_across(field, 2).cell_of(point.z), lines_across(field, 0).cell_of(point.x));
    const Real reach = std::sqrt(best_squared) * (Real(1) + Real(4) * epsilon);
    const CellRange range = cells_touching(field, Aabb{point - reach, point + reach});
    for (int row = range.first_row; row < range.end_row; ++row)
        for (int column = range.first_column; column < range.end_column; ++column) {
            const Vec3 a = sample_point(field, row, column);
            const Vec3 b = sample_point(field, row + 1, column + 1);
            const Real c = sample_point(field, row, column + 1).y;
            const Real d = sample_point(field, row + 1, column).y;
            const auto [least, greatest] = std::minmax({a.y, b.y, c, d});
            const Aabb cell{{a.x, least, a.z}, {b.x, greatest, b.z}};
            if (squared_distance(cell, point) <= best_squared)
                look_at(row, column);
        }
    return best;
}

namespace {

template <typename Solid> bool overlaps_any(const HeightField &field, const Solid &solid) {
    bool any = false;
    triangles_touching(field, bounds(solid), [&](std::uint32_t, const Triangle &t) {
        any = overlaps(t, solid);
        return !any;
    });
    return any;
}

} // namespace

bool overlaps(const HeightField &field, const Sphere &sphere) {
    check_valid(sphere);
    return overlaps_any(field, sphere);
}

bool overlaps(const HeightField &field, const Aabb &box) {
    check_valid(box);
    bool any = false;
    triangles_touching(field, box, [&](std::uint32_t, const Triangle &t) {
        any = overlaps(t, box);
        return !any;
    });
    return any;
}

bool overlaps(const HeightField &field, const Capsule &capsule) {
    check_valid(capsule);
    return overlaps_any(field, capsule);
}

} // namespace plumb::inline PLUMB_PRECISION
