#include "engine/geometry/half_space.h"

#include "engine/math/predicates.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

bool overlaps(const HalfSpace &a, const HalfSpace &b) {
    check_valid(a);
    check_valid(b);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (product_difference_sign(a.normal[i], b.normal[j], a.normal[j], b.normal[i]) != 0)
            return true;
    }
    if (glm::dot(a.normal, b.normal) > Real(0))
        return true;
    // B's normal is A's times -k, so B starts at the height -b.offset / k along A's normal; k is
    // the ratio of any pair of non-zero components.
    int i = 0;
    while (std::abs(a.normal[i]) < Real(0.5))
        ++i;
    return product_difference_sign(-b.offset, std::abs(a.normal[i]), a.offset,
                                   std::abs(b.normal[i])) <= 0;
}

} // namespace plumb::inline PLUMB_PRECISION
