// Distance or penetration of two polyhedra when a single face decides it: much faster than GJK and
// EPA, but needs a guess, such as the previous step's normal.
#pragma once

#include "engine/geometry/epa.h"

#include <concepts>
#include <optional>
#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {

template <typename Core>
concept HasFaceGap = std::same_as<Core, BoxCore> || std::same_as<Core, HullCore>;
template <typename A, typename B>
concept HaveFaceGap = HasFaceGap<std::remove_const_t<A>> && HasFaceGap<std::remove_const_t<B>>;

// The cores are relative to a common origin. `guess` points from A to B; its length does not
// matter, but it must not be zero. Returns none if neither shape's face most aligned with the guess
// decides the result, or if the box that owns the face is flat. The normal is the face's. A result
// with is_beyond really is farther apart than `far`.
//
// The other shape's deepest corner along the face's normal decides. If it is outside and over the
// face, the plane separates the shapes, and no points are closer than the corner and its
// projection. If it is inside, the result holds when no other face plane of the owner is closer to
// the corner: the corner must get out, which takes at least that depth, and that far along the
// normal the whole shape is out.
template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> face_gap(const A &a, const B &b, const Vec3 &guess, Real far);

} // namespace plumb::inline PLUMB_PRECISION
