// Shared by the contact functions of all shape pairs.
#pragma once

#include "engine/geometry/manifold.h"

#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

inline void add_point(Manifold &manifold, const Vec3 &position, Real separation,
                      std::uint32_t feature) {
    manifold.points[static_cast<std::size_t>(manifold.count++)] = {position, separation, feature};
}

// Separations (metres) that differ by less than this count as equal when choosing contact features:
// a face is kept unless an edge or another face is better by more, and a vertex this close outside
// a face counts as on it. So boxes at rest on each other keep their features despite the solver's
// small motions. 0.1 mm is far below the sizes simulated and above their jitter.
inline constexpr Real feature_tolerance = Real(1e-4);

// The cosine of how far a side may lean over a face and still touch it with both ends: with one end
// alone, a beam across a round rail would rock from edge to edge for ever.
inline constexpr Real leaning_cosine = Real(0.9998);

// Where a side leans over a face that it touches at the border, the end of what is over the face
// that is farther from there: `foot` on the face, and `height` above it along the contact normal.
struct OtherEnd {
    Vec3 foot;
    Real height;
    bool is_last; // towards the side's end, not its start
};
// `face`: corners, counter-clockwise around its normal. `closest`: where the side touches it.
// `out`: the contact normal, from the face to the side. None if it leans too far.
std::optional<OtherEnd> other_end(std::span<const Vec3> face, const Vec3 &face_normal,
                                  const Vec3 &start, const Vec3 &end, const Vec3 &closest,
                                  const Vec3 &out);

// A direction perpendicular to `axis`, which need not be of unit length; +Y if `axis` is zero.
Vec3 any_perpendicular(const Vec3 &axis);

} // namespace plumb::inline PLUMB_PRECISION
