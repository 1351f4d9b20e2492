// Bullet 3 at its defaults: sequential impulses, ten iterations unless told otherwise, one thread.
#include "app/lab/engines/engine.h"

#ifdef PLUMB_WITH_BULLET

#include "app/lab/clocks.h"

#include <cmath>
#include <map>
#include <stdexcept>

#include <btBulletDynamicsCommon.h>

namespace plumb {

namespace {

btVector3 of(const glm::dvec3 &v) {
    return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}
btQuaternion of(const glm::dquat &q) {
    return {static_cast<btScalar>(q.x), static_cast<btScalar>(q.y), static_cast<btScalar>(q.z),
            static_cast<btScalar>(q.w)};
}
glm::dvec3 from(const btVector3 &v) {
    return {v.x(), v.y(), v.z()};
}

constexpr btScalar slab_depth = 5;

struct ShapeMaker {
    std::unique_ptr<btCollisionShape> operator()(const SphereDesc &sphere) const {
        return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere.radius));
    }
    std::unique_ptr<btCollisionShape> operator()(const BoxDesc &box) const {
        return std::make_unique<btBoxShape>(of(box.half_extents));
    }
    std::unique_ptr<btCollisionShape> operator()(const CapsuleDesc &capsule) const {
        return std::make_unique<btCapsuleShape>(static_cast<btScalar>(capsule.radius),
                                                static_cast<btScalar>(2 * capsule.half_height));
    }
    std::unique_ptr<btCollisionShape> operator()(const CylinderDesc &cylinder) const {
        return std::make_unique<btCylinderShape>(
            of(glm::dvec3(cylinder.radius, cylinder.half_height, cylinder.radius)));
    }
    // The margin is added outside the points: the default of 4 cm would show as a gap.
    std::unique_ptr<btCollisionShape> operator()(const HullDesc &hull) const {
        auto shape = std::make_unique<btConvexHullShape>();
        for (const glm::dvec3 &point : *hull.points)
            shape->addPoint(of(point), false);
        shape->recalcLocalAabb();
        shape->setMargin(btScalar(0.001));
        return shape;
    }
    // A thick box: Bullet's planes find one new contact point per step, and friction is worse.
    std::unique_ptr<btCollisionShape> operator()(const PlaneDesc &) const {
        return std::make_unique<btBoxShape>(btVector3(300, slab_depth, 300));
    }
    template <typename Other> std::unique_ptr<btCollisionShape> operator()(const Other &) const {
        return nullptr;
    }
};

// Measures how long the broad and narrow phases took.
class TimedWorld final : public btDiscreteDynamicsWorld {
  public:
    using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
    void performDiscreteCollisionDetection() override {
        const double begin = thread_cpu_time();
        btDiscreteDynamicsWorld::performDiscreteCollisionDetection();
        collide_time += thread_cpu_time() - begin;
    }
    double collide_time = 0;
};

class BulletEngine final : public Engine {
  public:
    explicit BulletEngine(const EngineScene &scene)
        : scene_(scene), dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
        world_.setGravity(of(scene.gravity()));
        if (scene.iterations() > 0)
            world_.getSolverInfo().m_numIterations = scene.iterations();
        for (std::size_t i = 0; i < scene.desc.bodies.size(); ++i)
            add_body(scene.desc.bodies[i], scene.masses[i]);
        for (const JointDesc &joint : scene.desc.joints)
            add_joint(joint);
    }
    ~BulletEngine() override {
        for (const auto &joint : joints_)
            world_.removeConstraint(joint.get());
        for (const auto &body : bodies_)
            world_.removeRigidBody(body.get());
    }

    void step() override {
        const double begin = thread_cpu_time();
        world_.collide_time = 0;
        for (const Driven &driven : driven_)
            drive(driven);
        world_.stepSimulation(static_cast<btScalar>(scene_.dt()), 0);
        collide_share_ = world_.collide_time / (thread_cpu_time() - begin);
    }

    StepWork work() const override {
        StepWork work;
        work.collide = collide_share_;
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
            work.contacts +=
                dispatcher_.getManifoldByIndexInternal(i)->getNumContacts() > 0 ? 1U : 0U;
        work.passes = (work.contacts + joints_.size()) *
                      static_cast<std::size_t>(world_.getSolverInfo().m_numIterations);
        return work;
    }

    std::vector<BodyState> states() const override {
        std::vector<BodyState> states;
        for (std::size_t body = 0; body < bodies_.size(); ++body)
            states.push_back(state(body));
        return states;
    }

    void put(const std::vector<BodyState> &states) override {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            btRigidBody &body = *bodies_[i];
            if (body.isStaticOrKinematicObject())
                continue;
            body.setCenterOfMassTransform(
                btTransform(of(states[i].orientation), of(states[i].position)));
            body.setLinearVelocity(of(states[i].velocity));
            body.setAngularVelocity(of(states[i].angular_velocity));
        }
    }

  private:
    BodyState state(std::size_t body) const {
        const btRigidBody &of_body = *bodies_[body];
        const btTransform &pose = of_body.getWorldTransform();
        const btQuaternion turn = pose.getRotation();
        return {from(pose.getOrigin()), glm::dquat(turn.w(), turn.x(), turn.y(), turn.z()),
                from(of_body.getLinearVelocity()), from(of_body.getAngularVelocity())};
    }

    struct Driven { // a kinematic body: Bullet derives its velocity from its poses
        btRigidBody *body;
        btVector3 velocity, spin;
    };

    btCollisionShape *shape_of(const BodyDesc &body) {
        const auto make = [&](const ColliderDesc &collider) {
            auto shape = std::visit(ShapeMaker{}, collider.shape);
            if (!shape)
                throw std::invalid_argument("one of its shapes");
            shapes_.push_back(std::move(shape));
            return shapes_.back().get();
        };
        const ColliderDesc &first = body.colliders.front();
        const bool is_slab = std::holds_alternative<PlaneDesc>(first.shape);
        if (!is_slab && body.colliders.size() == 1 && first.position == glm::dvec3(0) &&
            first.orientation == glm::dquat(1, 0, 0, 0)) {
            // Bodies with the same hull share its shape.
            if (const auto *hull = std::get_if<HullDesc>(&first.shape)) {
                btCollisionShape *&shared = hulls_[hull->points.get()];
                if (shared == nullptr)
                    shared = make(first);
                return shared;
            }
            return make(first);
        }
        auto compound = std::make_unique<btCompoundShape>();
        for (const ColliderDesc &collider : body.colliders) {
            btVector3 position = of(collider.position);
            if (is_slab)
                position -= btVector3(0, slab_depth, 0);
            compound->addChildShape(btTransform(of(collider.orientation), position),
                                    make(collider));
        }
        shapes_.push_back(std::move(compound));
        return shapes_.back().get();
    }

    void add_body(const BodyDesc &desc, const BodyMass &mass) {
        btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass.mass), nullptr,
                                                      shape_of(desc), of(mass.inertia));
        info.m_startWorldTransform = btTransform(of(desc.orientation), of(desc.position));
        const MaterialDesc &material = scene_.material(desc);
        // Bullet multiplies the values of the two bodies in contact.
        info.m_friction = static_cast<btScalar>(std::sqrt(material.friction));
        info.m_restitution = static_cast<btScalar>(std::sqrt(material.restitution));
        auto body = std::make_unique<btRigidBody>(info);
        body->setActivationState(DISABLE_DEACTIVATION);
        if (desc.kind == BodyKind::dynamic) {
            body->setLinearVelocity(of(desc.velocity));
            body->setAngularVelocity(of(desc.angular_velocity));
        } else if (desc.kind == BodyKind::kinematic) {
            body->setCollisionFlags(body->getCollisionFlags() |
                                    btCollisionObject::CF_KINEMATIC_OBJECT);
            driven_.push_back({body.get(), of(desc.velocity), of(desc.angular_velocity)});
        }
        world_.addRigidBody(body.get());
        bodies_.push_back(std::move(body));
    }

    void drive(const Driven &driven) const {
        btTransform next;
        btTransformUtil::integrateTransform(driven.body->getWorldTransform(), driven.velocity,
                                            driven.spin, static_cast<btScalar>(scene_.dt()), next);
        driven.body->setWorldTransform(next);
    }

    btRigidBody &body_of(const std::string &name) {
        return name.empty() ? btTypedConstraint::getFixedBody() : *bodies_[scene_.body(name)];
    }

    void add_joint(const JointDesc &desc) {
        btRigidBody &a = body_of(desc.body_a);
        btRigidBody &b = body_of(desc.body_b);
        std::unique_ptr<btTypedConstraint> joint;
        if (desc.type == JointType::ball) {
            joint = std::make_unique<btPoint2PointConstraint>(a, b, of(desc.anchor_a_local),
                                                              of(desc.anchor_b_local));
        } else if (desc.type == JointType::hinge) {
            const auto axis = [](const glm::dquat &frame) {
                return of(frame * glm::dvec3(1, 0, 0));
            };
            joint = std::make_unique<btHingeConstraint>(
                a, b, of(desc.anchor_a_local), of(desc.anchor_b_local), axis(desc.frame_a_local),
                axis(desc.frame_b_local));
        } else {
            throw std::invalid_argument("one of its joints");
        }
        world_.addConstraint(joint.get(), !desc.collide_connected);
        joints_.push_back(std::move(joint));
    }

    const EngineScene &scene_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    TimedWorld world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::map<const void *, btCollisionShape *> hulls_; // looked up, never iterated over
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
    std::vector<Driven> driven_;
    double collide_share_ = 0;
};

} // namespace

std::unique_ptr<Engine> bullet_engine(const EngineScene &scene) {
    return std::make_unique<BulletEngine>(scene);
}

} // namespace plumb

#endif
