#include "engine/geometry/manifold.h"

#include "engine/core/check.h"
#include "engine/geometry/manifold_pairs.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// For a.index() <= b.index(), in the order of the variant: Sphere, Box, Capsule, HalfSpace.
Manifold collide_ordered(const Shape &a, const Shape &b, Real margin) {
    return std::visit(
        [&](const auto &first, const auto &second) -> Manifold {
            if constexpr (requires { collide_pair(first, second, margin); })
                return collide_pair(first, second, margin);
            else
                return {};
        },
        a, b);
}

} // namespace

Manifold collide(const Shape &a, const Shape &b, Real margin) {
    PLUMB_CHECK(margin >= Real(0) && std::isfinite(margin),
                "contact margin must be finite and not negative, got " << margin);
    check_valid(a);
    check_valid(b);
    if (a.index() > b.index())
        return mirrored(collide_ordered(b, a, margin));
    return collide_ordered(a, b, margin);
}

} // namespace plumb::inline PLUMB_PRECISION
