// The step, phase by phase.
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/contacts/contact_columns.h"
#include "engine/dynamics/world.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A few microseconds of work.
constexpr std::size_t loads_a_part = 256;

// Adds its lifetime to the time of a phase, if anybody asks.
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

// Whether one body is kinematic and spins, and the other turns with it, or would be left far off
// the place where its surface was when the step began.
bool World::is_turned(const Candidate &candidate) const {
    const std::uint32_t a = candidate.key.a;
    const std::uint32_t b = candidate.key.b;
    const bool is_a = model_->bodies[a].kind == BodyKind::kinematic;
    if (!method_->info.looks_ahead || (!is_a && model_->bodies[b].kind != BodyKind::kinematic))
        return false;
    const Vec3 &spin_a = state_.motions[a].angular_velocity;
    const Vec3 &spin_b = state_.motions[b].angular_velocity;
    const Real squared = is_a ? glm::dot(spin_a, spin_a) : glm::dot(spin_b, spin_b);
    if (squared == Real(0))
        return false;
    if (glm::dot(spin_a, spin_b) >
        Real(0.5) * std::max(glm::dot(spin_a, spin_a), glm::dot(spin_b, spin_b)))
        return true;
    // How far a circle leaves its tangent: t^2 / 2 of the radius.
    constexpr Real far = Real(0.02);
    const auto dt = static_cast<Real>(settings_.dt);
    const Collider &turning = model_->colliders[is_a ? candidate.collider_a : candidate.collider_b];
    return Real(0.5) * squared * dt * dt * turning.extent > far * moving_width(candidate) &&
           !is_round_about(turning.shape, glm::conjugate(state_.motions[is_a ? a : b].rotation) *
                                              (is_a ? spin_a : spin_b));
}

// All phases but the last work on scratch, so until then the state is unchanged. Scratch that a
// failure left half done is discarded.
void World::step(TaskPool *tasks, StepTimes *times) {
    report_ = StepReport{};
    scratch_.impacts.clear();
    scratch_.deflected.clear();
    scratch_.paces = state_.paces;
    note_still(true);
    // Everything sleeps or never moves.
    if (scratch_.awake == 0 && !moves_particles()) {
        report_.joints = model_->alive_joints;
        ++state_.clock.step_count;
        return;
    }
    scratch_.contacts_are_current = false;
    const TaskPool::Awake awake(tasks);
    scratch_.tasks = tasks;
    try {
        if (is_each_alone())
            step_each_alone(times);
        else
            step_together(times);
        scratch_.tasks = nullptr;
    } catch (...) {
        scratch_ = Scratch{};
        throw;
    }
}

// Whether nothing can touch, hold or pull a body, and nothing is remembered from before.
bool World::is_each_alone() const {
    return !needs_contacts() && model_->joints.empty() && !model_->has_particles() &&
           !state_.grab.is_holding() && state_.points.empty() && state_.penalties.points.empty();
}

void World::step_each_alone(StepTimes *times) {
    const PhaseTimer timer(times ? &times->advance : nullptr);
    Scratch &s = scratch_;
    s.contacts.clear();
    s.ends.clear();
    s.candidates.clear();
    load_motions();
    group_freely();
    advance_groups();
    note_struck();
    fall_asleep();
    finish_motions();
}

void World::step_together(StepTimes *times) {
    find_contacts(times);
    {
        const PhaseTimer timer(times ? &times->advance : nullptr);
        const std::size_t impacts = scratch_.impacts.size();
        const StepReport before = report_;
        const auto try_step = [&] {
            scratch_.impacts.resize(impacts);
            report_.impacts = before.impacts;
            report_.unresolved_impacts = before.unresolved_impacts;
            report_.finite = before.finite;
            load_bodies();
            advance();
        };
        scratch_.was_let_go = false;
        try_step();
        constexpr int most_refinements = 2;
        for (int i = 0; i < most_refinements && went_too_coarsely(); ++i) {
            scratch_.was_let_go = scratch_.was_let_go || was_any_let_go();
            // Those of the coarse try are several times too large for finer substeps: a pile of
            // balls would burst. Shared out among them they still make it slide.
            recall_impulses();
            try_step(); // with the substeps that the first try's loads ask for
        }
        constexpr int most_tries = 8;
        // More do not help: a coin that falls flat would be thrown up.
        constexpr int most_missed = 3;
        constexpr int most_missed_of_solids = 2;
        int missed = 0;
        const auto must_try_again = [&] {
            if (find_contacts_of_deflected())
                return true;
            ++missed;
            return missed <= most_missed && find_missed_points(missed <= most_missed_of_solids);
        };
        for (int tries = 1; tries < most_tries && must_try_again(); ++tries) {
            recall_impulses();
            try_step();
        }
        scratch_.deflected.clear();
    }
    const PhaseTimer timer(times ? &times->finish : nullptr);
    note_struck();
    record_landings();
    gather_memory();
    gather_penalties();
    fall_asleep();
    finish();
}

// Finds the contacts of all moving bodies. Sleeping bodies that they touch are woken, and the
// search is repeated.
void World::find_contacts(StepTimes *times) {
    do {
        {
            const PhaseTimer timer(times ? &times->find_pairs : nullptr);
            find_pairs();
        }
        const PhaseTimer timer(times ? &times->collide : nullptr);
        collide();
        if (model_->has_particles())
            find_particle_contacts();
    } while (wake_touched(scratch_.contacts));
    report_.pairs = static_cast<std::uint32_t>(scratch_.candidates.size());
}

void World::load_body(std::size_t i) {
    Scratch &s = scratch_;
    if (s.paces[i].is_asleep()) // not read in this step
        return;
    const Body &body = model_->bodies[i];
    SolverBody &out = s.bodies[i];
    out = SolverBody{};
    s.solver.rounded_off[i] = {};
    static_cast<Motion &>(out) = state_.motions[i];
    if (s.still[i] != 0 || body.kind != BodyKind::dynamic)
        return;
    out.inv_mass = Vec3{Real(1) / body.mass};
    out.inv_inertia = solver_inverse_inertia(body, out.rotation);
    out.has_locks = body.has_locks;
    for (std::size_t axis = 0; axis < 3 && body.has_locks; ++axis)
        if (body.locked[axis]) {
            out.inv_mass[static_cast<int>(axis)] = Real(0);
            out.has_locked_translation = true;
        }
}

void World::load_motions() {
    Scratch &s = scratch_;
    s.bodies.resize(state_.motions.size());
    s.solver.rounded_off.resize(s.bodies.size());
    s.moving.clear();
    for (std::uint32_t i = 0; i < s.bodies.size(); ++i)
        if (!s.paces[i].is_asleep() && s.still[i] == 0)
            s.moving.push_back(i);
    for_parts(s.tasks, s.bodies.size(), loads_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            load_body(i);
    });
}

void World::load_bodies() {
    load_motions();
    Scratch &s = scratch_;
    s.joints = state_.joints;
    s.grab = state_.grab;
    s.world_frame = SolverBody{};
    if (model_->has_particles())
        load_particles();
    load_penalties();
}

// Whether both bodies, or the one that moves, have been struck for so long that they carry loads,
// which ask for far more than the least substeps. What rolls on corners is struck all the time,
// too.
bool World::is_pressed(const ContactKey &key) const {
    const auto is_struck = [&](std::uint32_t body) {
        const Pace &pace = state_.paces[body];
        return model_->bodies[body].kind != BodyKind::dynamic ||
               (pace.wanted >= far_more_substeps * settings_.substeps &&
                pace.struck * settings_.dt >= pressed_after);
    };
    return is_struck(key.a) && is_struck(key.b);
}

// Before a try of the step: forgets what the last one found of the contacts, and notes their ends.
void World::begin_contacts() {
    Scratch &s = scratch_;
    s.ends.resize(s.contacts.size());
    for_parts(s.tasks, s.ends.size(), contacts_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Contact &contact = s.contacts[i];
            contact.is_struck = false;
            contact.is_pressed = is_pressed(contact.key);
            s.ends[i] = {contact.key.a, contact.key.b,
                         static_cast<std::uint8_t>(contact.manifold.count), contact.sensor,
                         contact.turns()};
        }
    });
}

void World::advance() {
    begin_contacts();
    choose_substeps();
    advance_groups();
}

void World::advance_groups() {
    Scratch &s = scratch_;
    std::size_t joint_systems = 0; // counted so that the same joints keep theirs, whatever settles
    for (std::size_t i = 0; i < s.group_count; ++i) {
        std::optional<StepSettings> own;
        if (s.groups[i].pace.substeps != settings_.substeps) {
            own = settings_;
            own->substeps = s.groups[i].pace.substeps;
        }
        StepContext context{*model_,
                            own ? *own : settings_,
                            s.bodies,
                            state_.motions,
                            s.groups[i],
                            s.contacts,
                            s.joints,
                            s.grab,
                            s.world_frame,
                            s.solver,
                            report_,
                            s.impacts,
                            s.particles,
                            s.torn,
                            s.particle_contacts,
                            s.ends,
                            s.point_penalties,
                            s.joint_penalties,
                            s.tasks};
        s.solver.joint_system =
            s.groups[i].joints.empty() ? &s.no_joints : &s.joint_systems[joint_systems++];
        method_->advance(context);
        if (chooses_substeps())
            note_needs(s.groups[i]);
    }
    if (model_->has_particles())
        end_particles();
    report_.moving_bodies = static_cast<std::uint32_t>(s.awake);
    report_.contact_points = 0;
    report_.joints = model_->alive_joints;
    report_.contacts = static_cast<std::uint32_t>(s.contacts.size());
    for (const ContactEnds &contact : s.ends)
        report_.contact_points += contact.points;
    for (const std::uint32_t i : s.moving) {
        const Motion &motion = s.bodies[i];
        const Vec3 linear = motion.position + motion.velocity;
        const Vec3 angular = motion.angular_velocity;
        const Real sum = linear.x + linear.y + linear.z + angular.x + angular.y + angular.z;
        report_.finite = report_.finite && std::isfinite(sum) && !has_diverged(motion);
    }
}

// For how many steps bodies have been struck.
void World::note_struck() {
    Scratch &s = scratch_;
    for (const std::uint32_t i : s.moving)
        s.paces[i].struck = 0;
    for (const Contact &contact : s.contacts)
        for (const std::uint32_t body : {contact.key.a, contact.key.b})
            if (contact.is_struck && moves(body)) {
                constexpr std::uint16_t most = std::numeric_limits<std::uint16_t>::max();
                const std::uint16_t before = state_.paces[body].struck;
                s.paces[body].struck =
                    before < most ? static_cast<std::uint16_t>(before + 1) : most;
            }
}

// Contacts without load are not remembered.
std::uint32_t World::remembered_points(const Contact &contact) const {
    const auto count = static_cast<std::size_t>(contact.manifold.count);
    const auto is_zero = [](const Vec3 &impulse) { return impulse == Vec3{Real(0)}; };
    return std::ranges::all_of(std::span(contact.impulses).first(count), is_zero)
               ? 0
               : static_cast<std::uint32_t>(count);
}

// The friction of a collision within the step is not remembered: what stopped the sliding then is
// no load of the next step.
void World::remember(const Contact &contact, ContactMemory &memory) {
    memory.key = contact.key;
    memory.origin = contact.origin;
    const bool is_collision = contact.is_new && contact.found_at == FoundAt::touch;
    for (std::size_t k = 0; k < memory.point_count; ++k) {
        const Vec3 &impulse = contact.impulses[k];
        scratch_.next_points[memory.first_point + k] = {
            contact.manifold.points[k].feature,
            is_collision ? Vec3{impulse.x, Real(0), Real(0)} : impulse, contact.anchors[k].core_a,
            contact.anchors[k].core_b};
    }
}

namespace {

// Expresses a normal that turned, and impulses along tangents that turned with it, in the manifold
// that the next step will find there. Only when no try of the step is left: they all begin with the
// normal of its start.
void express_anew(Contact &contact, const Quat &turn) {
    const TangentBasis before = tangent_basis(contact.manifold.normal);
    contact.manifold.normal = turn * contact.manifold.normal;
    const Vec3 t1 = turn * before.t1;
    const Vec3 t2 = glm::cross(contact.manifold.normal, t1);
    const TangentBasis now = tangent_basis(contact.manifold.normal);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        Vec3 &impulse = contact.impulses[k];
        const Vec3 friction = impulse.y * t1 + impulse.z * t2;
        impulse.y = glm::dot(friction, now.t1);
        impulse.z = glm::dot(friction, now.t2);
    }
}

} // namespace

// The memory of contacts between still bodies stays as it is.
void World::gather_memory() {
    Scratch &s = scratch_;
    const std::size_t count = s.contacts.size();
    if (count == 0 && state_.contacts.empty()) {
        s.next_memory.clear();
        s.next_points.clear();
        s.kept_memory.clear();
        return;
    }
    s.remembered.resize(count);
    for_parts(s.tasks, count, contacts_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Contact &contact = s.contacts[i];
            if (contact.turns() && !contact.sensor) {
                const Motion &a = s.bodies[contact.key.a];
                const Motion &b = s.bodies[contact.key.b];
                express_anew(contact, contact.turn(a.rotation, b.rotation,
                                                   contact.line_between_cores(a, b)));
            }
            s.remembered[i] = remembered_points(contact);
        }
    });

    // Their places, ascending by key.
    constexpr std::uint32_t nowhere = UINT32_MAX;
    s.next_memory.clear();
    s.kept_memory.clear();
    std::uint32_t points = 0;
    const auto place = [&](std::uint32_t point_count) {
        ContactMemory &memory = s.next_memory.emplace_back();
        memory.first_point = std::exchange(points, points + point_count);
        memory.point_count = point_count;
    };
    std::size_t next = 0;
    const auto place_contact = [&] {
        const std::uint32_t point_count = s.remembered[next];
        s.remembered[next] =
            point_count > 0 ? static_cast<std::uint32_t>(s.next_memory.size()) : nowhere;
        if (point_count > 0)
            place(point_count);
        ++next;
    };
    for (std::uint32_t i = 0; i < state_.contacts.size(); ++i) {
        const ContactMemory &memory = state_.contacts[i];
        if (s.still[memory.key.a] == 0 || s.still[memory.key.b] == 0)
            continue;
        while (next < count && s.contacts[next].key < memory.key)
            place_contact();
        s.kept_memory.emplace_back(i, static_cast<std::uint32_t>(s.next_memory.size()));
        place(memory.point_count);
    }
    while (next < count)
        place_contact();

    s.next_points.resize(points);
    for_parts(s.tasks, count, contacts_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (s.remembered[i] != nowhere)
                remember(s.contacts[i], s.next_memory[s.remembered[i]]);
    });
    for (const auto &[from, to] : s.kept_memory) {
        const ContactMemory &before = state_.contacts[from];
        ContactMemory &memory = s.next_memory[to];
        memory.key = before.key;
        memory.origin = before.origin;
        std::ranges::copy(std::span(state_.points).subspan(before.first_point, before.point_count),
                          s.next_points.begin() + memory.first_point);
    }
}

// Nothing can fail from here on.
void World::finish_motions() {
    Scratch &s = scratch_;
    for (const std::uint32_t i : s.moving)
        state_.motions[i] = s.bodies[i];
    std::swap(state_.paces, s.paces);
    ++state_.clock.step_count;
    // Contacts of sleeping bodies were not looked for.
    s.contacts_are_current = std::ranges::none_of(state_.paces, &Pace::is_asleep);
}

void World::finish() {
    Scratch &s = scratch_;
    std::swap(state_.contacts, s.next_memory);
    std::swap(state_.points, s.next_points);
    std::swap(state_.joints, s.joints);
    std::swap(state_.penalties.points, s.next_penalties);
    std::swap(state_.penalties.joints, s.joint_penalties);
    state_.grab = s.grab;
    if (model_->has_particles()) {
        std::swap(state_.particles, s.particles);
        std::swap(state_.torn, s.torn);
    }
    finish_motions();
}

} // namespace plumb::inline PLUMB_PRECISION
