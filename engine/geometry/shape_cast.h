// A convex shape that moves along a line until it touches another.
//
// Conservative advancement (Mirtich 1996, "Impulse-based dynamic simulation of rigid body systems",
// 2.3): it is moved as far as the slab between the closest points lets it, again and again. For a
// straight motion the distance is a convex function of time and the slab its tangent, so this is
// Newton's method from the side from which it never passes the root: nothing is tunnelled through,
// however thin.
#pragma once

#include "engine/geometry/epa.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct CastHit {
    Real t = Real(0);     // in [0, 1], of the translation
    Vec3 point{Real(0)};  // where they touch, on B
    Vec3 normal{Real(0)}; // unit, from A to B
    bool starts_overlapping = false;
};

// The first touch of A, moved by t * translation, with B. Both are solid: when they overlap (or
// touch, within cast_target) at t = 0 that is the hit, whichever way A goes, with the normal that
// `penetration` gives. A translation of zero asks only that. One that is not finite fails a check.
//
// At `t` the shapes are within cast_target of each other, and not in each other: the true hit is no
// earlier, but for the rounding of `distance` (gjk.h), with the translation as one of the
// coordinates. A pass closer than the target is a hit, one farther is not.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<CastHit> cast(const A &a, const Vec3 &translation,
                                                      const B &b);

// Fails a check when it is not finite.
void check_translation(const Vec3 &translation);

// How close is a touch, in metres, for coordinates of that size, from the start of the motion: 32
// times what they are rounded by, so that the direction between the closest points means something.
inline Real cast_target(Real size) {
    return Real(32) * std::numeric_limits<Real>::epsilon() * size;
}

// A core that can be put elsewhere than where it starts, whatever its kind. Borrows both.
class MovingCore {
  public:
    template <typename Core>
    MovingCore(Core &core, const Core &start)
        : core_(&core), start_(&start), place_(place_core<Core>) {}

    // At its start, moved by that much.
    void place(const Vec3 &by) const { place_(core_, start_, by); }

  private:
    template <typename Core> static void place_core(void *core, const void *start, const Vec3 &by) {
        Core &placed = *static_cast<Core *>(core);
        placed = *static_cast<const Core *>(start);
        placed.move(by);
    }

    void *core_;
    const void *start_;
    void (*place_)(void *, const void *, const Vec3 &);
};

// The cast of two cores, of which B comes towards A. The hit's point is relative to their origin.
std::optional<CastHit> cast_cores(const CorePair &cores, const MovingCore &core_b,
                                  const Vec3 &translation);

template <typename A, typename B>
requires ConvexPair<A, B> std::optional<CastHit> cast(const A &a, const Vec3 &translation,
                                                      const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto start_b = core_of(b, origin);
    auto core_b = start_b;
    std::optional<CastHit> hit =
        cast_cores(CorePair(core_a, core_b), MovingCore(core_b, start_b), translation);
    if (hit)
        hit->point += origin;
    return hit;
}

} // namespace plumb::inline PLUMB_PRECISION
