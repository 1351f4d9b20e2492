// Hollows of a surface whose facets a solid crosses within a step: it follows the hollow instead of
// the face that it is over as the step begins.
//
// Along that face it would sink into the next ones by s^2 / (2 R) in a step of length s, in a
// hollow of radius R, and be pushed out: lifted by that, which in a swing of angle A is 1 / A^2
// times what the facets take from it. If the next faces stopped it instead, each by its own normal
// from the substep in which it would reach it, the swing would lose energy at the rate
// omega^2 h / 2. Across the chord between the places where a substep begins and ends, normals do no
// work, as in the discrete gradients of Hairer, Lubich, Wanner 2006, "Geometric Numerical
// Integration", section V.5; only the chords' own bends cost speed, as those of facets do.
#pragma once

#include "engine/space/triangle_surface.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The way of a core point over a hollow in a step: an arc that begins and ends where the point is
// held at its distance from the surface, and turns no farther than the faces there; or their chord.
struct HollowPath {
    Vec3 normal{Real(0)};  // out of the surface where the arc begins, or of the chord; unit
    Real radius = Real(0); // of the arc (m); 0: a chord
};

// For a point that is held at a distance (`rounding`, m) from a surface and goes `way` (m) from
// `core`, over triangle `index`: none if it stays over faces in one plane, or comes over a ridge or
// border. In the surface's frame.
std::optional<HollowPath> path_in_hollow(const TriangleSurface &surface, std::uint32_t index,
                                         const Vec3 &core, Real rounding, const Vec3 &way);

// Whether a face beside this one, over a bend, that the core point is deeper under carries the
// solid alone, though it touches both: where it comes to the bend on its `way` (m). Two contacts
// hand a load on as slowly as they are soft, and by then the solid is elsewhere: lifted where they
// share it, and pushed along the old normal.
bool leaves_to_next_face(const TriangleSurface &surface, std::uint32_t index, const Vec3 &core,
                         Real rounding, Real way);

} // namespace plumb::inline PLUMB_PRECISION
