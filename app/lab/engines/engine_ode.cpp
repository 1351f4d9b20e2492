// ODE at its defaults: quick step, twenty iterations unless told otherwise, one thread.
#include "app/lab/engines/engine.h"

#ifdef PLUMB_WITH_ODE

#include "app/lab/clocks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ode/ode.h>

namespace plumb {

namespace {

// Initialises ODE on the first call; seeds it on every call.
void initialise() {
    static const bool done = dInitODE2(0) != 0;
    (void)done;
    dRandSetSeed(0); // it orders its constraints randomly
}

dReal real(double x) {
    return static_cast<dReal>(x);
}
void set(dQuaternion out, const glm::dquat &q) {
    out[0] = real(q.w);
    out[1] = real(q.x);
    out[2] = real(q.y);
    out[3] = real(q.z);
}
glm::dvec3 vector(const dReal *v) {
    return {v[0], v[1], v[2]};
}

// ODE's capsules and cylinders lie along z.
const glm::dquat y_to_z(std::sqrt(0.5), -std::sqrt(0.5), 0, 0);

struct GeomMaker {
    dSpaceID space;

    dGeomID operator()(const SphereDesc &sphere) const {
        return dCreateSphere(space, real(sphere.radius));
    }
    dGeomID operator()(const BoxDesc &box) const {
        const glm::dvec3 side = 2.0 * box.half_extents;
        return dCreateBox(space, real(side.x), real(side.y), real(side.z));
    }
    dGeomID operator()(const CapsuleDesc &capsule) const {
        return dCreateCapsule(space, real(capsule.radius), real(2 * capsule.half_height));
    }
    dGeomID operator()(const CylinderDesc &cylinder) const {
        return dCreateCylinder(space, real(cylinder.radius), real(2 * cylinder.half_height));
    }
    template <typename Other> dGeomID operator()(const Other &) const { return nullptr; }
};

class OdeEngine final : public Engine {
  public:
    explicit OdeEngine(const EngineScene &scene)
        : scene_(scene), world_(dWorldCreate()), space_(dHashSpaceCreate(nullptr)),
          contacts_(dJointGroupCreate(0)) {
        const glm::dvec3 &g = scene.gravity();
        dWorldSetGravity(world_, real(g.x), real(g.y), real(g.z));
        if (scene.iterations() > 0)
            dWorldSetQuickStepNumIterations(world_, scene.iterations());
        for (std::size_t i = 0; i < scene.desc.bodies.size(); ++i)
            add_body(i);
        for (const JointDesc &joint : scene.desc.joints)
            add_joint(joint);
    }
    ~OdeEngine() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    // No hulls: ODE's manual does not vouch for their contacts.
    static bool can_run(const SceneDesc &scene) {
        const auto known = [](const ColliderDesc &collider) {
            return std::holds_alternative<PlaneDesc>(collider.shape) ||
                   std::holds_alternative<SphereDesc>(collider.shape) ||
                   std::holds_alternative<BoxDesc>(collider.shape) ||
                   std::holds_alternative<CapsuleDesc>(collider.shape) ||
                   std::holds_alternative<CylinderDesc>(collider.shape);
        };
        return std::ranges::all_of(scene.bodies,
                                   [&](const BodyDesc &body) {
                                       return std::ranges::all_of(body.colliders, known);
                                   }) &&
               std::ranges::all_of(scene.joints, [](const JointDesc &joint) {
                   return joint.type == JointType::ball || joint.type == JointType::hinge;
               });
    }

    void step() override {
        const double begin = thread_cpu_time();
        dJointGroupEmpty(contacts_);
        touching_ = 0;
        dSpaceCollide(space_, this, [](void *self, dGeomID a, dGeomID b) {
            static_cast<OdeEngine *>(self)->collide(a, b);
        });
        const double collided = thread_cpu_time();
        dWorldQuickStep(world_, real(scene_.dt()));
        collide_share_ = (collided - begin) / (thread_cpu_time() - begin);
    }

    void put(const std::vector<BodyState> &states) override {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            dBodyID body = bodies_[i];
            if (body == nullptr || dBodyIsKinematic(body) != 0)
                continue;
            const BodyState &state = states[i];
            const glm::dvec3 &p = state.position, &v = state.velocity, &w = state.angular_velocity;
            dQuaternion turn;
            set(turn, state.orientation);
            dBodySetPosition(body, real(p.x), real(p.y), real(p.z));
            dBodySetQuaternion(body, turn);
            dBodySetLinearVel(body, real(v.x), real(v.y), real(v.z));
            dBodySetAngularVel(body, real(w.x), real(w.y), real(w.z));
        }
    }

    StepWork work() const override {
        return {collide_share_, touching_,
                (touching_ + scene_.desc.joints.size()) *
                    static_cast<std::size_t>(dWorldGetQuickStepNumIterations(world_))};
    }

    std::vector<BodyState> states() const override {
        std::vector<BodyState> states;
        for (std::size_t body = 0; body < bodies_.size(); ++body)
            states.push_back(state(body));
        return states;
    }

  private:
    BodyState state(std::size_t body) const {
        const BodyDesc &desc = scene_.desc.bodies[body];
        dBodyID id = bodies_[body];
        if (id == nullptr)
            return {desc.position, desc.orientation};
        const dReal *q = dBodyGetQuaternion(id);
        return {vector(dBodyGetPosition(id)), glm::dquat(q[0], q[1], q[2], q[3]),
                vector(dBodyGetLinearVel(id)), vector(dBodyGetAngularVel(id))};
    }

    static constexpr int most_points = 8;

    void add_body(std::size_t index) {
        const BodyDesc &desc = scene_.desc.bodies[index];
        const BodyMass &mass = scene_.masses[index];
        dBodyID body = nullptr;
        if (desc.kind != BodyKind::static_body) {
            body = dBodyCreate(world_);
            dQuaternion turn;
            set(turn, desc.orientation);
            dBodySetPosition(body, real(desc.position.x), real(desc.position.y),
                             real(desc.position.z));
            dBodySetQuaternion(body, turn);
            if (desc.kind == BodyKind::kinematic) {
                dBodySetKinematic(body);
            } else {
                dMass of_body;
                const glm::dvec3 &i = mass.inertia;
                dMassSetParameters(&of_body, real(mass.mass), 0, 0, 0, real(i.x), real(i.y),
                                   real(i.z), 0, 0, 0);
                dBodySetMass(body, &of_body);
            }
            const glm::dvec3 &v = desc.velocity, &w = desc.angular_velocity;
            dBodySetLinearVel(body, real(v.x), real(v.y), real(v.z));
            dBodySetAngularVel(body, real(w.x), real(w.y), real(w.z));
        }
        bodies_.push_back(body);
        for (const ColliderDesc &collider : desc.colliders)
            add_geom(body, desc, collider);
    }

    void add_geom(dBodyID body, const BodyDesc &desc, const ColliderDesc &collider) {
        if (std::holds_alternative<PlaneDesc>(collider.shape)) {
            const glm::dvec3 normal = desc.orientation * glm::dvec3(0, 1, 0);
            dGeomSetData(dCreatePlane(space_, real(normal.x), real(normal.y), real(normal.z),
                                      real(glm::dot(normal, desc.position))),
                         const_cast<MaterialDesc *>(&scene_.material(desc)));
            return;
        }
        dGeomID geom = std::visit(GeomMaker{space_}, collider.shape);
        dGeomSetData(geom, const_cast<MaterialDesc *>(&scene_.material(desc)));
        const bool along_y = std::holds_alternative<CapsuleDesc>(collider.shape) ||
                             std::holds_alternative<CylinderDesc>(collider.shape);
        const glm::dquat local = along_y ? collider.orientation * y_to_z : collider.orientation;
        dQuaternion turn;
        const glm::dvec3 &p = collider.position;
        if (body != nullptr) {
            dGeomSetBody(geom, body);
            set(turn, local);
            dGeomSetOffsetPosition(geom, real(p.x), real(p.y), real(p.z));
            dGeomSetOffsetQuaternion(geom, turn);
        } else {
            const glm::dvec3 at = desc.position + desc.orientation * p;
            set(turn, desc.orientation * local);
            dGeomSetPosition(geom, real(at.x), real(at.y), real(at.z));
            dGeomSetQuaternion(geom, turn);
        }
    }

    void add_joint(const JointDesc &desc) {
        dBodyID a = desc.body_a.empty() ? nullptr : bodies_[scene_.body(desc.body_a)];
        dBodyID b = desc.body_b.empty() ? nullptr : bodies_[scene_.body(desc.body_b)];
        const bool of_b = b != nullptr;
        const BodyDesc *body =
            of_b || a != nullptr
                ? &scene_.desc.bodies[scene_.body(of_b ? desc.body_b : desc.body_a)]
                : nullptr;
        const glm::dvec3 &local = of_b ? desc.anchor_b_local : desc.anchor_a_local;
        const glm::dvec3 at = body->position + body->orientation * local;
        if (desc.type == JointType::ball) {
            dJointID joint = dJointCreateBall(world_, nullptr);
            dJointAttach(joint, a, b);
            dJointSetBallAnchor(joint, real(at.x), real(at.y), real(at.z));
        } else {
            dJointID joint = dJointCreateHinge(world_, nullptr);
            dJointAttach(joint, a, b);
            dJointSetHingeAnchor(joint, real(at.x), real(at.y), real(at.z));
            const glm::dquat &frame = of_b ? desc.frame_b_local : desc.frame_a_local;
            const glm::dvec3 axis = body->orientation * (frame * glm::dvec3(1, 0, 0));
            dJointSetHingeAxis(joint, real(axis.x), real(axis.y), real(axis.z));
        }
    }

    void collide(dGeomID geom_a, dGeomID geom_b) {
        dBodyID a = dGeomGetBody(geom_a), b = dGeomGetBody(geom_b);
        const auto moves = [](dBodyID body) {
            return body != nullptr && dBodyIsKinematic(body) == 0;
        };
        if ((!moves(a) && !moves(b)) ||
            (a != nullptr && b != nullptr && dAreConnectedExcluding(a, b, dJointTypeContact) != 0))
            return;
        std::array<dContact, most_points> points{};
        const int count = dCollide(geom_a, geom_b, most_points, &points[0].geom,
                                   static_cast<int>(sizeof(dContact)));
        touching_ += count > 0 ? 1U : 0U;
        const auto *of_a = static_cast<const MaterialDesc *>(dGeomGetData(geom_a));
        const auto *of_b = static_cast<const MaterialDesc *>(dGeomGetData(geom_b));
        for (int i = 0; i < count; ++i) {
            dSurfaceParameters &surface = points[static_cast<std::size_t>(i)].surface;
            surface.mode = dContactApprox1;
            surface.mu = real(std::sqrt(of_a->friction * of_b->friction));
            surface.bounce = real(std::max(of_a->restitution, of_b->restitution));
            if (surface.bounce > 0)
                surface.mode |= dContactBounce;
            dJointAttach(
                dJointCreateContact(world_, contacts_, &points[static_cast<std::size_t>(i)]), a, b);
        }
    }

    const EngineScene &scene_;
    dWorldID world_;
    dSpaceID space_;
    dJointGroupID contacts_;
    std::vector<dBodyID> bodies_; // null: static
    std::size_t touching_ = 0;
    double collide_share_ = 0;
};

} // namespace

std::unique_ptr<Engine> ode_engine(const EngineScene &scene) {
    initialise();
    if (!OdeEngine::can_run(scene.desc))
        return nullptr;
    return std::make_unique<OdeEngine>(scene);
}

} // namespace plumb

#endif
