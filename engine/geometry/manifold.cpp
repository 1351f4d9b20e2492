#include "engine/geometry/manifold.h"

#include "engine/core/check.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

void check_margin(Real margin) {
    PLUMB_CHECK(margin >= Real(0) && std::isfinite(margin),
                "contact margin must be finite and not negative, got " << margin);
}

namespace {

template <typename A, typename B>
concept CollidesFromGuess = requires(const A &a, const B &b) {
    unchecked::collide(a, b, Real(0), Vec3{Real(0)});
};

template <typename A, typename B> void check_all(const A &a, const B &b, Real margin) {
    check_margin(margin);
    check_valid(a);
    check_valid(b);
}

} // namespace

Manifold collide(const Shape &a, const Shape &b, Real margin) {
    return collide(a, b, margin, Vec3{Real(0)});
}

Manifold collide(const Shape &a, const Shape &b, Real margin, const Vec3 &guess) {
    return std::visit(
        [&]<typename A, typename B>(const A &first, const B &second) {
            // A kind of shape without contacts would come back here.
            static_assert(Collidable<A, B>, "each two kinds of Shape need unchecked::collide");
            if constexpr (CollidesFromGuess<A, B>) {
                check_all(first, second, margin);
                return unchecked::collide(first, second, margin, guess);
            } else if constexpr (CollidesFromGuess<B, A>) {
                check_all(first, second, margin);
                return mirrored(unchecked::collide(second, first, margin, -guess));
            } else {
                return collide(first, second, margin);
            }
        },
        a, b);
}

} // namespace plumb::inline PLUMB_PRECISION
