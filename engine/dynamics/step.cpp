// The step, phase by phase.
#include "engine/dynamics/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Adds the time until it goes to a phase, if anybody asks.
class PhaseTimer {
  public:
    explicit PhaseTimer(double *seconds) : seconds_(seconds) {
        if (seconds_ != nullptr)
            start_ = Clock::now();
    }
    ~PhaseTimer() {
        if (seconds_ != nullptr)
            *seconds_ += std::chrono::duration<double>(Clock::now() - start_).count();
    }
    PhaseTimer(const PhaseTimer &) = delete;
    PhaseTimer &operator=(const PhaseTimer &) = delete;

  private:
    using Clock = std::chrono::steady_clock;
    double *seconds_;
    Clock::time_point start_{};
};

} // namespace

// Whether one of the two is moved by the scene, turns, and the other turns with it.
bool World::turn_together(std::uint32_t a, std::uint32_t b) const {
    const Vec3 &spin_a = state_.motions[a].angular_velocity;
    const Vec3 &spin_b = state_.motions[b].angular_velocity;
    const bool is_driven = model_->bodies[a].kind == BodyKind::kinematic ||
                           model_->bodies[b].kind == BodyKind::kinematic;
    return method_->info.looks_ahead && is_driven &&
           glm::dot(spin_a, spin_b) >
               Real(0.5) * std::max(glm::dot(spin_a, spin_a), glm::dot(spin_b, spin_b));
}

// All but the last phase work on scratch: until then the state is as it was. Scratch that a failure
// left half done is thrown away.
void World::step(TaskPool *tasks, StepTimes *times) {
    report_ = StepReport{};
    scratch_.impacts.clear();
    scratch_.surprised.clear();
    scratch_.paces = state_.paces;
    note_still(true);
    // All that there is sleeps, or never moves.
    if (scratch_.awake == 0 && !moves_particles()) {
        report_.joints = model_->alive_joints;
        ++state_.step_count;
        return;
    }
    scratch_.contacts_are_current = false;
    try {
        find_contacts(tasks, times);
        {
            const PhaseTimer timer(times ? &times->advance : nullptr);
            const std::size_t impacts = scratch_.impacts.size();
            const StepReport before = report_;
            load_bodies();
            advance();
            if (began_too_coarsely()) {
                scratch_.impacts.resize(impacts);
                report_.impacts = before.impacts;
                report_.unresolved_impacts = before.unresolved_impacts;
                load_bodies();
                advance();
            }
            constexpr int most_tries = 8;
            for (int tries = 1; tries < most_tries && find_surprises(tasks); ++tries) {
                scratch_.impacts.resize(impacts);
                report_.impacts = before.impacts;
                report_.unresolved_impacts = before.unresolved_impacts;
                load_bodies();
                advance();
            }
            scratch_.surprised.clear();
        }
        {
            const PhaseTimer timer(times ? &times->finish : nullptr);
            gather_memory();
            fall_asleep();
            finish();
        }
    } catch (...) {
        scratch_ = Scratch{};
        throw;
    }
}

// Of all that moves. What that touches and sleeps is woken, and looked at again.
void World::find_contacts(TaskPool *tasks, StepTimes *times) {
    do {
        {
            const PhaseTimer timer(times ? &times->find_pairs : nullptr);
            find_pairs();
        }
        const PhaseTimer timer(times ? &times->collide : nullptr);
        collide(tasks);
        if (model_->has_particles())
            find_particle_contacts(tasks);
    } while (wake_touched(scratch_.contacts));
}

void World::load_bodies() {
    Scratch &s = scratch_;
    s.bodies.resize(state_.motions.size());
    s.moving.clear();
    for (std::uint32_t i = 0; i < s.bodies.size(); ++i) {
        if (s.paces[i].is_asleep()) // nobody asks for it
            continue;
        const Body &body = model_->bodies[i];
        SolverBody &out = s.bodies[i];
        out = SolverBody{};
        static_cast<Motion &>(out) = state_.motions[i];
        if (s.still[i] != 0)
            continue;
        s.moving.push_back(i);
        if (body.kind != BodyKind::dynamic)
            continue;
        out.inv_mass = Vec3{Real(1) / body.mass};
        out.inv_inertia = solver_inverse_inertia(body, out.rotation);
        for (std::size_t axis = 0; axis < 3 && body.has_locks; ++axis)
            if (body.locked[axis]) {
                out.inv_mass[static_cast<int>(axis)] = Real(0);
                out.has_locked_translation = true;
            }
    }
    s.joints = state_.joints;
    s.grab = state_.grab;
    s.world_frame = SolverBody{};
    if (model_->has_particles())
        load_particles();
}

void World::advance() {
    Scratch &s = scratch_;
    choose_substeps();
    for (std::size_t i = 0; i < s.group_count; ++i) {
        StepSettings settings = settings_;
        settings.substeps = s.groups[i].substeps;
        StepContext context{*model_,   settings,    s.bodies,      s.groups[i],        s.contacts,
                            s.joints,  s.grab,      s.world_frame, s.solver,           report_,
                            s.impacts, s.particles, s.torn,        s.particle_contacts};
        const bool has_joints = !s.groups[i].joints.empty();
        if (has_joints)
            std::swap(s.solver.joint_system, s.joint_systems[i]);
        method_->advance(context);
        if (chooses_substeps())
            note_needs(s.groups[i]);
        if (has_joints)
            std::swap(s.solver.joint_system, s.joint_systems[i]);
    }
    if (model_->has_particles())
        end_particles();
    report_.moving_bodies = static_cast<std::uint32_t>(s.awake);
    report_.contact_points = 0;
    report_.joints = model_->alive_joints;
    report_.pairs = static_cast<std::uint32_t>(s.candidates.size());
    report_.contacts = static_cast<std::uint32_t>(s.contacts.size());
    for (const Contact &contact : s.contacts)
        report_.contact_points += static_cast<std::uint32_t>(contact.manifold.count);
    for (const std::uint32_t i : s.moving) {
        const Motion &motion = s.bodies[i];
        const Vec3 linear = motion.position + motion.velocity;
        const Vec3 angular = motion.angular_velocity;
        const Real sum = linear.x + linear.y + linear.z + angular.x + angular.y + angular.z;
        report_.finite = report_.finite && std::isfinite(sum) && !has_diverged(motion);
    }
}

// A contact that bears no load is not remembered. Of a collision within the step nothing is
// remembered of its friction: what stopped the two from sliding then is no load of the next step.
void World::remember(const Contact &contact) {
    Scratch &s = scratch_;
    const auto count = static_cast<std::size_t>(contact.manifold.count);
    const auto impulses = std::span(contact.impulses).first(count);
    if (std::ranges::all_of(impulses, [](const Vec3 &one) { return one == Vec3{Real(0)}; }))
        return;
    s.next_memory.push_back({contact.key, static_cast<std::uint32_t>(s.next_points.size()),
                             static_cast<std::uint32_t>(count), contact.origin});
    const bool is_collision = contact.is_new && contact.moment == Moment::touch;
    for (std::size_t k = 0; k < count; ++k)
        s.next_points.push_back({contact.manifold.points[k].feature,
                                 is_collision ? Vec3{impulses[k].x, Real(0), Real(0)} : impulses[k],
                                 contact.anchors[k].core_a, contact.anchors[k].core_b});
}

// What is remembered of contacts between those that were still stays as it is.
void World::gather_memory() {
    Scratch &s = scratch_;
    s.next_memory.clear();
    s.next_points.clear();
    auto contact = s.contacts.begin();
    for (const ContactMemory &memory : state_.contacts) {
        if (s.still[memory.key.a] == 0 || s.still[memory.key.b] == 0)
            continue;
        for (; contact != s.contacts.end() && contact->key < memory.key; ++contact)
            remember(*contact);
        s.next_memory.push_back(memory);
        s.next_memory.back().first_point = static_cast<std::uint32_t>(s.next_points.size());
        const auto points =
            std::span(state_.points).subspan(memory.first_point, memory.point_count);
        s.next_points.insert(s.next_points.end(), points.begin(), points.end());
    }
    for (; contact != s.contacts.end(); ++contact)
        remember(*contact);
}

// Here nothing can fail any more.
void World::finish() {
    Scratch &s = scratch_;
    for (const std::uint32_t i : s.moving)
        state_.motions[i] = s.bodies[i];
    std::swap(state_.contacts, s.next_memory);
    std::swap(state_.points, s.next_points);
    std::swap(state_.joints, s.joints);
    std::swap(state_.paces, s.paces);
    state_.grab = s.grab;
    if (model_->has_particles()) {
        std::swap(state_.particles, s.particles);
        std::swap(state_.torn, s.torn);
    }
    ++state_.step_count;
    // Those of what slept were not looked for.
    s.contacts_are_current = std::ranges::none_of(state_.paces, &Pace::is_asleep);
}

} // namespace plumb::inline PLUMB_PRECISION
