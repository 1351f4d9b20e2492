// Shape cast: moves a convex shape along a line until it touches another.
//
// Conservative advancement (Mirtich 1996, "Impulse-based dynamic simulation of rigid body systems",
// 2.3): repeatedly advance the shape as far as the slab between the closest points allows. For
// straight motion the distance is a convex function of time and the slab its tangent, so this is
// Newton's method from the side that never overshoots the root: no tunnelling, however thin the
// shapes.
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

// The first contact of A, moved by t * translation, with B. Both are solid: if they overlap (or
// touch, within cast_target) at t = 0, that is the hit, whichever way A moves, with the normal that
// `penetration` gives. A zero translation tests only that. A non-finite one fails a check.
//
// At `t` the shapes are within cast_target of each other but do not overlap. The true hit is no
// earlier, up to the rounding of `distance` (gjk.h) with the translation counted among the
// coordinates. Passing closer than the target is a hit, farther is not.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<CastHit> cast(const A &a, const Vec3 &translation,
                                                      const B &b);

// Fails a check if it is not finite.
void check_translation(const Vec3 &translation);

// The distance (m) that counts as touching, for coordinates of the given size over the whole
// motion: 32 times their rounding, so that the direction between the closest points is meaningful.
inline Real cast_target(Real size) {
    return Real(32) * std::numeric_limits<Real>::epsilon() * size;
}

// A type-erased core that can be moved from its start. Borrows both cores.
class MovingCore {
  public:
    template <typename Core>
    MovingCore(Core &core, const Core &start)
        : core_(&core), start_(&start), place_(place_core<Core>) {}

    // Places the core at its start moved by `by`.
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

// Casts two cores, moving B towards A. The hit point is relative to their origin.
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
