#include "engine/math/rigid.h"

#include "engine/core/check.h"
#include "engine/math/constants.h"
#include "engine/math/printed.h"
#include "engine/math/vectors.h"

#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Mat4 with_translation(const Mat3 &linear, const Vec3 &position) {
    return Mat4{Vec4{linear[0], Real(0)}, Vec4{linear[1], Real(0)}, Vec4{linear[2], Real(0)},
                Vec4{position, Real(1)}};
}

// The unit vector of v without its parts along the unit vectors `a` and `b`; these are removed
// twice, as the first pass leaves rounding the size of the removed parts. None if only rounding is
// left.
std::optional<Vec3> perpendicular_part(const Vec3 &v, const Vec3 &a, const Vec3 &b) {
    const std::optional<Vec3> unit = normalized<3>(v);
    if (!unit)
        return std::nullopt;
    Vec3 rest = *unit - glm::dot(*unit, a) * a;
    rest -= glm::dot(rest, b) * b;
    if (!(glm::dot(rest, rest) > Real(64) * epsilon * epsilon))
        return std::nullopt;
    rest = glm::normalize(rest);
    rest -= glm::dot(rest, a) * a;
    rest -= glm::dot(rest, b) * b;
    return glm::normalize(rest);
}

Real wrapped(Real angle) {
    if (angle > pi)
        return angle - Real(2) * pi;
    return angle < -pi ? angle + Real(2) * pi : angle;
}

} // namespace

Transform compose(const Transform &outer, const Transform &inner) {
    return {to_world_point(outer, inner.position), outer.rotation * inner.rotation};
}

Transform inverse(const Transform &t) {
    const Quat back = glm::conjugate(t.rotation);
    return {-(back * t.position), back};
}

Mat4 to_matrix(const Transform &t) {
    return with_translation(rotation_matrix(t.rotation), t.position);
}

Mat4 rigid_inverse(const Mat4 &m) {
#if !defined(NDEBUG)
    const Mat3 product = glm::transpose(Mat3{m}) * Mat3{m};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            PLUMB_CHECK(std::abs(product[j][i] - Real(i == j)) <= Real(2e-3),
                        "a rigid matrix has orthonormal columns, but columns "
                            << i << " and " << j << " have dot product " << product[j][i]);
    PLUMB_CHECK((Vec4{m[0][3], m[1][3], m[2][3], m[3][3]} == Vec4{0, 0, 0, 1}),
                "a rigid matrix has the last row (0, 0, 0, 1), got w " << m[3][3]);
#endif
    const Mat3 back = glm::transpose(Mat3{m});
    return with_translation(back, -(back * Vec3{m[3]}));
}

std::optional<Mat3> orthonormalized(const Mat3 &m) {
    const Vec3 none{Real(0)};
    const std::optional<Vec3> x = normalized<3>(m[0]);
    if (!x)
        return std::nullopt;
    const std::optional<Vec3> y = perpendicular_part(m[1], *x, none);
    if (!y)
        return std::nullopt;
    const std::optional<Vec3> z = perpendicular_part(m[2], *x, *y);
    if (!z)
        return std::nullopt;
    return Mat3{*x, *y, *z};
}

Mat4 to_matrix(const ScaledTransform &t) {
    Mat3 linear = rotation_matrix(t.rotation);
    for (int i = 0; i < 3; ++i)
        linear[i] *= t.scale[i];
    return with_translation(linear, t.position);
}

std::optional<ScaledTransform> decompose(const Mat4 &m) {
    if (Vec4{m[0][3], m[1][3], m[2][3], m[3][3]} != Vec4{Real(0), Real(0), Real(0), Real(1)})
        return std::nullopt;
    const Mat3 linear{m};
    std::optional<Mat3> axes = orthonormalized(linear);
    if (!axes)
        return std::nullopt;
    ScaledTransform parts;
    parts.position = Vec3{m[3]};
    for (int i = 0; i < 3; ++i) {
        const Vec3 unit = normalized_or<3>(linear[i], Vec3{Real(0)});
        const Vec3 next = normalized_or<3>(linear[(i + 1) % 3], Vec3{Real(0)});
        if (!(std::abs(glm::dot(unit, next)) <= Real(1e-3)))
            return std::nullopt;
        parts.scale[i] = glm::dot((*axes)[i], linear[i]);
    }
    if (glm::determinant(*axes) < Real(0)) {
        (*axes)[0] = -(*axes)[0];
        parts.scale.x = -parts.scale.x;
    }
    parts.rotation = glm::normalize(glm::quat_cast(*axes));
    return parts;
}

Quat rotation_of(const EulerAngles &angles) {
    const Real half_yaw = Real(0.5) * angles.yaw;
    const Real half_pitch = Real(0.5) * angles.pitch;
    const Real half_roll = Real(0.5) * angles.roll;
    const Quat yaw{std::cos(half_yaw), Real(0), std::sin(half_yaw), Real(0)};
    const Quat pitch{std::cos(half_pitch), std::sin(half_pitch), Real(0), Real(0)};
    const Quat roll{std::cos(half_roll), Real(0), Real(0), std::sin(half_roll)};
    return yaw * pitch * roll;
}

EulerAngles euler_angles(const Quat &rotation) {
    const Quat &q = rotation;
    // With c and s the cosine and sine of pitch / 2, multiplying the quaternion out gives
    //   w - x = (c - s) cos((yaw + roll) / 2)    y + z = (c - s) sin((yaw + roll) / 2)
    //   w + x = (c + s) cos((yaw - roll) / 2)    y - z = (c + s) sin((yaw - roll) / 2)
    // and c - s, c + s are sqrt(2) times the cosine and the sine of pitch / 2 + pi / 4.
    const Real minus = std::hypot(q.w - q.x, q.y + q.z);
    const Real plus = std::hypot(q.w + q.x, q.y - q.z);
    const Real half_sum = std::atan2(q.y + q.z, q.w - q.x);
    const Real half_difference = std::atan2(q.y - q.z, q.w + q.x);
    const Real pitch = Real(2) * std::atan2(plus, minus) - Real(0.5) * pi;
    const Real locked = Real(4) * epsilon;
    if (minus <= locked * plus)
        return {wrapped(Real(2) * half_difference), pitch, Real(0)};
    if (plus <= locked * minus)
        return {wrapped(Real(2) * half_sum), pitch, Real(0)};
    return {wrapped(half_sum + half_difference), pitch, wrapped(half_sum - half_difference)};
}

Quat rotation_of(const AxisAngle &turn) {
    const std::optional<Vec3> axis = normalized<3>(turn.axis);
    PLUMB_CHECK(axis.has_value(),
                "the axis of a rotation must not be zero, got " << Printed{turn.axis});
    return glm::angleAxis(turn.angle, *axis);
}

AxisAngle axis_angle(const Quat &rotation) {
    // q and -q are the same rotation; the one with w >= 0 turns by at most pi.
    const Quat q = rotation.w < Real(0) ? -rotation : rotation;
    const Vec3 v{q.x, q.y, q.z};
    const std::optional<Vec3> axis = normalized<3>(v);
    if (!axis)
        return {};
    return {*axis, Real(2) * std::atan2(glm::dot(*axis, v), q.w)};
}

} // namespace plumb::inline PLUMB_PRECISION
