#include "engine/geometry/sat.h"

#include "engine/geometry/sat_axes.h"
#include "engine/math/rigid.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Normalises the rotation to the last place: a valid box may have one that is slightly off.
Box unit(const Box &box) {
    return {box.center, glm::normalize(box.rotation), box.half_extents};
}

// The same axes as in best_axes, but only tests whether one separates the boxes, which needs no
// square roots.
bool have_no_gap(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b) {
    const Vec3 &t = relative.position;
    const Mat3 &r = relative.axes;
    const Mat3 size{glm::abs(r[0]), glm::abs(r[1]), glm::abs(r[2])};
    const Vec3 reach = size * half_b;
    for (int i = 0; i < 3; ++i)
        if (std::abs(t[i]) > half_a[i] + reach[i])
            return false;
    for (int j = 0; j < 3; ++j)
        if (std::abs(glm::dot(t, r[j])) > half_b[j] + glm::dot(size[j], half_a))
            return false;
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const Real a1 = -r[j][i2], a2 = r[j][i1]; // the axis e_i x r_j
            if (a1 * a1 + a2 * a2 <= parallel_sine * parallel_sine)
                continue;
            const Real reach_a = std::abs(a1) * half_a[i1] + std::abs(a2) * half_a[i2];
            const Real reach_b = std::abs(a1 * r[0][i1] + a2 * r[0][i2]) * half_b.x +
                                 std::abs(a1 * r[1][i1] + a2 * r[1][i2]) * half_b.y +
                                 std::abs(a1 * r[2][i1] + a2 * r[2][i2]) * half_b.z;
            if (std::abs(a1 * t[i1] + a2 * t[i2]) > reach_a + reach_b)
                return false;
        }
    }
    return true;
}

} // namespace

SatResult separating_axis(const Box &a, const Box &b) {
    check_valid(a);
    check_valid(b);
    const BoxAxes best = best_axes(relative_to(unit(a), unit(b)), a.half_extents, b.half_extents);
    const BoxAxis *axis = &best.face_a;
    SatAxis kind = SatAxis::face_a;
    if (best.face_b.separation > axis->separation) {
        axis = &best.face_b;
        kind = SatAxis::face_b;
    }
    if (best.edges.separation > axis->separation) {
        axis = &best.edges;
        kind = SatAxis::edges;
    }
    return {axis->separation, unit(a).rotation * axis->normal, kind, axis->index_a, axis->index_b};
}

bool overlaps(const Box &a, const Box &b) {
    check_valid(a);
    check_valid(b);
    const Mat3 to_a = glm::transpose(rotation_matrix(a.rotation));
    return have_no_gap({to_a * (b.center - a.center), to_a * rotation_matrix(b.rotation)},
                       a.half_extents, b.half_extents);
}

bool overlaps(const Aabb &a, const Box &b) {
    check_valid(a);
    check_valid(b);
    if (a.min.x > a.max.x || a.min.y > a.max.y || a.min.z > a.max.z)
        return false;
    // Take differences first: far from the origin they are more accurate than a centre.
    const Vec3 low = b.center - a.min;
    const Vec3 high = a.max - b.center;
    const Vec3 position = Real(0.5) * (low - high);
    const Vec3 half = Real(0.5) * (low + high);
    return have_no_gap({position, rotation_matrix(b.rotation)}, half, b.half_extents);
}

} // namespace plumb::inline PLUMB_PRECISION
