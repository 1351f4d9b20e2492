#include "tests/bench/peer_bullet.h"

#include <memory>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <LinearMath/btAabbUtil2.h>

#include <glm/geometric.hpp>

namespace plumb::bullet {

namespace {

btVector3 of(const Vec3 &v) {
    return {v.x, v.y, v.z};
}
btQuaternion of(const Quat &q) {
    return {q.x, q.y, q.z, q.w};
}

struct Placed {
    std::unique_ptr<btConvexShape> shape;
    btTransform pose;
};

btTransform along(const Vec3 &a, const Vec3 &b) {
    const btVector3 up(0, 1, 0), axis = of(b - a).normalized();
    return btTransform(shortestArcQuat(up, axis), of(0.5f * (a + b)));
}

Placed placed(const Sphere &sphere) {
    return {std::make_unique<btSphereShape>(sphere.radius),
            btTransform(btQuaternion::getIdentity(), of(sphere.center))};
}
Placed placed(const Box &box) {
    return {std::make_unique<btBoxShape>(of(box.half_extents)),
            btTransform(of(box.rotation), of(box.center))};
}
Placed placed(const Capsule &capsule) {
    return {std::make_unique<btCapsuleShape>(capsule.radius, glm::length(capsule.b - capsule.a)),
            along(capsule.a, capsule.b)};
}
Placed placed(const Cylinder &cylinder) {
    const float half = 0.5f * glm::length(cylinder.b - cylinder.a);
    return {std::make_unique<btCylinderShape>(btVector3(cylinder.radius, half, cylinder.radius)),
            along(cylinder.a, cylinder.b)};
}
Placed placed(const Triangle &triangle) {
    return {
        std::make_unique<btTriangleShape>(of(triangle.a), of(triangle.b), of(triangle.c)),
        btTransform::getIdentity(),
    };
}
Placed placed(const ConvexHull &hull) {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Vec3 &vertex : hull.mesh->vertices)
        shape->addPoint(of(vertex), false);
    shape->recalcLocalAabb();
    return {std::move(shape), btTransform(of(hull.rotation), of(hull.position))};
}

// The margins that Bullet adds around some shapes are set to zero, so that all engines see the same
// shapes.
struct Object {
    Placed placed_shape;
    btCollisionObject object;

    template <typename Solid> explicit Object(const Solid &solid) : placed_shape(placed(solid)) {
        if (placed_shape.shape->getShapeType() != SPHERE_SHAPE_PROXYTYPE &&
            placed_shape.shape->getShapeType() != CAPSULE_SHAPE_PROXYTYPE)
            placed_shape.shape->setMargin(0);
        object.setCollisionShape(placed_shape.shape.get());
        object.setWorldTransform(placed_shape.pose);
    }
};

using Objects = std::vector<std::unique_ptr<Object>>;

template <typename Solid> Objects objects(std::span<const Solid> solids) {
    Objects result;
    for (const Solid &solid : solids)
        result.push_back(std::make_unique<Object>(solid));
    return result;
}

// Pairs with the algorithms and manifolds that Bullet keeps between steps.
class Pairs {
  public:
    Pairs(Objects a, Objects b) : a_(std::move(a)), b_(std::move(b)) {
        for (std::size_t i = 0; i < a_.size(); ++i) {
            const btCollisionObjectWrapper one = wrapped(*a_[i]);
            const btCollisionObjectWrapper other = wrapped(*b_[i]);
            algorithms_.push_back(
                dispatcher_.findAlgorithm(&one, &other, nullptr, BT_CONTACT_POINT_ALGORITHMS));
        }
    }
    ~Pairs() {
        for (btCollisionAlgorithm *algorithm : algorithms_) {
            algorithm->~btCollisionAlgorithm();
            dispatcher_.freeCollisionAlgorithm(algorithm);
        }
    }
    Pairs(const Pairs &) = delete;
    Pairs &operator=(const Pairs &) = delete;

    std::size_t size() const { return a_.size(); }
    bool touch(std::size_t i) {
        const btCollisionObjectWrapper one = wrapped(*a_[i]);
        const btCollisionObjectWrapper other = wrapped(*b_[i]);
        btManifoldResult result(&one, &other);
        algorithms_[i]->processCollision(&one, &other, info_, &result);
        const btPersistentManifold *manifold = result.getPersistentManifold();
        bool touches = false;
        for (int k = 0; manifold != nullptr && k < manifold->getNumContacts(); ++k)
            touches = touches || manifold->getContactPoint(k).getDistance() <= 0;
        return touches;
    }

  private:
    static btCollisionObjectWrapper wrapped(const Object &object) {
        return {nullptr,
                object.object.getCollisionShape(),
                &object.object,
                object.object.getWorldTransform(),
                -1,
                -1};
    }

    Objects a_, b_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDispatcherInfo info_;
    std::vector<btCollisionAlgorithm *> algorithms_;
};

} // namespace

Work rays_aabbs(std::span<const Ray> rays, std::span<const Aabb> boxes) {
    return [rays, boxes] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const btVector3 direction = of(rays[i].direction);
            const btVector3 inverse(1 / direction.x(), 1 / direction.y(), 1 / direction.z());
            const unsigned signs[3] = {inverse.x() < 0 ? 1U : 0U, inverse.y() < 0 ? 1U : 0U,
                                       inverse.z() < 0 ? 1U : 0U};
            const btVector3 bounds[2] = {of(boxes[i].min), of(boxes[i].max)};
            btScalar t = 0;
            yes += btRayAabb2(of(rays[i].origin), inverse, signs, bounds, t, 0,
                              static_cast<btScalar>(rays[i].max_t))
                       ? 1
                       : 0;
        }
        return yes;
    };
}

Work ray_aabbs(const Ray &ray, std::span<const Aabb> boxes) {
    struct Bounds {
        btVector3 of[2];
    };
    const auto all = std::make_shared<std::vector<Bounds>>();
    for (const Aabb &box : boxes)
        all->push_back({{of(box.min), of(box.max)}});
    return [ray, all] {
        const btVector3 origin = of(ray.origin), direction = of(ray.direction);
        const btVector3 inverse(1 / direction.x(), 1 / direction.y(), 1 / direction.z());
        const unsigned signs[3] = {inverse.x() < 0 ? 1U : 0U, inverse.y() < 0 ? 1U : 0U,
                                   inverse.z() < 0 ? 1U : 0U};
        std::uint64_t yes = 0;
        btScalar t = 0;
        for (const Bounds &bounds : *all)
            yes += btRayAabb2(origin, inverse, signs, bounds.of, t, 0,
                              static_cast<btScalar>(ray.max_t))
                       ? 1
                       : 0;
        return yes;
    };
}

template <typename Solid> Work rays(std::span<const Ray> rays, std::span<const Solid> solids) {
    const auto shared = std::make_shared<Objects>(objects(solids));
    return [rays, shared] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const btVector3 from = of(rays[i].origin);
            const btVector3 to = of(rays[i].origin + rays[i].max_t * rays[i].direction);
            btCollisionWorld::ClosestRayResultCallback result(from, to);
            Object &target = *(*shared)[i];
            btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), from),
                                            btTransform(btQuaternion::getIdentity(), to),
                                            &target.object, target.object.getCollisionShape(),
                                            target.object.getWorldTransform(), result);
            yes += result.hasHit() ? 1 : 0;
        }
        return yes;
    };
}

template <typename A, typename B> Work contacts(std::span<const A> a, std::span<const B> b) {
    const auto pairs = std::make_shared<Pairs>(objects(a), objects(b));
    return [pairs] {
        std::uint64_t yes = 0;
        for (std::size_t i = 0; i < pairs->size(); ++i)
            yes += pairs->touch(i) ? 1 : 0;
        return yes;
    };
}

template <typename A, typename B> Work closest(std::span<const A> a, std::span<const B> b) {
    const auto first = std::make_shared<Objects>(objects(a));
    const auto second = std::make_shared<Objects>(objects(b));
    return [first, second] {
        std::uint64_t yes = 0;
        btVoronoiSimplexSolver simplex;
        btGjkEpaPenetrationDepthSolver depth;
        for (std::size_t i = 0; i < first->size(); ++i) {
            const Object &one = *(*first)[i];
            const Object &other = *(*second)[i];
            btGjkPairDetector detector(one.placed_shape.shape.get(), other.placed_shape.shape.get(),
                                       &simplex, &depth);
            btGjkPairDetector::ClosestPointInput input;
            input.m_transformA = one.placed_shape.pose;
            input.m_transformB = other.placed_shape.pose;
            btPointCollector found;
            detector.getClosestPoints(input, found, nullptr);
            yes += found.m_hasResult && found.m_distance <= 0 ? 1 : 0;
        }
        return yes;
    };
}

template Work rays<Sphere>(std::span<const Ray>, std::span<const Sphere>);
template Work rays<Box>(std::span<const Ray>, std::span<const Box>);
template Work rays<Capsule>(std::span<const Ray>, std::span<const Capsule>);
template Work rays<Cylinder>(std::span<const Ray>, std::span<const Cylinder>);
template Work rays<Triangle>(std::span<const Ray>, std::span<const Triangle>);
template Work rays<ConvexHull>(std::span<const Ray>, std::span<const ConvexHull>);

template Work contacts<Sphere, Sphere>(std::span<const Sphere>, std::span<const Sphere>);
template Work contacts<Sphere, Box>(std::span<const Sphere>, std::span<const Box>);
template Work contacts<Box, Box>(std::span<const Box>, std::span<const Box>);
template Work contacts<Capsule, Capsule>(std::span<const Capsule>, std::span<const Capsule>);
template Work contacts<Capsule, Box>(std::span<const Capsule>, std::span<const Box>);
template Work contacts<Cylinder, Box>(std::span<const Cylinder>, std::span<const Box>);
template Work contacts<ConvexHull, ConvexHull>(std::span<const ConvexHull>,
                                               std::span<const ConvexHull>);

template Work closest<Sphere, Box>(std::span<const Sphere>, std::span<const Box>);
template Work closest<Box, Box>(std::span<const Box>, std::span<const Box>);
template Work closest<Capsule, Box>(std::span<const Capsule>, std::span<const Box>);
template Work closest<Cylinder, Cylinder>(std::span<const Cylinder>, std::span<const Cylinder>);
template Work closest<ConvexHull, ConvexHull>(std::span<const ConvexHull>,
                                              std::span<const ConvexHull>);
template Work closest<Triangle, Triangle>(std::span<const Triangle>, std::span<const Triangle>);

} // namespace plumb::bullet
