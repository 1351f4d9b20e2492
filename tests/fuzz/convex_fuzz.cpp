// libFuzzer target: GJK and EPA end, and do not contradict each other, whatever the shapes.
#include "engine/geometry/epa.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/quickhull.h"
#include "tests/fuzz/input.h"

#include <variant>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb {
namespace {

using Any = std::variant<Segment, Triangle, Sphere, Box, Aabb, Capsule, Cylinder, ConvexHull>;

Any any_shape(FuzzInput &input, HullMesh &mesh) {
    switch (input.below(8)) {
    case 0: {
        const Vec3 a = input.point();
        return Segment{a, input.point()};
    }
    case 1: {
        const Vec3 a = input.point(), b = input.point();
        return Triangle{a, b, input.point()};
    }
    case 2: {
        const Vec3 center = input.point();
        return Sphere{center, input.size()};
    }
    case 3: {
        const Vec3 center = input.point();
        const Quat rotation = input.rotation();
        const Real x = input.size(), y = input.size(), z = input.size();
        return Box{center, rotation, {x, y, z}};
    }
    case 4:
        return input.aabb();
    case 5: {
        const Vec3 a = input.point(), b = input.point();
        return Capsule{a, b, input.size()};
    }
    case 6: {
        const Vec3 a = input.point();
        Vec3 b = input.point();
        if (a == b)
            b.y += Real(1);
        if (a == b)
            return Sphere{a, input.size()};
        return Cylinder{a, b, input.size()};
    }
    default: {
        std::vector<Vec3> points;
        for (std::uint32_t i = 4 + input.below(20); i > 0; --i)
            points.push_back(input.point());
        HullResult hull = convex_hull(points, 64);
        if (!hull.mesh)
            return Sphere{input.point(), input.size()};
        mesh = std::move(*hull.mesh);
        const Vec3 position = input.point();
        return ConvexHull{&mesh, position, input.rotation()};
    }
    }
}

bool is_sound(const Vec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace
} // namespace plumb

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace plumb;
    FuzzInput input(data, size);
    HullMesh mesh_a, mesh_b;
    const Any a = any_shape(input, mesh_a);
    const Any b = any_shape(input, mesh_b);
    std::visit(
        [](const auto &first, const auto &second) {
            const ClosestPoints apart = distance(first, second);
            FUZZ_ASSERT(apart.distance >= Real(0) && std::isfinite(apart.distance));
            FUZZ_ASSERT(is_sound(apart.on_a) && is_sound(apart.on_b) && is_sound(apart.normal));
            if (apart.distance > Real(0))
                FUZZ_ASSERT(std::abs(glm::dot(apart.normal, apart.normal) - Real(1)) < Real(1e-3));
            const std::optional<Penetration> deep = penetration(first, second);
            if (deep) {
                FUZZ_ASSERT(deep->depth >= Real(0) && std::isfinite(deep->depth));
                FUZZ_ASSERT(std::abs(glm::dot(deep->normal, deep->normal) - Real(1)) < Real(1e-3));
                FUZZ_ASSERT(is_sound(deep->on_a) && is_sound(deep->on_b));
            }
        },
        a, b);
    return 0;
}
