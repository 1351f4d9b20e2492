// Rotations and rigid transforms, in and out of other forms.
#pragma once

#include "engine/math/types.h"

#include <cmath>
#include <limits>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// Whether the squared length is that of a vector or quaternion of unit length, but for roundings:
// the length is off by at most 16 epsilon. That many a product of several rotations leaves; the
// digits of one that was typed in by hand do not do.
inline bool is_unit(Real squared_length) {
    return std::abs(squared_length - Real(1)) <= Real(32) * std::numeric_limits<Real>::epsilon();
}

// The same rotation with unit length; itself, bit for bit, when it has that. q is not zero.
inline Quat unit(const Quat &q) {
    return is_unit(glm::dot(q, q)) ? q : glm::normalize(q);
}

// The matrix of q's rotation; a rotation also when q is off unit length, where glm::mat3_cast gives
// a matrix that scales or shears. q is not zero.
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

// The inverse of a matrix that rotates (or mirrors) and translates only, without a determinant: the
// rotation transposed. For any other matrix the answer is wrong; in debug builds a matrix that is
// not rigid within 1e-3 fails a check.
Mat4 rigid_inverse(const Mat4 &m);

// --- Matrices that have drifted, or scale ------------------------------------------------------

// The columns made orthonormal one after the other, so that the first keeps its direction and the
// second its plane (Gram and Schmidt, each twice: Giraud, Langou, Rozloznik 2005, "The loss of
// orthogonality in the Gram-Schmidt orthogonalization process"). Of the same handedness as before.
// None when the columns are in one plane: when what is left of one has less than 8 epsilon of its
// length, or it is zero.
std::optional<Mat3> orthonormalized(const Mat3 &m);

// Scale along the axes, then rotate, then translate.
struct ScaledTransform {
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation;
    Vec3 scale{Real(1)};
};

Mat4 to_matrix(const ScaledTransform &t);

// The parts of a matrix made of them. A mirroring matrix gets a negative scale.x (which axis was
// mirrored cannot be told: two mirrors are half a turn), so the parts need not be those that made
// it, but make the same matrix. None when a column of the 3x3 part is zero or they are in one plane
// (see orthonormalized), when two columns are not at right angles (their cosine is above 1e-3: a
// shear, which these parts cannot express), or when the last row is not (0, 0, 0, 1).
std::optional<ScaledTransform> decompose(const Mat4 &m);

// --- Euler angles ------------------------------------------------------------------------------

// Turned about Y by yaw, about the new X by pitch, about the newest Z by roll (intrinsic Y-X'-Z'';
// as matrices Y(yaw) X(pitch) Z(roll)), radians, each right-handed.
struct EulerAngles {
    Real yaw = Real(0);
    Real pitch = Real(0);
    Real roll = Real(0);
};

Quat rotation_of(const EulerAngles &angles);

// The angles of a rotation: yaw and roll in [-pi, pi], pitch in [-pi/2, pi/2] (Bernardes, Viollet
// 2022, "Quaternion to Euler angles conversion: A direct, general and computationally efficient
// method"). At a pitch of pi/2 and -pi/2 (gimbal lock) yaw and roll turn about one line and only
// their difference or sum is known: there, within 8 epsilon, roll is 0 and yaw has all of it.
EulerAngles euler_angles(const Quat &rotation);

// --- Axis and angle ----------------------------------------------------------------------------

struct AxisAngle {
    Vec3 axis{Real(0), Real(1), Real(0)}; // unit
    Real angle = Real(0);                 // radians
};

// The rotation about an axis of any length; a zero axis fails a check.
Quat rotation_of(const AxisAngle &turn);

// Angle in [0, pi]. No rotation at all has the axis +Y; of half a turn, either of the two. Accurate
// for small angles, where glm::axis and glm::angle are not.
AxisAngle axis_angle(const Quat &rotation);

} // namespace plumb::inline PLUMB_PRECISION
