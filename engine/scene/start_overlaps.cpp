#include "engine/scene/start_overlaps.h"

#include "engine/geometry/manifold.h"
#include "engine/geometry/quickhull.h"
#include "engine/math/rigid.h"
#include "engine/scene/real/hull_measures.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

using Solid = std::variant<std::monostate, f32::Sphere, f32::Box, f32::Capsule, f32::Cylinder,
                           f32::ConvexHull, f32::HalfSpace>;
using Hulls = StartOverlaps::Hulls;

// The shape with its origin moved to `position`, so that float keeps its digits far out. Nothing
// for surfaces: they are not looked at.
struct AsSolid {
    glm::dvec3 position;
    f32::Quat rotation;
    Hulls &hulls; // made so far

    Solid operator()(const SphereDesc &s) const {
        return f32::Sphere{f32::Vec3(position), static_cast<float>(s.radius)};
    }
    Solid operator()(const BoxDesc &b) const {
        return f32::Box{f32::Vec3(position), rotation, f32::Vec3(b.half_extents)};
    }
    Solid operator()(const CapsuleDesc &c) const {
        const f32::Vec3 up = along_y(c.half_height);
        return f32::Capsule{f32::Vec3(position) - up, f32::Vec3(position) + up,
                            static_cast<float>(c.radius)};
    }
    Solid operator()(const CylinderDesc &c) const {
        const f32::Vec3 up = along_y(c.half_height);
        const f32::Cylinder cylinder{f32::Vec3(position) - up, f32::Vec3(position) + up,
                                     static_cast<float>(c.radius)};
        if (cylinder.a == cylinder.b)
            return {}; // so far from the other that it is none in float
        return cylinder;
    }
    Solid operator()(const HullDesc &h) const {
        auto [made, is_new] = hulls.try_emplace(h.points.get());
        if (is_new) {
            const std::vector<f32::Vec3> points(h.points->begin(), h.points->end());
            if (f32::HullResult hull = f32::convex_hull(points, f32::max_hull_vertices); hull.mesh)
                made->second = std::make_unique<const f32::HullMesh>(std::move(*hull.mesh));
        }
        if (!made->second)
            return {}; // solid in double only
        return f32::ConvexHull{made->second.get(), f32::Vec3(position), rotation};
    }
    Solid operator()(const PlaneDesc &) const {
        const f32::Vec3 normal = along_y(1);
        return f32::HalfSpace{normal, glm::dot(normal, f32::Vec3(position))};
    }
    Solid operator()(const MeshDesc &) const { return {}; }
    Solid operator()(const HeightFieldDesc &) const { return {}; }

  private:
    f32::Vec3 along_y(double length) const {
        return f32::rotated(rotation, f32::Vec3(0, static_cast<float>(length), 0));
    }
};

f32::Manifold contact(const Solid &a, const Solid &b, double margin) {
    return std::visit(
        [&](const auto &one, const auto &other) {
            if constexpr (requires { f32::collide(one, other, 0.0F); })
                return f32::collide(one, other, static_cast<float>(margin));
            else
                return f32::Manifold{};
        },
        a, b);
}

bool do_collide(const ColliderDesc &a, const ColliderDesc &b) {
    const auto ignores = [](const FilterDesc &one, const FilterDesc &other) {
        return (one.ignores >> static_cast<unsigned>(other.layer) & 1U) != 0;
    };
    return !a.sensor && !b.sensor && !ignores(a.filter, b.filter) && !ignores(b.filter, a.filter);
}

} // namespace

std::optional<double> StartOverlaps::deepest(const BodyDesc &a, const BodyDesc &b, double margin) {
    // Both relative to the first, or to the second when the first is a plane: it may be far away.
    const glm::dvec3 origin = has_plane(a) ? b.position : a.position;
    const auto placed = [&](const BodyDesc &body, const ColliderDesc &collider) {
        return std::visit(AsSolid{body.position - origin + body.orientation * collider.position,
                                  f32::unit(f32::Quat(body.orientation * collider.orientation)),
                                  hulls_},
                          collider.shape);
    };
    std::optional<double> depth;
    for (const ColliderDesc &collider_a : a.colliders) {
        const Solid solid_a = placed(a, collider_a);
        for (const ColliderDesc &collider_b : b.colliders) {
            if (!do_collide(collider_a, collider_b))
                continue;
            const f32::Manifold manifold = contact(solid_a, placed(b, collider_b), margin);
            for (int i = 0; i < manifold.count; ++i)
                depth = std::max(
                    depth.value_or(0),
                    -static_cast<double>(manifold.points[static_cast<std::size_t>(i)].separation));
        }
    }
    return depth;
}

} // namespace plumb
