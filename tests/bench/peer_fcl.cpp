#include "tests/bench/peer_fcl.h"

#include <memory>
#include <vector>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <glm/geometric.hpp>

namespace plumb::fcl_peer {

namespace {

fcl::Vector3f of(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

using Object = std::unique_ptr<fcl::CollisionObjectf>;

Object object(std::shared_ptr<fcl::CollisionGeometryf> shape, const fcl::Matrix3f &turn,
              const Vec3 &center) {
    return std::make_unique<fcl::CollisionObjectf>(std::move(shape), turn, of(center));
}

fcl::Matrix3f of(const Quat &q) {
    return fcl::Quaternionf(q.w, q.x, q.y, q.z).toRotationMatrix();
}

// FCL's capsules and cylinders lie along z.
fcl::Matrix3f along(const Vec3 &axis) {
    return fcl::Quaternionf::FromTwoVectors(fcl::Vector3f::UnitZ(), of(axis)).toRotationMatrix();
}

Object placed(const Sphere &sphere) {
    return object(std::make_shared<fcl::Spheref>(sphere.radius), fcl::Matrix3f::Identity(),
                  sphere.center);
}
Object placed(const Box &box) {
    const Vec3 sides = 2.0f * box.half_extents;
    return object(std::make_shared<fcl::Boxf>(sides.x, sides.y, sides.z), of(box.rotation),
                  box.center);
}
Object placed(const Aabb &box) {
    const Vec3 sides = box.max - box.min;
    return object(std::make_shared<fcl::Boxf>(sides.x, sides.y, sides.z), fcl::Matrix3f::Identity(),
                  0.5f * (box.min + box.max));
}
Object placed(const Capsule &capsule) {
    const Vec3 axis = capsule.b - capsule.a;
    return object(std::make_shared<fcl::Capsulef>(capsule.radius, glm::length(axis)), along(axis),
                  0.5f * (capsule.a + capsule.b));
}
Object placed(const Cylinder &cylinder) {
    const Vec3 axis = cylinder.b - cylinder.a;
    return object(std::make_shared<fcl::Cylinderf>(cylinder.radius, glm::length(axis)), along(axis),
                  0.5f * (cylinder.a + cylinder.b));
}
Object placed(const ConvexHull &hull) {
    const auto vertices = std::make_shared<std::vector<fcl::Vector3f>>();
    for (const Vec3 &vertex : hull.mesh->vertices)
        vertices->push_back(of(vertex));
    const auto faces = std::make_shared<std::vector<int>>();
    for (const HullMesh::Face &face : hull.mesh->faces) {
        faces->push_back(static_cast<int>(face.count));
        for (std::uint32_t i = 0; i < face.count; ++i)
            faces->push_back(static_cast<int>(hull.mesh->vertex_indices[face.first + i]));
    }
    return object(
        std::make_shared<fcl::Convexf>(vertices, static_cast<int>(hull.mesh->faces.size()), faces),
        of(hull.rotation), hull.position);
}

using Objects = std::vector<Object>;

template <typename Solid> std::shared_ptr<Objects> objects(std::span<const Solid> solids) {
    auto result = std::make_shared<Objects>();
    for (const Solid &solid : solids)
        result->push_back(placed(solid));
    return result;
}

} // namespace

template <typename A, typename B> Work overlaps(std::span<const A> a, std::span<const B> b) {
    const auto first = objects(a);
    const auto second = objects(b);
    return [first, second] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < first->size(); ++i) {
            const fcl::CollisionRequestf request;
            fcl::CollisionResultf result;
            fcl::collide((*first)[i].get(), (*second)[i].get(), request, result);
            yes += result.isCollision() ? 1 : 0;
        }
        return yes;
    };
}

template <typename A, typename B> Work distances(std::span<const A> a, std::span<const B> b) {
    const auto first = objects(a);
    const auto second = objects(b);
    return [first, second] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < first->size(); ++i) {
            const fcl::DistanceRequestf request(true);
            fcl::DistanceResultf result;
            fcl::distance((*first)[i].get(), (*second)[i].get(), request, result);
            yes += result.min_distance <= 0 ? 1 : 0;
        }
        return yes;
    };
}

template Work overlaps<Sphere, Sphere>(std::span<const Sphere>, std::span<const Sphere>);
template Work overlaps<Sphere, Aabb>(std::span<const Sphere>, std::span<const Aabb>);
template Work overlaps<Sphere, Box>(std::span<const Sphere>, std::span<const Box>);
template Work overlaps<Aabb, Box>(std::span<const Aabb>, std::span<const Box>);
template Work overlaps<Box, Box>(std::span<const Box>, std::span<const Box>);
template Work overlaps<Capsule, Capsule>(std::span<const Capsule>, std::span<const Capsule>);
template Work overlaps<Capsule, Box>(std::span<const Capsule>, std::span<const Box>);
template Work overlaps<Cylinder, Cylinder>(std::span<const Cylinder>, std::span<const Cylinder>);
template Work overlaps<ConvexHull, ConvexHull>(std::span<const ConvexHull>,
                                               std::span<const ConvexHull>);

template Work distances<Sphere, Box>(std::span<const Sphere>, std::span<const Box>);
template Work distances<Box, Box>(std::span<const Box>, std::span<const Box>);
template Work distances<Capsule, Box>(std::span<const Capsule>, std::span<const Box>);
template Work distances<Cylinder, Cylinder>(std::span<const Cylinder>, std::span<const Cylinder>);
template Work distances<ConvexHull, ConvexHull>(std::span<const ConvexHull>,
                                                std::span<const ConvexHull>);

} // namespace plumb::fcl_peer
