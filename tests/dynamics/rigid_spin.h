// Torque-free rotation in long double, as a reference: Runge-Kutta with very small steps.
#pragma once

#include "engine/math/types.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

using WideVec = glm::vec<3, long double>;

struct WideQuat {
    long double w = 1, x = 0, y = 0, z = 0;
};

inline WideVec widened(const Vec3 &v) {
    return {v.x, v.y, v.z};
}
inline WideQuat widened(const Quat &q) {
    return {q.w, q.x, q.y, q.z};
}
inline WideQuat product(const WideQuat &a, const WideQuat &b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline WideQuat normalized(const WideQuat &q) {
    const long double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / n, q.x / n, q.y / n, q.z / n};
}
// q v q*, as quaternion products.
inline WideVec turn(const WideQuat &q, const WideVec &v) {
    const WideQuat r = product(product(q, {0, v.x, v.y, v.z}), {q.w, -q.x, -q.y, -q.z});
    return {r.x, r.y, r.z};
}
inline WideVec turn_back(const WideQuat &q, const WideVec &v) {
    return turn({q.w, -q.x, -q.y, -q.z}, v);
}
// The angle of the rotation from one to the other (rad).
inline double angle_between(const WideQuat &a, const WideQuat &b) {
    const WideQuat d = product({a.w, -a.x, -a.y, -a.z}, b);
    const long double sine = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return double(2 * std::atan2(sine, std::abs(d.w)));
}

struct SpinState {
    WideQuat rotation;
    WideVec spin{0}; // body axes
};

// The state after `time` seconds, starting from body-frame `spin`.
inline SpinState spin_reference(const glm::dvec3 &inertia, const WideVec &spin,
                                const WideQuat &rotation, long double time, int steps) {
    const WideVec moments{inertia.x, inertia.y, inertia.z};
    const auto rate = [&](const SpinState &s) {
        const WideQuat q = product(s.rotation, {0, s.spin.x, s.spin.y, s.spin.z});
        return SpinState{{q.w / 2, q.x / 2, q.y / 2, q.z / 2},
                         -glm::cross(s.spin, moments * s.spin) / moments};
    };
    const auto ahead = [](const SpinState &s, long double h, const SpinState &k) {
        return SpinState{{s.rotation.w + h * k.rotation.w, s.rotation.x + h * k.rotation.x,
                          s.rotation.y + h * k.rotation.y, s.rotation.z + h * k.rotation.z},
                         s.spin + h * k.spin};
    };
    const long double h = time / steps;
    SpinState s{rotation, spin};
    for (int i = 0; i < steps; ++i) {
        const SpinState k1 = rate(s);
        const SpinState k2 = rate(ahead(s, h / 2, k1));
        const SpinState k3 = rate(ahead(s, h / 2, k2));
        const SpinState k4 = rate(ahead(s, h, k3));
        s = ahead(ahead(ahead(ahead(s, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
        s.rotation = normalized(s.rotation);
    }
    return s;
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
