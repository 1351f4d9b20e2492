#include "engine/geometry/manifold.h"

#include "engine/core/check.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

void check_margin(Real margin) {
    PLUMB_CHECK(margin >= Real(0) && std::isfinite(margin),
                "contact margin must be finite and not negative, got " << margin);
}

Manifold collide(const Shape &a, const Shape &b, Real margin, const Vec3 &guess) {
    return std::visit(
        [&]<typename A, typename B>(const A &first, const B &second) {
            // A shape type without contact functions would recurse into this function.
            static_assert(Collidable<A, B>, "each two kinds of Shape need unchecked::collide");
            return collide(first, second, margin, guess);
        },
        a, b);
}

Manifold collide_under(const Shape &a, const Shape &b, Real margin, const Vec3 &guess,
                       const Vec3 &load) {
    return std::visit(
        [&]<typename A, typename B>(const A &first, const B &second) {
            if constexpr (CollidesUnderLoad<A, B>)
                return unchecked::collide_under(first, second, margin, guess, load);
            else if constexpr (CollidesUnderLoad<B, A>)
                return mirrored(unchecked::collide_under(second, first, margin, -guess, load));
            else
                return collide(first, second, margin, guess);
        },
        a, b);
}

} // namespace plumb::inline PLUMB_PRECISION
