// Offsets of a body's values, for the kernels.
#pragma once

#include "engine/dynamics/bodies/body.h"

#include <cstddef>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

// `bodies` is the first Real of an array of SolverBody; the rest are offsets in Reals from the
// start of a SolverBody.
struct BodyReals {
    Real *bodies = nullptr;
    int position = 0;
    int rotation = 0; // its x; w is at rotation_w
    int rotation_w = 0;
    int velocity = 0;
    int angular_velocity = 0;
    int moved = 0;
    int turned = 0;
    int inv_inertia = 0;
    static constexpr std::size_t stride = sizeof(SolverBody) / sizeof(Real);
};

inline BodyReals reals_of(std::span<SolverBody> bodies) {
    static_assert(sizeof(SolverBody) % sizeof(Real) == 0);
    // Kernels write both as one row.
    static_assert(offsetof(Motion, angular_velocity) == offsetof(Motion, velocity) + sizeof(Vec3));
    if (bodies.empty())
        return {};
    SolverBody &body = bodies.front();
    const auto offset_of = [&](const Real &member) {
        return static_cast<int>(&member - &body.position.x);
    };
    return {
        &body.position.x,           offset_of(body.position.x), offset_of(body.rotation.x),
        offset_of(body.rotation.w), offset_of(body.velocity.x), offset_of(body.angular_velocity.x),
        offset_of(body.moved.x),    offset_of(body.turned.x),   offset_of(body.inv_inertia[0].x)};
}

} // namespace plumb::inline PLUMB_PRECISION
