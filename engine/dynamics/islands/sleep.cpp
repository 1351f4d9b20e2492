// Sleep: islands at rest are not stepped until something touches, moves or leaves them.
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A body is at rest if it moves less in sleep_after than substep_tolerance of its width, and no
// faster than rest_speed or than the rounding of positions makes it. Without gravity a body that
// drifts is never at rest.
constexpr double roundings = 2; // per substep

double rest_time(const StepSettings &settings) {
    constexpr double where_nothing_sleeps = 0.5; // s
    return settings.sleep_after > 0 ? settings.sleep_after : where_nothing_sleeps;
}

// How far a place moves at least when it does, as its coordinates are rounded (m).
double rounding_at(const Vec3 &position) {
    const Vec3 place = glm::abs(position);
    return static_cast<double>(std::numeric_limits<Real>::epsilon() *
                               std::max({place.x, place.y, place.z}));
}

bool is_zero(const Vec3 &v) {
    return v == Vec3{Real(0)};
}

} // namespace

double rest_speed(double pull, double dt) {
    constexpr double share = 4e-3, usual_dt = 1.0 / 60;
    return share * pull * std::max(dt, usual_dt);
}

bool World::sleeps() const {
    return settings_.sleep_after > 0 &&
           std::ranges::find(method_->info.reads, SettingGroup::sleep) != method_->info.reads.end();
}

// Notes which bodies do not move in this step. `asleep`: whether sleeping ones are among them.
void World::note_still(bool asleep) const {
    Scratch &s = scratch_;
    s.still.resize(model_->bodies.size());
    s.awake = 0;
    for (std::size_t i = 0; i < s.still.size(); ++i) {
        const Body &body = model_->bodies[i];
        const Motion &motion = state_.motions[i];
        bool moves = body.alive;
        if (body.kind == BodyKind::static_body)
            moves = false;
        else if (body.kind == BodyKind::kinematic)
            moves = moves && !(is_zero(motion.velocity) && is_zero(motion.angular_velocity));
        else
            moves = moves && !(asleep && s.paces[i].is_asleep());
        s.still[i] = moves ? 0 : 1;
        s.awake += moves ? 1 : 0;
    }
}

// Joins sleeping bodies that touch or share a joint.
void World::find_sleeping_islands(const std::vector<Pace> &paces) const {
    Islands &islands = scratch_.islands;
    islands.start(model_->bodies.size());
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (a != Joint::world && b != Joint::world && paces[a].is_asleep() && paces[b].is_asleep())
            islands.join(a, b);
    };
    for (const ContactMemory &memory : state_.contacts)
        join(memory.key.a, memory.key.b);
    for (std::size_t i = 0; i < model_->joints.size(); ++i)
        if (model_->joints[i].alive && !state_.joints[i].broken)
            join(model_->joints[i].a, model_->joints[i].b);
}

// Wakes the islands of the marked bodies.
void World::wake_marked(std::vector<Pace> &paces) const {
    Scratch &s = scratch_;
    find_sleeping_islands(paces);
    for (std::uint32_t i = 0; i < paces.size(); ++i)
        if (s.marked[i] != 0)
            s.marked[s.islands.root_of(i)] = 1;
    for (std::uint32_t i = 0; i < paces.size(); ++i)
        if (paces[i].is_asleep() && s.marked[s.islands.root_of(i)] != 0)
            paces[i].rested = 0;
}

// Whether a moving body touches a sleeping one; that one is then awake in this step.
bool World::wake_touched(const std::vector<Contact> &contacts) {
    Scratch &s = scratch_;
    const auto wakes = [&](const Contact &contact) {
        return !contact.sensor &&
               (s.paces[contact.key.a].is_asleep() || s.paces[contact.key.b].is_asleep());
    };
    const bool by_particles = model_->has_particles() && mark_touched_by_particles();
    if (!by_particles && std::ranges::none_of(contacts, wakes))
        return false;
    if (!by_particles)
        s.marked.assign(s.paces.size(), 0);
    for (const Contact &contact : contacts)
        if (wakes(contact))
            s.marked[contact.key.a] = s.marked[contact.key.b] = 1;
    wake_marked(s.paces);
    note_still(true);
    return true;
}

// Between steps: wakes a body, and the bodies that touch it or hang on it by a joint or spring.
void World::wake(std::uint32_t body) {
    scratch_.contacts_are_current = false;
    if (std::ranges::none_of(state_.paces, &Pace::is_asleep))
        return;
    std::vector<std::uint8_t> &marked = scratch_.marked;
    marked.assign(state_.paces.size(), 0);
    marked[body] = 1;
    for (const ContactMemory &memory : state_.contacts)
        if (memory.key.a == body || memory.key.b == body)
            marked[memory.key.a] = marked[memory.key.b] = 1;
    for (const Joint &joint : model_->joints)
        for (const auto &[one, other] : {std::pair{joint.a, joint.b}, std::pair{joint.b, joint.a}})
            if (joint.alive && one == body && other != Joint::world)
                marked[other] = 1;
    const auto is_body = [](const SpringEnd &end) { return end.kind == SpringEnd::Kind::body; };
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        const auto &[a, b] = std::pair{model_->springs[i].a, model_->springs[i].b};
        if (state_.torn[i] == 0 && is_body(a) && is_body(b) && (a.index == body || b.index == body))
            marked[a.index] = marked[b.index] = 1;
    }
    wake_marked(state_.paces);
}

void World::wake_all() {
    scratch_.contacts_are_current = false;
    for (Pace &pace : state_.paces)
        pace.rested = 0;
}

// How many steps at rest are enough to sleep; where nothing sleeps, to be left alone by
// settle_slow_islands.
std::uint16_t World::steps_to_sleep() const {
    const double steps = std::ceil(rest_time(settings_) / settings_.dt);
    return static_cast<std::uint16_t>(std::clamp(steps, 1.0, Pace::asleep - 1.0));
}

// Whether a body moves too little to see, after a try of the step.
bool World::is_at_rest(std::uint32_t index) const {
    const Body &body = model_->bodies[index];
    const Motion &motion = scratch_.bodies[index];
    const double rounding = rounding_at(motion.position);
    const double substep = settings_.dt / std::max<int>(scratch_.paces[index].substeps, 1);
    const double pull = glm::length(glm::dvec3{pull_on(index)});
    const double slow =
        pull > 0 ? std::max(rest_speed(pull, settings_.dt), roundings * rounding / substep) : 0;
    if (static_cast<double>(glm::dot(motion.velocity, motion.velocity)) > 2 * slow * slow)
        return false;      // far from it, as most moving bodies are
    Real extent = Real(0); // round bodies too: a spin that cannot be seen is still kept
    for (std::uint32_t c = 0; c < body.collider_count; ++c) {
        const Collider &collider = model_->colliders[body.first_collider + c];
        extent = std::max(extent, collider.extent + collider.rounding);
    }
    const double width = 2 * static_cast<double>(least_half_width(body));
    const auto limit = static_cast<Real>(
        std::min(settings_.substep_tolerance * width / rest_time(settings_), slow));
    return glm::length(motion.velocity) + extent * glm::length(motion.angular_velocity) <= limit;
}

// Whether a spring's damper still holds its ends so far from where the spring would, as a body at
// rest may move: they approach that place ever more slowly.
bool World::is_giving_way(const Spring &spring) const {
    const auto is_body = [](const SpringEnd &end) { return end.kind == SpringEnd::Kind::body; };
    if (spring.damping == Real(0) || !(is_body(spring.a) || is_body(spring.b)))
        return false;
    const SpringPoint a = spring_point(spring.a, scratch_.bodies, scratch_.particles);
    const SpringPoint b = spring_point(spring.b, scratch_.bodies, scratch_.particles);
    const Vec3 line = b.position - a.position;
    const double length = glm::length(line);
    const double speed = std::abs(glm::dot(b.velocity - a.velocity, line));
    bool any = false;
    for (const SpringEnd &end : {spring.a, spring.b}) {
        if (!is_body(end))
            continue;
        const double width = 2 * static_cast<double>(least_half_width(model_->bodies[end.index]));
        any = any || (spring.damping * speed >
                          spring.stiffness * settings_.substep_tolerance * width * length &&
                      speed * settings_.dt >
                          0.5 * rounding_at(scratch_.bodies[end.index].position) * length);
    }
    return any;
}

void World::mark_giving_way() {
    Scratch &s = scratch_;
    s.marked.assign(s.bodies.size(), 0);
    for (std::size_t i = 0; i < model_->springs.size(); ++i)
        if (s.torn[i] == 0 && is_giving_way(model_->springs[i]))
            for (const SpringEnd &end : {model_->springs[i].a, model_->springs[i].b})
                if (end.kind == SpringEnd::Kind::body)
                    s.marked[end.index] = 1;
}

// Counts how long each body has been at rest; islands that have rested long enough fall asleep.
void World::fall_asleep() {
    if (!sleeps() && !chooses_substeps())
        return;
    Scratch &s = scratch_;
    const std::uint16_t enough = steps_to_sleep();
    const bool has_springs = !model_->springs.empty();
    if (has_springs)
        mark_giving_way();
    bool any = false;
    for (const std::uint32_t i : s.moving) {
        std::uint16_t &rested = s.paces[i].rested;
        if (model_->bodies[i].kind != BodyKind::dynamic || !is_at_rest(i) ||
            (has_springs && s.marked[i] != 0))
            rested = 0;
        else if (rested < enough)
            ++rested;
        any = any || rested >= enough;
    }
    if (!any || !sleeps())
        return;
    find_islands();
    s.marked.assign(s.bodies.size() + 1, 0); // the roots of islands that stay awake
    const auto stays_awake = [&](std::uint32_t body) { s.marked[s.islands.root_of(body)] = 1; };
    for (const std::uint32_t i : s.moving)
        if (s.paces[i].rested < enough)
            stays_awake(i);
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (holds(i) && joint.motor && joint.motor->speed != Real(0))
            stays_awake(island_body(joint.a, joint.b));
    }
    if (s.grab.is_holding())
        stays_awake(s.grab.body);
    if (model_->has_particles() && !std::ranges::all_of(s.particles, [&](const auto &motion) {
            return is_particle_at_rest(motion);
        }))
        s.marked[s.islands.root_of(static_cast<std::uint32_t>(s.bodies.size()))] = 1;
    for (const std::uint32_t i : s.moving)
        if (s.marked[s.islands.root_of(i)] == 0) {
            s.paces[i].rested = Pace::asleep;
            s.bodies[i].velocity = s.bodies[i].angular_velocity = Vec3{Real(0)};
        }
}

} // namespace plumb::inline PLUMB_PRECISION
