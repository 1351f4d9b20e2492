// Ground as a grid of heights.
#pragma once

#include "engine/geometry/raycast.h"
#include "engine/geometry/shapes.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A surface, not a solid: a sheet over a rectangle of the xz plane, with nothing below it and no
// rim. Sample (row, column) is at origin + (column * spacing, heights[row * columns + column], row
// * spacing). Each cell between four samples is two triangles, split along the diagonal from its
// lowest (row, column) to its highest; their fronts face up.
struct HeightField {
    Vec3 origin{Real(0)};
    Real spacing = Real(1); // > 0
    int rows = 0;           // of samples, along z; >= 2
    int columns = 0;        // along x; >= 2
    std::vector<Real> heights;
};

// Fails a check, naming the value, if there are fewer than two rows or columns, if the number of
// heights is not rows * columns, if the spacing is not positive or so small that rounding puts two
// columns or rows in the same place, or if anything is not finite. Looks at every height; the
// queries check only the rest.
void check_valid(const HeightField &field);

Aabb bounds(const HeightField &field);

// The position of a sample, bit for bit the same in every query.
Vec3 sample_point(const HeightField &field, int row, int column);

// Cell (row, column) consists of triangles first_triangle, on the side of greater z, and
// first_triangle + 1, on the side of greater x.
inline std::uint32_t first_triangle(const HeightField &field, int row, int column) {
    return 2 * (static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(field.columns - 1) +
                static_cast<std::uint32_t>(column));
}
std::uint32_t triangle_count(const HeightField &field);
Triangle triangle(const HeightField &field, std::uint32_t index);

// The surface height y at (x, z), borders included; none outside. Exact at samples, elsewhere
// within 8 epsilon times the cell's greatest |y|. NaN fails a check.
std::optional<Real> height_at(const HeightField &field, Real x, Real z);

// The cells that touch a box seen from above, as half-open ranges; empty if the box is beside the
// field.
struct CellRange {
    int first_row = 0, end_row = 0;
    int first_column = 0, end_column = 0;
};
CellRange cells_touching(const HeightField &field, const Aabb &box);

// Calls visit(index, triangle) for each triangle whose bounds touch the box, in ascending order of
// index, until it returns false.
template <typename Visit>
void triangles_touching(const HeightField &field, const Aabb &box, Visit &&visit) {
    const CellRange range = cells_touching(field, box);
    for (int row = range.first_row; row < range.end_row; ++row)
        for (int column = range.first_column; column < range.end_column; ++column) {
            const std::uint32_t first = first_triangle(field, row, column);
            for (std::uint32_t index = first; index < first + 2; ++index) {
                const Triangle t = triangle(field, index);
                const auto [low, high] = std::minmax({t.a.y, t.b.y, t.c.y});
                if (low <= box.max.y && high >= box.min.y && !visit(index, t))
                    return;
            }
        }
}

// The first hit on the surface, from either side, as for its triangles (raycast.h): watertight, and
// every triangle on the ray's way is tested. The normal is on the side the ray comes from.
//
// The grid is walked cell by cell (Amanatides, Woo 1987, "A fast voxel traversal algorithm for ray
// tracing"), but without accumulating steps: the cells the ray crosses in each column (row, for
// rays mostly along z) are computed from scratch, with room for rounding.
std::optional<RayHit> raycast(const HeightField &field, const Ray &ray);

// Whether the segment from a to b touches the surface; exact. a == b is a point.
bool linetest(const HeightField &field, const Vec3 &a, const Vec3 &b);

// A closest point of the surface, as for its triangles (triangle.h). From high above it looks at
// all cells whose horizontal distance is not larger than the height.
Vec3 closest_point(const HeightField &field, const Vec3 &point);

// As for the triangles (triangle_overlap.h).
bool overlaps(const HeightField &field, const Sphere &sphere);
bool overlaps(const HeightField &field, const Aabb &box);
bool overlaps(const HeightField &field, const Capsule &capsule);

} // namespace plumb::inline PLUMB_PRECISION
