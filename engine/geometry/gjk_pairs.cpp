// GJK, instantiated here once for each pair of cores.
#include "engine/geometry/gjk.h"

namespace plumb::inline PLUMB_PRECISION {

template <typename CoreA, typename CoreB>
GjkResult gjk(const CoreA &a, const CoreB &b, const Vec3 &guess, Real far) {
    // The closest points are final when the support point is no closer along v than they are (van
    // den Bergen 1999, (3)), within this fraction of the squared distance.
    constexpr Real relative = Real(16) * std::numeric_limits<Real>::epsilon();
    constexpr int stall_limit = 6;
    const Real squared_far = far * far;
    int stalls = 0;
    GjkResult result;
    Simplex &simplex = result.simplex;
    Vec3 &v = result.difference;
    v = guess;
    if (!(glm::dot(v, v) >= std::numeric_limits<Real>::min()))
        v = Vec3{Real(1), Real(0), Real(0)};
    for (;;) {
        SimplexVertex &added = simplex.vertices[static_cast<std::size_t>(simplex.count)];
        added.a = a.support(v);
        added.b = b.support(-v);
        added.w = added.b - added.a;
        result.size = glm::max(result.size, magnitudes(added.a) + magnitudes(added.b));
        ++result.iterations;

        const Real along = glm::dot(v, added.w);
        const Real rounding = rounding_along(v, result.size);
        const Real apart = along - rounding;
        if (apart > Real(0) && apart * apart > squared_far * glm::dot(v, v)) {
            result.is_beyond = true;
            return result;
        }
        if (simplex.count > 0) {
            // Rounding counts as well only if v is a triangle's normal or there is no new point:
            // the direction to a long edge nearby is itself mostly rounding.
            const Real gap = result.squared_distance - along;
            const Real allowed = relative * result.squared_distance;
            if (gap <= allowed ||
                (gap <= allowed + rounding && (simplex.count == 3 || has(simplex, added.w)))) {
                result.is_overlapping = result.squared_distance <= rounding;
                return result;
            }
            if (result.iterations > gjk_iteration_limit) [[unlikely]] {
                (void)PLUMB_RARELY("gjk: iteration limit", true);
                return result;
            }
        }
        ++simplex.count;
        SimplexPart part = closest_part(simplex, result.size);
        if (part.count == 4) {
            v = Vec3{Real(0)};
            result.squared_distance = Real(0);
            result.is_overlapping = true;
            return result;
        }
        // Each step gets closer, but near the end rounding can hide that. The distance is then
        // final, but the new direction may still be better, so take a few such steps.
        if (!(part.squared_distance < result.squared_distance)) {
            part =
                closest_part(simplex, result.size, Real(8) * std::numeric_limits<Real>::epsilon());
            if (++stalls > stall_limit ||
                part.squared_distance > result.squared_distance + Real(2) * rounding) {
                --simplex.count;
                // Nothing proves them apart, and the distance is hardly more than rounding.
                result.is_overlapping =
                    result.squared_distance <= (along <= Real(0) ? Real(4) : Real(1)) * rounding;
                return result;
            }
        }
        reduce(simplex, part);
        v = part.closest;
        result.squared_distance = part.squared_distance;
        // Below the smallest normal number no direction is left.
        if (result.squared_distance < std::numeric_limits<Real>::min() ||
            (simplex.count == 3 && result.squared_distance <= rounding_along(v, result.size))) {
            result.is_overlapping = true;
            return result;
        }
    }
}

#define PLUMB_GJK(A, B) template GjkResult gjk(const A &, const B &, const Vec3 &, Real)
#define PLUMB_GJK_WITH_EACH(A)                                                                     \
    PLUMB_GJK(A, PointCore);                                                                       \
    PLUMB_GJK(A, SegmentCore);                                                                     \
    PLUMB_GJK(A, TriangleCore);                                                                    \
    PLUMB_GJK(A, AabbCore);                                                                        \
    PLUMB_GJK(A, BoxCore);                                                                         \
    PLUMB_GJK(A, CylinderCore);                                                                    \
    PLUMB_GJK(A, HullCore)

PLUMB_GJK_WITH_EACH(PointCore);
PLUMB_GJK_WITH_EACH(SegmentCore);
PLUMB_GJK_WITH_EACH(TriangleCore);
PLUMB_GJK_WITH_EACH(AabbCore);
PLUMB_GJK_WITH_EACH(BoxCore);
PLUMB_GJK_WITH_EACH(CylinderCore);
PLUMB_GJK_WITH_EACH(HullCore);

} // namespace plumb::inline PLUMB_PRECISION
