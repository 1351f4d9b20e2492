// Conversions between forms of rotations and rigid transforms.
#pragma once

#include "engine/math/types.h"

#include <cmath>
#include <limits>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// Whether this is the squared length of a unit vector or quaternion up to rounding: the length is
// off by at most 16 epsilon. A product of several rotations passes; one typed in by hand with few
// digits does not.
inline bool is_unit(Real squared_length) {
    return std::abs(squared_length - Real(1)) <= Real(32) * std::numeric_limits<Real>::epsilon();
}

// The same rotation with unit length; q itself, bit for bit, if it is unit already. q must not be
// zero.
inline Quat unit(const Quat &q) {
    return is_unit(glm::dot(q, q)) ? q : glm::normalize(q);
}

// q's rotation matrix, a rotation even when q is off unit length, where glm::mat3_cast gives a
// matrix that scales or shears. q must not be zero.
inline Mat3 rotation_matrix(const Quat &q) {
    const Real scale = Real(2) / glm::dot(q, q);
    const Real x = scale * q.x, y = scale * q.y, z = scale * q.z;
    const Real xx = x * q.x, yy = y * q.y, zz = z * q.z;
    const Real xy = x * q.y, yz = y * q.z, xz = x * q.z;
    const Real wx = x * q.w, wy = y * q.w, wz = z * q.w;
    return Mat3{Vec3{Real(1) - (yy + zz), xy + wz, xz - wy},
                Vec3{xy - wz, Real(1) - (xx + zz), yz + wx},
                Vec3{xz + wy, yz - wx, Real(1) - (xx + yy)}};
}

// --- Transform ---------------------------------------------------------------------------------

// First `inner`, then `outer`: to_world_point(compose(outer, inner), p) is
// to_world_point(outer, to_world_point(inner, p)). A child's pose in the world is
// compose(parent, child).
Transform compose(const Transform &outer, const Transform &inner);

// compose(inverse(t), t) is the identity.
Transform inverse(const Transform &t);

Mat4 to_matrix(const Transform &t);

// The inverse of a matrix that only rotates (or mirrors) and translates: transposes the rotation,
// with no determinant. Wrong for any other matrix; in debug builds a matrix that is not rigid
// within 1e-3 fails a check.
Mat4 rigid_inverse(const Mat4 &m);

// --- Matrices that have drifted, or scale ------------------------------------------------------

// Orthonormalises the columns in order, so the first keeps its direction and the second its plane
// with the first (Gram-Schmidt, each step twice: Giraud, Langou, Rozloznik 2005, "The loss of
// orthogonality in the Gram-Schmidt orthogonalization process"). Keeps the handedness. None when
// the columns are coplanar: one is zero, or less than 8 epsilon of its length is left.
std::optional<Mat3> orthonormalized(const Mat3 &m);

// Scale along the axes, then rotate, then translate.
struct ScaledTransform {
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation;
    Vec3 scale{Real(1)};
};

Mat4 to_matrix(const ScaledTransform &t);

// Splits a matrix into these parts. A mirroring matrix gets a negative scale.x (the mirrored axis
// cannot be recovered: two mirrors are half a turn), so the parts may differ from the original ones
// but give the same matrix. None when a column of the 3x3 part is zero or the columns are coplanar
// (see orthonormalized), when two columns are not perpendicular (their cosine is above 1e-3: a
// shear, which these parts cannot express), or when the last row is not (0, 0, 0, 1).
std::optional<ScaledTransform> decompose(const Mat4 &m);

// --- Euler angles ------------------------------------------------------------------------------

// Yaw about Y, then pitch about the new X, then roll about the newest Z (intrinsic Y-X'-Z''; as
// matrices Y(yaw) X(pitch) Z(roll)); radians, right-handed.
struct EulerAngles {
    Real yaw = Real(0);
    Real pitch = Real(0);
    Real roll = Real(0);
};

Quat rotation_of(const EulerAngles &angles);

// The angles of a rotation: yaw and roll in [-pi, pi], pitch in [-pi/2, pi/2] (Bernardes, Viollet
// 2022, "Quaternion to Euler angles conversion: A direct, general and computationally efficient
// method"). At a pitch of pi/2 or -pi/2 (gimbal lock) yaw and roll turn about the same line and
// only their difference or sum is determined: there, within 8 epsilon, roll is 0 and yaw takes it
// all.
EulerAngles euler_angles(const Quat &rotation);

// --- Axis and angle ----------------------------------------------------------------------------

struct AxisAngle {
    Vec3 axis{Real(0), Real(1), Real(0)}; // unit
    Real angle = Real(0);                 // radians
};

// The rotation about an axis of any length; a zero axis fails a check.
Quat rotation_of(const AxisAngle &turn);

// Angle in [0, pi]. The identity has axis +Y; half a turn, either of its two axes. Accurate for
// small angles, where glm::axis and glm::angle are not.
AxisAngle axis_angle(const Quat &rotation);

} // namespace plumb::inline PLUMB_PRECISION
