// A scene as a running World of one precision, and back.
#include "engine/scene/real/world_simulation.h"

#include "engine/core/check.h"
#include "engine/dynamics/world.h"
#include "engine/math/basis.h"
#include "engine/scene/expect.h"
#include "engine/scene/joint_type.h"
#include "engine/scene/real/body_def.h"
#include "engine/scene/real/read_world.h"
#include "engine/scene/recording.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Scene data that the world itself does not hold; shared by saves until an edit.
struct Book {
    SceneDesc scene; // bodies by index, holes keep their old value; joints by index
    std::vector<BodyInfo> infos;
    std::map<std::string, std::size_t, std::less<>> index_of;
};

// Past steps used the scene's own dt; a different dt counts from here on.
StateClock clock_of(const SceneDesc &scene, const ResolvedRun &run) {
    const StateClock own{scene.step_count, scene.dt_since_time, scene.dt_since_step};
    const double dt = settings_of(scene.world, *run.method).dt;
    if (run.settings.dt == dt)
        return own;
    const auto steps = static_cast<double>(own.step_count - own.steps_before);
    return {own.step_count, own.time_before + steps * dt, own.step_count};
}

// Converts a vector from a contact normal's tangent basis to the other body's view: negated, in the
// opposite normal's tangent basis.
Vec2 along_opposite_tangents(const Vec3 &normal, Real along_1, Real along_2) {
    const TangentBasis tangents = tangent_basis(normal);
    const TangentBasis opposite = tangent_basis(-normal);
    const Vec3 there = -(along_1 * tangents.t1 + along_2 * tangents.t2);
    return {glm::dot(there, opposite.t1), glm::dot(there, opposite.t2)};
}

class WorldSimulation final : public Simulation {
  public:
    WorldSimulation(const SceneDesc &scene, const ResolvedRun &run, TaskPool *tasks)
        : tasks_(tasks), precision_(run.precision), world_(run.method->name, run.settings),
          book_(std::make_shared<Book>()), soft_(scene) {
        book_->scene = scene;
        book_->scene.bodies.clear();
        book_->scene.joints.clear();
        book_->scene.contacts.clear();
        book_->scene.grab.reset();
        for (const BodyDesc &body : scene.bodies)
            insert(body);
        for (const JointDesc &joint : scene.joints)
            insert(joint);
        for (const AttractorDesc &attractor : scene.attractors)
            world_.add_attractor(
                {Vec3{attractor.position}, static_cast<Real>(attractor.gravitational_parameter)});
        for (const ParticleInfo &particle : soft_.particles)
            insert(particle);
        for (const SpringInfo &spring : soft_.springs)
            insert(spring);
        for (const ContactStateDesc &contact : scene.contacts)
            remember(contact);
        for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
            const BodyDesc::Pace &pace = scene.bodies[i].pace;
            world_.set_pace(world_.body_id(i), {static_cast<std::uint16_t>(pace.substeps),
                                                static_cast<std::uint16_t>(pace.wanted),
                                                static_cast<std::uint16_t>(pace.rested),
                                                static_cast<std::uint16_t>(pace.struck)});
        }
        world_.set_clock(clock_of(scene, run));
        if (scene.grab)
            hold(*scene.grab);
    }

    void step(StepTimes *times) override { world_.step(tasks_, times); }
    std::uint64_t step_count() const override { return world_.step_count(); }
    double time() const override { return world_.time(); }
    const StepReport &report() const override { return world_.report(); }
    Measures measure() const override { return world_.measure(); }
    double energy() const override { return world_.energy(); }
    std::uint64_t hash() const override { return world_.hash(); }

    const MethodInfo &method() const override {
        return *find_method_info(world_.method().info.name);
    }
    const StepSettings &settings() const override { return world_.settings(); }
    Precision precision() const override { return precision_; }

    void apply(const Command &command) override {
        check_readable(command, book_->scene.materials);
        try {
            std::visit([this](const auto &one) { obey(one); }, command);
        } catch (const CheckFailure &failure) {
            throw std::invalid_argument(failure.what());
        }
    }

    std::unique_ptr<Saved> save(std::unique_ptr<Saved> reuse, const Saved *before) const override {
        auto *old = dynamic_cast<SavedState *>(reuse.get());
        if (old == nullptr) {
            reuse = std::make_unique<SavedState>();
            old = static_cast<SavedState *>(reuse.get());
        }
        const auto *earlier = dynamic_cast<const SavedState *>(before);
        world_.save(old->world, earlier != nullptr ? &earlier->world : nullptr);
        old->book = book_;
        return reuse;
    }
    void restore(const Saved &saved) override {
        const auto *state = dynamic_cast<const SavedState *>(&saved);
        PLUMB_CHECK(state != nullptr, "the saved state belongs to another kind of simulation");
        world_.restore(state->world);
        book_ = state->book;
    }

    SceneDesc describe() const override;

    std::size_t body_count() const override { return book_->infos.size(); }
    const BodyInfo &body_info(std::size_t body) const override { return book_->infos.at(body); }
    std::optional<std::size_t> find_body(std::string_view name) const override {
        const auto found = book_->index_of.find(name);
        return found == book_->index_of.end() ? std::nullopt : std::optional{found->second};
    }

    const std::string &joint_name(std::size_t joint) const override {
        return book_->scene.joints.at(joint).name;
    }
    std::size_t joint_count() const override { return world_.joints().size(); }
    const JointDesc *joint(std::size_t joint) const override {
        return world_.joints()[joint].alive ? &book_->scene.joints[joint] : nullptr;
    }
    const SoftParts &soft_parts() const override { return soft_; }
    std::span<const AttractorDesc> attractors() const override { return book_->scene.attractors; }
    void read(Frame &into, const FrameParts &parts) const override {
        read_world(world_, book_->scene.joints, into, parts);
    }

    std::optional<Pick> pick(const glm::dvec3 &origin, const glm::dvec3 &direction) const override {
        const auto hit = world_.raycast(Ray{Vec3{origin}, Vec3{direction}});
        if (!hit)
            return std::nullopt;
        return Pick{hit->body.index, static_cast<double>(hit->hit.t), glm::dvec3{hit->hit.point},
                    glm::dvec3{hit->hit.normal}};
    }

  private:
    struct SavedState final : Saved {
        std::size_t bytes_beside(const Saved *other) const override {
            const auto *saved = dynamic_cast<const SavedState *>(other);
            return world.bytes_beside(saved != nullptr ? &saved->world : nullptr);
        }
        SavedWorld world;
        std::shared_ptr<Book> book;
    };

    void obey(const AddBody &command);
    void obey(const RemoveBody &command);
    void obey(const AddJoint &command);
    void obey(const RemoveJoint &command);
    void obey(const SetMotion &command);
    void obey(const ApplyImpulse &command);
    void obey(const GrabBody &command);
    void obey(const GrabParticle &command);
    void obey(const MoveGrab &command) { world_.move_grab(Vec3{command.target}); }
    void obey(const ReleaseGrab &) { world_.release(); }
    void obey(const SetMethod &command);
    void obey(const SetSettings &command);

    // The book for writing; copied first if saves share it.
    Book &edit() {
        if (book_.use_count() > 1)
            book_ = std::make_shared<Book>(*book_);
        return *book_;
    }

    BodyId id_of(std::size_t body) const {
        PLUMB_CHECK(body < book_->infos.size() && book_->infos[body].alive,
                    "body " << body << " is not alive");
        return world_.body_id(static_cast<std::uint32_t>(body));
    }
    BodyId id_of(const std::string &name) const {
        return name.empty() ? BodyId{} : id_of(book_->index_of.at(name));
    }
    // Throws std::invalid_argument if there is no such body.
    std::size_t index_of(const std::string &name) const;
    void insert(const BodyDesc &desc);
    void insert(const JointDesc &desc);
    void insert(const ParticleInfo &info);
    void insert(const SpringInfo &info);
    void remember(const ContactStateDesc &desc);
    std::optional<GrabView> grab() const override;
    void hold(const GrabStateDesc &desc);
    void describe_grab(SceneDesc &out) const;
    void describe_soft_parts(SceneDesc &out) const;

    TaskPool *tasks_;
    Precision precision_;
    World world_;
    std::shared_ptr<Book> book_;
    const SoftParts soft_; // of the start
};

void WorldSimulation::obey(const AddBody &command) {
    if (!world_.method().info.contacts)
        throw std::invalid_argument(std::string(world_.method().info.name) +
                                    " does not support contacts, so no body can be added");
    if (book_->index_of.contains(command.body.name))
        throw std::invalid_argument("there is already a body \"" + command.body.name + '"');
    if (soft_.has_name(command.body.name))
        throw std::invalid_argument("a particle or cloth is already called \"" + command.body.name +
                                    '"');
    insert(command.body);
}

void WorldSimulation::obey(const RemoveBody &command) {
    const std::size_t body = index_of(command.body);
    world_.remove_body(id_of(body));
    Book &book = edit();
    book.index_of.erase(command.body);
    book.infos[body].alive = false;
}

void WorldSimulation::obey(const AddJoint &command) {
    const JointDesc &joint = command.joint;
    if (!world_.method().info.joints)
        throw std::invalid_argument(std::string(world_.method().info.name) +
                                    " does not support joints, so none can be added");
    if (find_joint(joint.name))
        throw std::invalid_argument("there is already a joint \"" + joint.name + '"');
    for (const std::string &body : {joint.body_a, joint.body_b})
        if (!body.empty())
            (void)index_of(body);
    insert(joint);
}

void WorldSimulation::obey(const RemoveJoint &command) {
    const std::optional<std::size_t> joint = find_joint(command.joint);
    if (!joint)
        throw std::invalid_argument("there is no joint \"" + command.joint + '"');
    world_.remove_joint(world_.joint_id(static_cast<std::uint32_t>(*joint)));
}

void WorldSimulation::obey(const SetMotion &command) {
    world_.set_motion(id_of(index_of(command.body)),
                      {Vec3{command.position}, unit(Quat{command.orientation})},
                      Vec3{command.velocity}, Vec3{command.angular_velocity});
}

void WorldSimulation::obey(const ApplyImpulse &command) {
    world_.apply_impulse(id_of(index_of(command.body)), Vec3{command.impulse}, Vec3{command.point});
}

void WorldSimulation::obey(const GrabBody &command) {
    world_.grab(id_of(index_of(command.body)), Vec3{command.point}, Vec3{command.target},
                static_cast<Real>(command.max_force), command.spring);
}

void WorldSimulation::obey(const GrabParticle &command) {
    const std::optional<std::size_t> particle = soft_.find_particle(command.particle);
    if (!particle)
        throw std::invalid_argument("there is no particle \"" + command.particle + '"');
    world_.grab_particle(static_cast<std::uint32_t>(*particle), Vec3{command.target},
                         static_cast<Real>(command.max_force), command.spring);
}

void WorldSimulation::obey(const SetMethod &command) {
    const MethodInfo *info = find_method_info(command.method);
    if (info == nullptr)
        throw std::invalid_argument("there is no method '" + command.method + "'");
    if (const std::string reason = why_not(*info, describe()); !reason.empty())
        throw std::invalid_argument(reason);
    world_.set_method(command.method);
}

void WorldSimulation::obey(const SetSettings &command) {
    StepSettings settings = world_.settings();
    command.settings.apply_to(settings);
    world_.set_settings(settings);
}

std::size_t WorldSimulation::index_of(const std::string &name) const {
    const auto found = book_->index_of.find(name);
    if (found == book_->index_of.end())
        throw std::invalid_argument("there is no body \"" + name + '"');
    return found->second;
}

void WorldSimulation::insert(const BodyDesc &desc) {
    const std::size_t index = world_.add_body(body_def(book_->scene, desc)).index;
    const Body &body = world_.bodies()[index];
    BodyInfo info;
    info.alive = true;
    info.name = desc.name;
    info.kind = desc.kind;
    info.colliders = desc.colliders;
    info.mass = static_cast<double>(body.mass);
    info.inertia = glm::dvec3{body.inertia};
    info.axes = glm::dquat{body.mass_frame.rotation};
    info.force = glm::dvec3{body.force};
    info.torque = glm::dvec3{body.torque};
    info.material = desc.material;
    info.colour = desc.colour ? desc.colour : material_of(book_->scene, desc.material).colour;
    Book &book = edit();
    book.infos.resize(std::max(book.infos.size(), index + 1));
    book.scene.bodies.resize(book.infos.size());
    book.infos[index] = info;
    book.scene.bodies[index] = desc;
    book.index_of[desc.name] = index;
}

void WorldSimulation::insert(const JointDesc &given) {
    const JointDesc desc = as_read(given);
    JointDef def;
    def.type = desc.type;
    def.a = id_of(desc.body_a);
    def.b = id_of(desc.body_b);
    def.anchor_a_local = Vec3{desc.anchor_a_local};
    def.anchor_b_local = Vec3{desc.anchor_b_local};
    def.frame_a_local = unit(Quat{desc.frame_a_local});
    def.frame_b_local = unit(Quat{desc.frame_b_local});
    def.min_length = static_cast<Real>(desc.min_length);
    def.max_length = static_cast<Real>(desc.max_length);
    if (desc.limits)
        def.limits = {static_cast<Real>((*desc.limits)[0]), static_cast<Real>((*desc.limits)[1])};
    if (desc.motor_speed)
        def.motor = {static_cast<Real>(*desc.motor_speed), static_cast<Real>(desc.max_motor_force)};
    def.frequency = static_cast<Real>(desc.frequency);
    def.damping_ratio = static_cast<Real>(desc.damping_ratio);
    def.break_force = static_cast<Real>(desc.break_force);
    def.collide_connected = desc.collide_connected;
    for (std::size_t i = 0; i < joint_row_count; ++i) {
        def.memory.impulses[i] = static_cast<Real>(desc.impulses[i]);
        def.penalty[i] = static_cast<Real>(desc.penalties[i]);
    }
    def.memory.broken = desc.broken;
    const std::size_t index = world_.add_joint(def).index;
    std::vector<JointDesc> &joints = edit().scene.joints;
    joints.resize(std::max(joints.size(), index + 1));
    joints[index] = desc;
}

void WorldSimulation::insert(const ParticleInfo &info) {
    const MaterialDesc &material = material_of(book_->scene, info.material);
    ParticleDef def;
    def.position = Vec3{info.start.position};
    def.velocity = Vec3{info.start.velocity};
    def.mass = static_cast<Real>(info.mass);
    def.radius = static_cast<Real>(info.radius);
    def.pinned = info.pinned;
    def.material = {static_cast<Real>(material.friction), static_cast<Real>(material.restitution)};
    world_.add_particle(def);
}

void WorldSimulation::insert(const SpringInfo &info) {
    const auto end_of = [](const SpringEndInfo &end) {
        SpringEnd made;
        switch (end.kind) {
        case SpringEndInfo::Kind::world:
            made.kind = SpringEnd::Kind::world;
            break;
        case SpringEndInfo::Kind::particle:
            made.kind = SpringEnd::Kind::particle;
            break;
        case SpringEndInfo::Kind::body:
            made.kind = SpringEnd::Kind::body;
            break;
        }
        made.index = static_cast<std::uint32_t>(end.index);
        made.anchor = Vec3{end.anchor_local};
        return made;
    };
    SpringDef def;
    def.a = end_of(info.a);
    def.b = end_of(info.b);
    def.rest_length = static_cast<Real>(info.rest_length);
    def.stiffness = static_cast<Real>(info.stiffness);
    def.damping = static_cast<Real>(info.damping);
    def.tear_strain = static_cast<Real>(info.tear_strain);
    def.torn = info.torn;
    world_.add_spring(def);
}

void WorldSimulation::remember(const ContactStateDesc &desc) {
    std::vector<PointMemory> points;
    std::vector<PointPenalty> penalties;
    for (const ContactStateDesc::Point &point : desc.points) {
        points.push_back(
            {point.feature, Vec3{point.impulse}, Vec3{point.core_a}, Vec3{point.core_b}});
        const glm::dvec4 penalty{point.penalty[0], point.penalty[1], point.penalty[2],
                                 point.penalty[3]};
        if (penalty != glm::dvec4{0})
            penalties.resize(points.size());
        if (!penalties.empty()) {
            penalties.resize(points.size());
            penalties.back() = {static_cast<Real>(penalty.x),
                                static_cast<Real>(penalty.y),
                                {static_cast<Real>(penalty.z), static_cast<Real>(penalty.w)}};
        }
    }
    ContactKey key{id_of(desc.body_a).index, id_of(desc.body_b).index,
                   static_cast<std::uint16_t>(desc.child_a),
                   static_cast<std::uint16_t>(desc.child_b),
                   desc.triangle.value_or(ContactKey::no_triangle)};
    ContactOrigin origin{Vec3{desc.normal}, Vec3{desc.offset}, Quat{desc.rotation_a},
                         Quat{desc.rotation_b}};
    if (key.a > key.b) {
        std::swap(key.a, key.b);
        std::swap(key.child_a, key.child_b);
        origin = {-origin.normal, -origin.offset, origin.rotation_b, origin.rotation_a};
        const auto turned = [&](Real along_1, Real along_2) {
            return along_opposite_tangents(Vec3{desc.normal}, along_1, along_2);
        };
        for (PointMemory &point : points) {
            std::swap(point.core_a, point.core_b);
            const Vec2 friction = turned(point.impulse.y, point.impulse.z);
            point.impulse = {point.impulse.x, friction.x, friction.y};
        }
        for (PointPenalty &penalty : penalties)
            penalty.slip = turned(penalty.slip.x, penalty.slip.y);
    }
    world_.remember_contact(key, origin, points, penalties);
}

void WorldSimulation::hold(const GrabStateDesc &desc) {
    Grab grab;
    if (!desc.body.empty())
        grab.body = id_of(desc.body).index;
    if (const std::optional<std::size_t> particle = soft_.find_particle(desc.particle))
        grab.particle = static_cast<std::uint32_t>(*particle);
    grab.point_local = Vec3{desc.point_local};
    grab.target = Vec3{desc.target};
    grab.max_force = static_cast<Real>(desc.max_force);
    grab.frequency = static_cast<Real>(desc.frequency);
    grab.damping_ratio = static_cast<Real>(desc.damping_ratio);
    grab.impulse = Vec3{desc.impulse};
    grab.held_mass = static_cast<Real>(desc.held_mass);
    world_.hold(grab);
}

std::optional<GrabView> WorldSimulation::grab() const {
    const Grab &grab = world_.state().grab;
    if (!grab.is_holding() && !grab.holds_particle())
        return {};
    GrabView view;
    view.target = glm::dvec3{grab.target};
    view.max_force = static_cast<double>(grab.max_force);
    if (grab.is_holding()) {
        view.body = grab.body;
        view.local_point =
            glm::dvec3{to_world_point(world_.bodies()[grab.body].mass_frame, grab.point_local)};
    } else {
        view.particle = grab.particle;
    }
    return view;
}

void WorldSimulation::describe_grab(SceneDesc &out) const {
    const Grab &grab = world_.state().grab;
    if (!grab.is_holding() && !grab.holds_particle())
        return;
    GrabStateDesc &desc = out.grab.emplace();
    if (grab.is_holding())
        desc.body = book_->infos[grab.body].name;
    else
        desc.particle = soft_.particle_name(grab.particle);
    desc.point_local = glm::dvec3{grab.point_local};
    desc.target = glm::dvec3{grab.target};
    desc.max_force = static_cast<double>(grab.max_force);
    desc.frequency = static_cast<double>(grab.frequency);
    desc.damping_ratio = static_cast<double>(grab.damping_ratio);
    desc.impulse = glm::dvec3{grab.impulse};
    desc.held_mass = static_cast<double>(grab.held_mass);
}

SceneDesc WorldSimulation::describe() const {
    const World &world = world_;
    SceneDesc out = book_->scene;
    out.bodies.clear();
    out.joints.clear();
    out.contacts.clear();
    out.step_count = world.step_count();
    out.dt_since_step = world.state().clock.steps_before;
    out.dt_since_time = world.state().clock.time_before;
    describe_grab(out);
    set_run(out.world, method(), world.settings());
    std::erase_if(out.expects, [this](const ExpectDesc &expect) {
        const QuantityInfo &quantity = *find_quantity(expect.quantity);
        return (quantity.needs_body() && !book_->index_of.contains(expect.body) &&
                !soft_.find_particle(expect.body)) ||
               (quantity.needs_joint() && !find_joint(expect.body));
    });
    out.world.precision = precision_;
    for (std::uint32_t i = 0; i < book_->infos.size(); ++i) {
        if (!book_->infos[i].alive)
            continue;
        BodyDesc body = book_->scene.bodies[i];
        const BodyState now = body_state(world_, i);
        if (world.bodies()[i].has_mass_frame) {
            const Motion &motion = world.motions()[i];
            body.mass_pose = {glm::dvec3{motion.position}, glm::dquat{motion.rotation}};
        }
        const Pace &pace = world.state().paces[i];
        body.pace = {pace.substeps, pace.wanted, pace.rested, pace.struck};
        body.position = now.position;
        body.orientation = now.orientation;
        body.velocity = now.velocity;
        body.angular_velocity = now.angular_velocity;
        out.bodies.push_back(std::move(body));
    }
    for (std::size_t i = 0; i < world.joints().size(); ++i) {
        if (!world.joints()[i].alive)
            continue;
        JointDesc joint = book_->scene.joints[i];
        const JointMemory &memory = world.state().joints[i];
        for (std::size_t row = 0; row < joint_row_count; ++row)
            joint.impulses[row] = static_cast<double>(memory.impulses[row]);
        const std::vector<JointPenalty> &penalties = world.state().penalties.joints;
        for (std::size_t row = 0; row < joint_row_count && i < penalties.size(); ++row)
            joint.penalties[row] = static_cast<double>(penalties[i][row]);
        joint.broken = memory.broken;
        out.joints.push_back(std::move(joint));
    }
    for (const ContactMemory &memory : world.state().contacts) {
        ContactStateDesc state;
        state.body_a = book_->infos[memory.key.a].name;
        state.body_b = book_->infos[memory.key.b].name;
        state.child_a = memory.key.child_a;
        state.child_b = memory.key.child_b;
        state.normal = glm::dvec3{memory.origin.normal};
        state.offset = glm::dvec3{memory.origin.offset};
        state.rotation_a = glm::dquat{memory.origin.rotation_a};
        state.rotation_b = glm::dquat{memory.origin.rotation_b};
        if (memory.key.triangle != ContactKey::no_triangle)
            state.triangle = memory.key.triangle;
        for (std::uint32_t k = 0; k < memory.point_count; ++k) {
            const PointMemory &point = world.state().points[memory.first_point + k];
            ContactStateDesc::Point &out_point = state.points.emplace_back(
                ContactStateDesc::Point{point.feature, glm::dvec3{point.impulse},
                                        glm::dvec3{point.core_a}, glm::dvec3{point.core_b}});
            if (!world.state().penalties.points.empty()) {
                const PointPenalty &penalty =
                    world.state().penalties.points[memory.first_point + k];
                out_point.penalty = {
                    static_cast<double>(penalty.normal), static_cast<double>(penalty.tangential),
                    static_cast<double>(penalty.slip.x), static_cast<double>(penalty.slip.y)};
            }
        }
        out.contacts.push_back(std::move(state));
    }
    describe_soft_parts(out);
    return out;
}

void WorldSimulation::describe_soft_parts(SceneDesc &out) const {
    const State &state = world_.state();
    const auto state_of = [&](std::size_t particle) {
        const ParticleMotion &motion = state.particles[particle];
        return ParticleState{glm::dvec3{motion.position}, glm::dvec3{motion.velocity}};
    };
    for (std::size_t i = 0; i < out.particles.size(); ++i) {
        const ParticleState now = state_of(i);
        out.particles[i].position = now.position;
        out.particles[i].velocity = now.velocity;
    }
    for (std::size_t c = 0; c < out.cloths.size(); ++c) {
        ClothDesc &cloth = out.cloths[c];
        const ClothInfo &info = soft_.cloths[c];
        cloth.particles.clear();
        for (std::size_t i = 0; i < info.particle_count; ++i)
            cloth.particles.push_back(state_of(info.first_particle + i));
        cloth.torn.clear();
        for (std::uint32_t i = 0; i < info.spring_count; ++i)
            if (state.torn[info.first_spring + i] != 0)
                cloth.torn.push_back(i);
    }
    for (std::size_t i = 0; i < out.springs.size(); ++i)
        out.springs[i].torn = state.torn[i] != 0;
    // Drop the springs of removed bodies.
    std::erase_if(out.springs, [&](const SpringDesc &spring) {
        const auto is_there = [&](const std::string &end) {
            return end.empty() || book_->index_of.contains(end) || soft_.find_particle(end);
        };
        return !is_there(spring.a) || !is_there(spring.b);
    });
    std::erase_if(out.expects, [&](const ExpectDesc &expect) {
        return find_quantity(expect.quantity)->needs_spring() &&
               std::ranges::find(out.springs, expect.body, &SpringDesc::name) == out.springs.end();
    });
}

} // namespace

std::unique_ptr<Simulation> make_world_simulation(const SceneDesc &scene, const ResolvedRun &run,
                                                  TaskPool *tasks) {
    return std::make_unique<WorldSimulation>(scene, run, tasks);
}

} // namespace plumb::inline PLUMB_PRECISION
