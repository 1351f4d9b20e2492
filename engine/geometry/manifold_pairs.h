// What the contacts of the single pairs of shapes have in common.
#pragma once

#include "engine/geometry/manifold.h"

namespace plumb::inline PLUMB_PRECISION {

inline void add_point(Manifold &manifold, const Vec3 &position, Real separation,
                      std::uint32_t feature) {
    manifold.points[static_cast<std::size_t>(manifold.count++)] = {position, separation, feature};
}

// Separations (metres) that differ by less than this count as equal where a choice between contact
// features is made: a face is kept unless an edge or another face is better by more, and a vertex
// this little outside of a face is on it. So boxes at rest on each other do not change their
// features with the solver's small motions. 0.1 mm is far below the sizes simulated and above their
// jitter.
inline constexpr Real feature_tolerance = Real(1e-4);

// A direction at right angles to `axis`, which need not have unit length; +Y when axis is zero.
Vec3 any_perpendicular(const Vec3 &axis);

} // namespace plumb::inline PLUMB_PRECISION
