#include "engine/geometry/check_query.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

namespace plumb::inline PLUMB_PRECISION {

void refuse(const Vec3 &point) {
    PLUMB_CHECK(is_finite(point), "point must be finite, got " << Printed{point});
}

void refuse(const Ray &ray) {
    PLUMB_CHECK(is_finite(ray.origin), "ray origin must be finite, got " << Printed{ray.origin});
    PLUMB_CHECK(is_finite(ray.direction),
                "ray direction must be finite, got " << Printed{ray.direction});
    PLUMB_CHECK(ray.direction != Vec3{Real(0)}, "ray direction must not be zero, got (0, 0, 0)");
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

} // namespace plumb::inline PLUMB_PRECISION
