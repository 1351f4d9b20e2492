#include "engine/dynamics/joints/geometric_stiffness.h"

#include "engine/dynamics/bodies/motion.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Replaces the bound by the sum of lengths where that is tighter.
Vec3 nearer(const Vec3 &axial, Real most, const Vec3 &inertia) {
    const Vec3 alike{most};
    return squared_rate(alike, inertia) <= squared_rate(axial, inertia) ? alike : axial;
}

} // namespace

void GeometricStiffness::add_bound(const Vec3 &force, const Vec3 &arm) {
    most += glm::length(force) * glm::length(arm);
}

void GeometricStiffness::add_tensor(const Vec3 &force, const Vec3 &arm) {
    const Real along = glm::dot(force, arm);
    for (int i = 0; i < 3; ++i) {
        tensor[i] -= Real(0.5) * (arm[i] * force + force[i] * arm);
        tensor[i][i] += along;
    }
}

Vec3 axial_stiffness(const GeometricStiffness &stiffness, const Vec3 &inertia,
                     const Quat &rotation) {
    if (is_isotropic(inertia)) // its axes are not kept
        return Vec3{stiffness.most};
    const Mat3 axes = rotation_matrix(rotation);
    const Mat3 in_frame = glm::transpose(axes) * stiffness.tensor * axes;
    Vec3 axial{Real(0)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            axial[i] += std::abs(in_frame[j][i]) * std::sqrt(inertia[i] / inertia[j]);
    return nearer(axial, stiffness.most, inertia);
}

// |(F r) - F_i r_i| is at most the length of r's part across axis i, |F_i r_j + F_j r_i| that of
// its part along axes i and j.
Vec3 greatest_axial_stiffness(const Vec3 &arm, const Vec3 &inertia) {
    if (is_isotropic(inertia))
        return Vec3{glm::length(arm)};
    Vec3 axial{Real(0)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            axial[i] += i == j ? std::hypot(arm[(i + 1) % 3], arm[(i + 2) % 3])
                               : Real(0.5) * std::hypot(arm[i], arm[j]) *
                                     std::sqrt(inertia[i] / inertia[j]);
    return nearer(axial, glm::length(arm), inertia);
}

Real squared_rate(const Vec3 &axial, const Vec3 &inertia) {
    const Vec3 squared = axial / inertia;
    return std::max({squared.x, squared.y, squared.z});
}

} // namespace plumb::inline PLUMB_PRECISION
