// GLM's types in the engine's precision, and the rigid transform.
#pragma once

#include "engine/core/precision.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace plumb::inline PLUMB_PRECISION {

using Vec2 = glm::vec<2, Real, glm::defaultp>;
using Vec3 = glm::vec<3, Real, glm::defaultp>;
using Vec4 = glm::vec<4, Real, glm::defaultp>;
using Mat2 = glm::mat<2, 2, Real, glm::defaultp>;
using Mat3 = glm::mat<3, 3, Real, glm::defaultp>;
using Mat4 = glm::mat<4, 4, Real, glm::defaultp>;
using Quat = glm::qua<Real, glm::defaultp>; // constructor order is (w, x, y, z)

inline constexpr Quat identity_rotation{Real(1), Real(0), Real(0), Real(0)};

// A rigid transform: rotate, then translate. `rotation` has unit length.
struct Transform {
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation;
};

// q v q^-1. Keeps the length even if rounding leaves q slightly off unit length, where GLM's
// product scales the vector: rotated back and forth every step, it would gain or lose length.
inline Vec3 rotated(const Quat &q, const Vec3 &v) {
    const Vec3 axis{q.x, q.y, q.z};
    const Real scale = Real(2) / glm::dot(q, q);
    return v + scale * glm::cross(axis, glm::cross(axis, v) + q.w * v);
}

inline Vec3 to_world_point(const Transform &frame, const Vec3 &local) {
    return frame.position + frame.rotation * local;
}
inline Vec3 to_world_vector(const Transform &frame, const Vec3 &local) {
    return frame.rotation * local;
}
inline Vec3 to_local_point(const Transform &frame, const Vec3 &world) {
    return glm::conjugate(frame.rotation) * (world - frame.position);
}
inline Vec3 to_local_vector(const Transform &frame, const Vec3 &world) {
    return glm::conjugate(frame.rotation) * world;
}

} // namespace plumb::inline PLUMB_PRECISION
