// libFuzzer target: GJK, EPA, casts and manifolds terminate and do not contradict each other,
// whatever the shapes.
#include "engine/geometry/manifold.h"
#include "engine/geometry/quickhull.h"
#include "engine/geometry/shape_cast.h"
#include "tests/fuzz/input.h"

#include <optional>
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
bool is_unit(const Vec3 &v) {
    return std::abs(glm::dot(v, v) - Real(1)) < Real(1e-3);
}

// Checks distance and penetration; returns the separation, negative if the shapes overlap.
template <typename A, typename B> Real check_pair(const A &a, const B &b) {
    const ClosestPoints apart = distance(a, b);
    FUZZ_ASSERT(apart.distance >= Real(0) && std::isfinite(apart.distance));
    FUZZ_ASSERT(is_sound(apart.on_a) && is_sound(apart.on_b));
    FUZZ_ASSERT(apart.distance > Real(0) ? is_unit(apart.normal) : apart.normal == Vec3{Real(0)});
    const std::optional<Penetration> deep = penetration(a, b);
    if (!deep)
        return apart.distance;
    FUZZ_ASSERT(deep->depth >= Real(0) && std::isfinite(deep->depth));
    FUZZ_ASSERT(is_unit(deep->normal) && is_sound(deep->on_a) && is_sound(deep->on_b));
    return -deep->depth;
}

template <typename A, typename B> void check_cast(const A &a, const Vec3 &translation, const B &b) {
    const std::optional<CastHit> hit = cast(a, translation, b);
    if (!hit)
        return;
    FUZZ_ASSERT(hit->t >= Real(0) && hit->t <= Real(1) && is_sound(hit->point));
    FUZZ_ASSERT(is_unit(hit->normal) && (!hit->starts_overlapping || hit->t == Real(0)));
}

template <typename A, typename B> void check_collision(const A &a, const B &b, Real separation) {
    constexpr Real margin = Real(0.25);
    const Manifold manifold = collide(a, b, margin);
    FUZZ_ASSERT(manifold.count >= 0 && manifold.count <= 4);
    // Overlapping shapes touch.
    FUZZ_ASSERT(manifold.count > 0 || separation > Real(0));
    FUZZ_ASSERT(manifold.count == 0 || is_unit(manifold.normal));
    for (int i = 0; i < manifold.count; ++i) {
        const ManifoldPoint &point = manifold.points[static_cast<std::size_t>(i)];
        FUZZ_ASSERT(is_sound(point.position) && std::isfinite(point.separation));
    }
}

} // namespace
} // namespace plumb

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace plumb;
    FuzzInput input(data, size);
    HullMesh mesh_a, mesh_b;
    const Any a = any_shape(input, mesh_a);
    const Any b = any_shape(input, mesh_b);
    const Vec3 translation = input.point();
    std::visit(
        [&](const auto &first, const auto &second) {
            const Real separation = check_pair(first, second);
            check_cast(first, translation, second);
            using A = std::decay_t<decltype(first)>;
            using B = std::decay_t<decltype(second)>;
            if constexpr (Collidable<A, B>)
                check_collision(first, second, separation);
        },
        a, b);
    // No search runs into its limit.
    for (const char *limit : {"gjk: iteration limit", "epa: vertex limit", "cast: step limit"})
        FUZZ_ASSERT(oddity(limit).met == 0U);
    return 0;
}
