// A scene as a running World of one precision, and back.
#include "engine/scene/real/world_simulation.h"

#include "engine/core/check.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/mass.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Shape make_shape(const ShapeDesc &desc) {
    struct Maker {
        Shape operator()(const SphereDesc &s) const {
            return Sphere{Vec3{Real(0)}, static_cast<Real>(s.radius)};
        }
        Shape operator()(const BoxDesc &b) const {
            return Box{Vec3{Real(0)}, identity_rotation, Vec3{b.half_extents}};
        }
        Shape operator()(const CapsuleDesc &c) const {
            const auto half = static_cast<Real>(c.half_height);
            return Capsule{Vec3{0, -half, 0}, Vec3{0, half, 0}, static_cast<Real>(c.radius)};
        }
        Shape operator()(const PlaneDesc &) const {
            return HalfSpace{Vec3{Real(0), Real(1), Real(0)}, Real(0)};
        }
        Shape operator()(const CylinderDesc &) const { cannot("cylinders"); }
        Shape operator()(const HullDesc &) const { cannot("hulls"); }
        Shape operator()(const MeshDesc &) const { cannot("meshes"); }
        Shape operator()(const HeightFieldDesc &) const { cannot("height fields"); }
        [[noreturn]] static void cannot(const char *what) {
            throw std::invalid_argument(std::string(what) + " cannot be bodies yet");
        }
    };
    return std::visit(Maker{}, desc);
}

// The one shape of a body without anything that a world cannot run yet.
Shape make_shape(const BodyDesc &body) {
    const auto refuse = [&](bool has, const char *what) {
        if (has)
            throw std::invalid_argument("the body \"" + body.name + "\" has " + what +
                                        ", which cannot be run yet");
    };
    refuse(body.colliders.size() != 1, "several shapes");
    const ColliderDesc &collider = body.colliders.front();
    refuse(collider.position != glm::dvec3(0) || collider.orientation != glm::dquat(1, 0, 0, 0),
           "a shape with a place of its own");
    refuse(!collider.material.empty() || collider.density, "a shape with a material of its own");
    refuse(collider.filter.layer != 0 || collider.filter.ignores != 0, "a layer");
    refuse(collider.sensor, "a sensor");
    refuse(body.center_of_mass || body.inertia || body.mass_pose, "a centre of mass or inertia");
    refuse(body.locked != std::array<bool, 6>{}, "locked axes");
    refuse(body.gravity_scale != 1 || body.linear_damping != 0 || body.angular_damping != 0,
           "a gravity scale or damping");
    return make_shape(collider.shape);
}

class WorldSimulation final : public Simulation {
  public:
    WorldSimulation(const SceneDesc &scene, const ResolvedRun &run, TaskPool *tasks)
        : tasks_(tasks),
          precision_(run.precision), state_{World{run.method->name, run.settings}, scene, {}, {}} {
        state_.scene.bodies.clear();
        state_.scene.joints.clear();
        for (const BodyDesc &body : scene.bodies)
            insert(body);
        for (const JointDesc &joint : scene.joints)
            insert(joint);
        for (const ContactStateDesc &contact : scene.contacts)
            remember(contact);
        state_.world.set_step_count(scene.step_count);
    }

    void step() override { state_.world.step(tasks_); }
    std::uint64_t step_count() const override { return state_.world.step_count(); }
    double time() const override { return state_.world.time(); }
    const StepReport &report() const override { return state_.world.report(); }
    Measures measure() const override { return state_.world.measure(); }
    std::uint64_t hash() const override { return state_.world.hash(); }

    const MethodInfo &method() const override {
        return *find_method_info(state_.world.method().info.name);
    }
    const StepSettings &settings() const override { return state_.world.settings(); }
    Precision precision() const override { return precision_; }

    void set_method(std::string_view name) override {
        const MethodInfo *info = find_method_info(name);
        if (info == nullptr)
            throw std::invalid_argument("no method is called '" + std::string(name) + "'");
        if (const std::string reason = why_not(*info, describe()); !reason.empty())
            throw std::invalid_argument(reason);
        state_.world.set_method(name);
    }
    void set_settings(const StepSettings &settings) override {
        try {
            state_.world.set_settings(settings);
        } catch (const CheckFailure &failure) {
            throw std::invalid_argument(failure.what());
        }
    }

    std::unique_ptr<Saved> save() const override { return std::make_unique<SavedState>(state_); }
    void restore(const Saved &saved) override {
        const auto *state = dynamic_cast<const SavedState *>(&saved);
        PLUMB_CHECK(state != nullptr, "the saved state belongs to another kind of simulation");
        state_ = state->state;
    }

    SceneDesc describe() const override;

    std::size_t body_count() const override { return state_.infos.size(); }
    const BodyInfo &body_info(std::size_t body) const override { return state_.infos.at(body); }
    BodyState body_state(std::size_t body) const override {
        const Motion &m = state_.world.motions().at(body);
        return {glm::dvec3{m.position}, glm::dquat{m.rotation}, glm::dvec3{m.velocity},
                glm::dvec3{m.angular_velocity}};
    }
    std::optional<std::size_t> find_body(std::string_view name) const override {
        const auto found = state_.index_of.find(name);
        return found == state_.index_of.end() ? std::nullopt : std::optional{found->second};
    }

    std::vector<ContactView> contacts() const override;
    std::vector<JointView> joints() const override;
    std::vector<BoundsView> bounds() const override;

    std::optional<Pick> pick(const glm::dvec3 &origin, const glm::dvec3 &direction) const override {
        const auto hit = state_.world.raycast(Ray{Vec3{origin}, Vec3{direction}});
        if (!hit)
            return std::nullopt;
        return Pick{hit->body.index, static_cast<double>(hit->hit.t), glm::dvec3{hit->hit.point},
                    glm::dvec3{hit->hit.normal}};
    }
    void apply_impulse(std::size_t body, const glm::dvec3 &impulse,
                       const glm::dvec3 &point) override {
        state_.world.apply_impulse(id_of(body), Vec3{impulse}, Vec3{point});
    }
    void pull(std::size_t body, const glm::dvec3 &local_point, const glm::dvec3 &target) override;
    std::size_t add_body(const BodyDesc &body) override {
        if (!state_.world.method().info.contacts)
            throw std::invalid_argument(std::string(state_.world.method().info.name) +
                                        " knows no contacts, so no body can be added");
        BodyDesc named = body;
        for (int number = 2; state_.index_of.contains(named.name); ++number)
            named.name = body.name + "_" + std::to_string(number);
        return insert(named);
    }
    void remove_body(std::size_t body) override {
        state_.world.remove_body(id_of(body));
        state_.index_of.erase(state_.infos[body].name);
        state_.infos[body].alive = false;
    }

  private:
    // What save() copies: the world, and what files know of it beyond that.
    struct State {
        World world;
        SceneDesc scene; // bodies by index, holes left as they were; joints by index
        std::vector<BodyInfo> infos;
        std::map<std::string, std::size_t, std::less<>> index_of;
    };
    struct SavedState final : Saved {
        explicit SavedState(State s) : state(std::move(s)) {}
        State state;
    };

    BodyId id_of(std::size_t body) const {
        PLUMB_CHECK(body < state_.infos.size() && state_.infos[body].alive,
                    "body " << body << " is not alive");
        return state_.world.body_id(static_cast<std::uint32_t>(body));
    }
    BodyId id_of(const std::string &name) const {
        return name.empty() ? BodyId{} : id_of(state_.index_of.at(name));
    }
    std::size_t insert(const BodyDesc &desc);
    void insert(const JointDesc &desc);
    void remember(const ContactStateDesc &desc);

    TaskPool *tasks_;
    Precision precision_;
    State state_;
};

std::size_t WorldSimulation::insert(const BodyDesc &desc) {
    static const MaterialDesc default_material;
    const auto &materials = state_.scene.materials;
    const auto named = std::ranges::find(materials, desc.material, &MaterialDesc::name);
    const MaterialDesc &material =
        desc.material.empty() || named == materials.end() ? default_material : *named;

    BodyDef def;
    def.kind = desc.kind;
    def.shape = make_shape(desc);
    if (desc.kind == BodyKind::dynamic)
        def.mass = desc.mass || desc.density
                       ? static_cast<Real>(mass_of(state_.scene, desc))
                       : static_cast<Real>(material.density) * volume(def.shape);
    def.material = {static_cast<Real>(material.friction), static_cast<Real>(material.restitution)};
    def.pose = {Vec3{desc.position}, unit(Quat{desc.orientation})};
    def.velocity = Vec3{desc.velocity};
    def.angular_velocity = Vec3{desc.angular_velocity};
    const std::size_t index = state_.world.add_body(def).index;

    const Body &body = state_.world.bodies()[index];
    BodyInfo info;
    info.alive = true;
    info.name = desc.name;
    info.kind = desc.kind;
    info.colliders = desc.colliders;
    info.mass = body.mass;
    info.inertia = glm::dvec3{body.inertia};
    info.material = desc.material;
    info.colour = desc.colour ? desc.colour : material.colour;
    state_.infos.resize(std::max(state_.infos.size(), index + 1));
    state_.scene.bodies.resize(state_.infos.size());
    state_.infos[index] = info;
    state_.scene.bodies[index] = desc;
    state_.index_of[desc.name] = index;
    return index;
}

// What the world cannot run yet is refused, by its name.
void check_runnable(const JointDesc &joint) {
    const bool is_rod = joint.type == JointType::distance && joint.min_length == joint.max_length;
    const char *what = joint.type != JointType::ball && !is_rod ? "of its type"
                       : joint.frequency > 0                    ? "that are springs"
                       : joint.break_force > 0 || joint.broken  ? "that break"
                                                                : nullptr;
    if (what != nullptr)
        throw std::invalid_argument("joint \"" + joint.name + "\": joints " + what +
                                    " cannot be run yet, only ball joints and rods");
}

void WorldSimulation::insert(const JointDesc &desc) {
    check_runnable(desc);
    JointDef def;
    def.type = desc.type;
    def.a = id_of(desc.body_a);
    def.b = id_of(desc.body_b);
    def.anchor_a_local = Vec3{desc.anchor_a_local};
    def.anchor_b_local = Vec3{desc.anchor_b_local};
    def.length = static_cast<Real>(desc.max_length);
    def.collide_connected = desc.collide_connected;
    def.impulse = Vec3{glm::dvec3{desc.impulses[0], desc.impulses[1], desc.impulses[2]}};
    state_.world.add_joint(def);
    state_.scene.joints.push_back(desc);
}

void WorldSimulation::remember(const ContactStateDesc &desc) {
    std::vector<std::uint32_t> features;
    std::vector<Vec3> impulses;
    for (const ContactStateDesc::Point &point : desc.points) {
        features.push_back(point.feature);
        impulses.emplace_back(point.impulse);
    }
    state_.world.remember_contact(id_of(desc.body_a), id_of(desc.body_b), features, impulses);
}

SceneDesc WorldSimulation::describe() const {
    const World &world = state_.world;
    SceneDesc out = state_.scene;
    out.bodies.clear();
    out.joints.clear();
    out.contacts.clear();
    out.step_count = world.step_count();
    out.world.gravity = world.settings().gravity;
    out.world.dt = world.settings().dt;
    const std::string method(world.method().info.name);
    if (method != out.world.method) { // the scene's own becomes one of the others
        out.world.other_methods[out.world.method] = out.world.settings;
        out.world.other_methods.erase(method);
    }
    out.world.method = method;
    out.world.settings = {world.settings().substeps, world.settings().iterations};
    std::erase_if(out.expects, [this](const ExpectDesc &expect) {
        return !expect.body.empty() && !state_.index_of.contains(expect.body);
    });
    out.world.precision = precision_;
    for (std::size_t i = 0; i < state_.infos.size(); ++i) {
        if (!state_.infos[i].alive)
            continue;
        BodyDesc body = state_.scene.bodies[i];
        const BodyState now = body_state(i);
        body.position = now.position;
        body.orientation = now.orientation;
        body.velocity = now.velocity;
        body.angular_velocity = now.angular_velocity;
        out.bodies.push_back(std::move(body));
    }
    for (std::size_t i = 0; i < world.joints().size(); ++i) {
        if (!world.joints()[i].alive)
            continue;
        JointDesc joint = state_.scene.joints[i];
        const glm::dvec3 impulse{world.joints()[i].impulse};
        joint.impulses = {impulse.x, impulse.y, impulse.z};
        out.joints.push_back(std::move(joint));
    }
    for (const Contact &contact : world.contacts()) {
        ContactStateDesc state{state_.infos[contact.a].name, state_.infos[contact.b].name, {}};
        for (int k = 0; k < contact.manifold.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            if (contact.impulses[index] != Vec3{Real(0)})
                state.points.push_back(
                    {contact.manifold.points[index].feature, glm::dvec3{contact.impulses[index]}});
        }
        if (!state.points.empty())
            out.contacts.push_back(std::move(state));
    }
    return out;
}

std::vector<ContactView> WorldSimulation::contacts() const {
    const World &world = state_.world;
    const double rate = world.settings().substeps / world.settings().dt;
    std::vector<ContactView> views;
    for (const Contact &contact : world.contacts()) {
        if (contact.manifold.normal == Vec3{Real(0)})
            continue; // remembered from a file; where it is, the next step finds
        const TangentBasis basis = tangent_basis(contact.manifold.normal);
        for (int k = 0; k < contact.manifold.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const ManifoldPoint &point = contact.manifold.points[index];
            const Vec3 &impulse = contact.impulses[index];
            views.push_back({contact.a, contact.b, glm::dvec3{point.position},
                             glm::dvec3{contact.manifold.normal},
                             static_cast<double>(point.separation),
                             static_cast<double>(impulse.x) * rate,
                             rate * glm::dvec3{impulse.y * basis.t1 + impulse.z * basis.t2}});
        }
    }
    return views;
}

std::vector<JointView> WorldSimulation::joints() const {
    const World &world = state_.world;
    const double rate = world.settings().substeps / world.settings().dt;
    std::vector<JointView> views;
    for (std::size_t i = 0; i < world.joints().size(); ++i) {
        const Joint &joint = world.joints()[i];
        if (!joint.alive)
            continue;
        const JointDesc &desc = state_.scene.joints[i];
        JointView view;
        view.name = desc.name;
        view.type = joint.type;
        if (joint.a != Joint::world)
            view.body_a = joint.a;
        if (joint.b != Joint::world)
            view.body_b = joint.b;
        view.anchor_a = glm::dvec3{world.anchor_a(joint)};
        view.anchor_b = glm::dvec3{world.anchor_b(joint)};
        view.drift = static_cast<double>(world.joint_drift(joint));
        const glm::dvec3 impulse{joint.impulse};
        if (joint.type == JointType::distance) {
            const glm::dvec3 way = view.anchor_b - view.anchor_a;
            view.position = glm::length(way);
            view.limits = {desc.min_length, desc.max_length};
            view.force = view.position > 0 ? impulse.x * rate / view.position * way : view.force;
        } else {
            view.force = rate * impulse;
        }
        views.push_back(view);
    }
    return views;
}

std::vector<BoundsView> WorldSimulation::bounds() const {
    std::vector<BoundsView> views;
    for (std::size_t i = 0; i < state_.infos.size(); ++i) {
        const Body &body = state_.world.bodies()[i];
        if (!body.alive || std::holds_alternative<HalfSpace>(body.shape))
            continue;
        const Motion &motion = state_.world.motions()[i];
        if (has_diverged(motion))
            continue;
        const Aabb box =
            plumb::bounds(placed(body.shape, Transform{motion.position, motion.rotation}));
        views.push_back({glm::dvec3{box.min}, glm::dvec3{box.max}});
    }
    return views;
}

// A critically damped spring of 4 Hz between a body's point and the target, as an impulse ahead of
// the step, with the implicit damping that keeps any dt stable (Catto 2011, "Soft Constraints").
void WorldSimulation::pull(std::size_t body, const glm::dvec3 &local_point,
                           const glm::dvec3 &target) {
    const BodyId id = id_of(body);
    const Motion &motion = state_.world.motions()[body];
    if (motion.inv_mass == Real(0))
        return;
    const double omega = 2.0 * std::numbers::pi * 4.0;
    const double h = state_.world.settings().dt;
    const glm::dvec3 r = glm::dquat{motion.rotation} * local_point;
    const glm::dvec3 point = glm::dvec3{motion.position} + r;
    const glm::dvec3 velocity = glm::dvec3{motion.velocity_at(Vec3{r})};
    const double mass = state_.infos[body].mass;
    const glm::dvec3 wanted = (velocity + h * omega * omega * (target - point)) /
                              (1.0 + 2.0 * h * omega + h * h * omega * omega);
    // Aim at the velocity that the spring would have after h; half of the mass, since turning the
    // body takes part of the impulse.
    const glm::dvec3 weight = -mass * h * state_.world.settings().gravity;
    state_.world.apply_impulse(id, Vec3{0.5 * mass * (wanted - velocity) + weight}, Vec3{point});
}

} // namespace

std::unique_ptr<Simulation> make_world_simulation(const SceneDesc &scene, const ResolvedRun &run,
                                                  TaskPool *tasks) {
    return std::make_unique<WorldSimulation>(scene, run, tasks);
}

} // namespace plumb::inline PLUMB_PRECISION
