// How far apart two polyhedra are, or how deep in each other, where that is known from one face:
// much sooner than by GJK and EPA, but only with a guess, such as the normal of a step before.
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

// Two cores relative to one origin. `guess` points from A to B; it needs no length, but must not be
// zero. None where neither of the two faces that look most along the guess decides it, and where a
// box is flat. The normal is that of the face; what is said to be farther apart than `far` is so.
//
// The corner of the other that is deepest along the face's normal decides: apart, when it is over
// the face, for the plane parts them, and nothing is nearer than the corner and its foot. In
// penetration, when no other plane of the face's owner is as near to the corner: the corner has to
// leave, which takes at least that far, and so far along the normal all of it has left.
template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> face_gap(const A &a, const B &b, const Vec3 &guess, Real far);

} // namespace plumb::inline PLUMB_PRECISION
