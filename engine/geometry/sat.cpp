#include "engine/geometry/sat.h"

#include "engine/geometry/sat_axes.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Edge directions whose cross product is shorter than this (the sine of their angle) count as
// parallel. A dropped axis costs at most this angle times the edge length, which is rounding.
constexpr Real parallel_sine = Real(16) * std::numeric_limits<Real>::epsilon();

} // namespace

RelativeBox relative_to(const Box &a, const Box &b) {
    const Quat to_a = glm::conjugate(a.rotation);
    return {to_a * (b.center - a.center), glm::mat3_cast(to_a * b.rotation)};
}

BoxAxes best_axes(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b,
                  Real margin) {
    const Vec3 &t = relative.position;
    const Mat3 &r = relative.axes;
    BoxAxes best;

    for (int i = 0; i < 3; ++i) {
        const Real reach = half_a[i] + std::abs(r[0][i]) * half_b.x + std::abs(r[1][i]) * half_b.y +
                           std::abs(r[2][i]) * half_b.z;
        const Real separation = std::abs(t[i]) - reach;
        if (separation > best.face_a.separation) {
            Vec3 normal{Real(0)};
            normal[i] = t[i] < Real(0) ? Real(-1) : Real(1);
            best.face_a = {separation, normal, i, 0};
            if (separation > margin)
                return best;
        }
    }

    for (int j = 0; j < 3; ++j) {
        const Real along = glm::dot(t, r[j]);
        const Real separation = std::abs(along) - (half_b[j] + glm::dot(glm::abs(r[j]), half_a));
        if (separation > best.face_b.separation) {
            best.face_b = {separation, along < Real(0) ? -r[j] : r[j], 0, j};
            if (separation > margin)
                return best;
        }
    }

    // Both boxes are projected with all three half edges, also those that the axis was made
    // perpendicular to. So an axis that rounding has turned is still a valid axis: it never reports
    // boxes apart that are not. And as the rectangle of the Minkowski difference that two nearly
    // parallel edges span is thin just where the axis is uncertain, what it misses is rounding too.
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            Vec3 axis{Real(0)}; // e_i x r_j
            axis[(i + 1) % 3] = -r[j][(i + 2) % 3];
            axis[(i + 2) % 3] = r[j][(i + 1) % 3];
            const Real sine = glm::length(axis);
            if (sine <= parallel_sine)
                continue;
            axis /= sine;
            const Real along = glm::dot(t, axis);
            const Real reach = glm::dot(glm::abs(axis), half_a) +
                               std::abs(glm::dot(axis, r[0])) * half_b.x +
                               std::abs(glm::dot(axis, r[1])) * half_b.y +
                               std::abs(glm::dot(axis, r[2])) * half_b.z;
            const Real separation = std::abs(along) - reach;
            if (separation > best.edges.separation) {
                best.edges = {separation, along < Real(0) ? -axis : axis, i, j};
                if (separation > margin)
                    return best;
            }
        }
    }
    return best;
}

SatResult separating_axis(const Box &a, const Box &b) {
    check_valid(a);
    check_valid(b);
    const BoxAxes best = best_axes(relative_to(a, b), a.half_extents, b.half_extents,
                                   std::numeric_limits<Real>::infinity());
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
    return {axis->separation, a.rotation * axis->normal, kind, axis->index_a, axis->index_b};
}

bool overlaps(const Box &a, const Box &b) {
    check_valid(a);
    check_valid(b);
    const BoxAxes best = best_axes(relative_to(a, b), a.half_extents, b.half_extents, Real(0));
    return best.face_a.separation <= Real(0) && best.face_b.separation <= Real(0) &&
           best.edges.separation <= Real(0);
}

} // namespace plumb::inline PLUMB_PRECISION
