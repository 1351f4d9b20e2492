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

} // namespace plumb::inline PLUMB_PRECISION
