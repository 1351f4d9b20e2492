// A world's particles and springs: edits, measures, and their part in the phases of a step.
#include "engine/dynamics/check_value.h"
#include "engine/dynamics/world.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The fastest spring's rate times the substep to ask for, a little below the limit that springs can
// follow (spring_constraint.cpp), since they turn and tighten within the step. And the same for the
// damping rate: one pass over strong dampers on light particles loses what they should pass on.
constexpr double followed_swing = 1.25;
constexpr double followed_damping = 16;

void check_motion(const Vec3 &position, const Vec3 &velocity) {
    PLUMB_CHECK(is_finite(position) && is_finite(velocity),
                "a particle's position and velocity must be finite");
}

bool is(const SpringEnd &end, SpringEnd::Kind kind) {
    return end.kind == kind;
}

} // namespace

std::uint32_t World::add_particle(const ParticleDef &def) {
    check_motion(def.position, def.velocity);
    check_positive("a particle's mass", def.mass);
    check_positive("a particle's radius", def.radius);
    check_not_negative("friction", def.material.friction);
    PLUMB_CHECK(def.material.restitution >= 0 && def.material.restitution <= 1,
                "restitution must be 0 to 1, got " << def.material.restitution);
    Model &model = edit();
    const Real inv_mass = def.pinned ? Real(0) : Real(1) / def.mass;
    model.particles.push_back({inv_mass, def.mass, def.radius, def.material});
    model.free_particles += def.pinned ? 0 : 1;
    state_.particles.push_back({def.position, def.pinned ? Vec3{Real(0)} : def.velocity});
    return static_cast<std::uint32_t>(model.particles.size() - 1);
}

std::uint32_t World::add_spring(const SpringDef &def) {
    for (const SpringEnd &end : {def.a, def.b}) {
        PLUMB_CHECK(is_finite(end.anchor), "a spring's anchors must be finite");
        PLUMB_CHECK(!is(end, SpringEnd::Kind::particle) || end.index < model_->particles.size(),
                    "a spring refers to particle " << end.index << ", which does not exist");
        PLUMB_CHECK(!is(end, SpringEnd::Kind::body) ||
                        (end.index < bodies().size() && bodies()[end.index].alive),
                    "a spring refers to body " << end.index << ", which is not alive");
    }
    PLUMB_CHECK(def.a.kind != def.b.kind ||
                    (!is(def.a, SpringEnd::Kind::world) && def.a.index != def.b.index),
                "a spring needs two different ends");
    check_not_negative("rest_length", def.rest_length);
    check_not_negative("stiffness", def.stiffness);
    check_not_negative("damping", def.damping);
    check_not_negative("tear_strain", def.tear_strain);

    Model &model = edit();
    Spring spring{def.a, def.b, def.rest_length, def.stiffness, def.damping, def.tear_strain};
    for (SpringEnd *end : {&spring.a, &spring.b})
        if (is(*end, SpringEnd::Kind::body)) {
            const Body &body = model.bodies[end->index];
            if (body.has_mass_frame)
                end->anchor = to_local_point(body.mass_frame, end->anchor);
            wake(end->index);
        }
    model.springs.push_back(spring);
    state_.torn.push_back(def.torn ? 1 : 0);
    return static_cast<std::uint32_t>(model.springs.size() - 1);
}

void World::set_particle(std::uint32_t index, const Vec3 &position, const Vec3 &velocity) {
    PLUMB_CHECK(index < model_->particles.size(), "there is no particle " << index);
    check_motion(position, velocity);
    wake_all(); // bodies that rest on it or hang from it
    const bool pinned = model_->particles[index].inv_mass == Real(0);
    state_.particles[index] = {position, pinned ? Vec3{Real(0)} : velocity};
}

// Held like a body of the mass of everything tied to it by springs, which comes along.
void World::grab_particle(std::uint32_t index, const Vec3 &target, Real max_force,
                          const GrabSpring &pull) {
    PLUMB_CHECK(index < model_->particles.size(), "there is no particle " << index);
    const Grab grab = grab_of(target, max_force, pull);
    if (model_->particles[index].inv_mass == Real(0))
        return;
    Islands tied;
    tied.start(model_->particles.size());
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        const Spring &spring = model_->springs[i];
        if (state_.torn[i] == 0 && is(spring.a, SpringEnd::Kind::particle) &&
            is(spring.b, SpringEnd::Kind::particle))
            tied.join(spring.a.index, spring.b.index);
    }
    const std::uint32_t root = tied.root_of(index);
    Real mass = Real(0);
    for (std::uint32_t i = 0; i < model_->particles.size(); ++i)
        if (tied.root_of(i) == root && model_->particles[i].inv_mass > Real(0))
            mass += model_->particles[i].mass;
    state_.grab = grab;
    state_.grab.particle = index;
    state_.grab.held_mass = mass;
}

bool World::moves_particles() const {
    return model_->free_particles > 0 && method_->info.springs;
}

bool World::needs_particle_contacts() const {
    return !model_->particles.empty() && model_->alive_bodies > 0 && method_->info.contacts;
}

bool World::is_particle_at_rest(const ParticleMotion &motion) const {
    const auto limit = static_cast<Real>(rest_speed(glm::length(settings_.gravity), settings_.dt));
    return glm::dot(motion.velocity, motion.velocity) <= limit * limit;
}

// Whether a spring end is still enough for a body asleep at the other end to stay asleep.
bool World::is_spring_end_still(const SpringEnd &end) const {
    if (is(end, SpringEnd::Kind::particle))
        return is_particle_at_rest(state_.particles[end.index]);
    return is(end, SpringEnd::Kind::world) || scratch_.still[end.index] != 0;
}

// Marks sleeping bodies that moving particles touch, or whose spring's other end moves.
bool World::mark_touched_by_particles() const {
    Scratch &s = scratch_;
    bool any = false;
    const auto mark = [&](std::uint32_t body) {
        if (!s.paces[body].is_asleep())
            return;
        if (!any)
            s.marked.assign(s.paces.size(), 0);
        s.marked[body] = 1;
        any = true;
    };
    for (const ParticleContact &contact : s.particle_contacts)
        if (!is_particle_at_rest(state_.particles[contact.particle]))
            mark(contact.body);
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        const Spring &spring = model_->springs[i];
        if (state_.torn[i] != 0)
            continue;
        if (is(spring.a, SpringEnd::Kind::body) && !is_spring_end_still(spring.b))
            mark(spring.a.index);
        if (is(spring.b, SpringEnd::Kind::body) && !is_spring_end_still(spring.a))
            mark(spring.b.index);
    }
    return any;
}

// The step's copies. Sleeping bodies that particles meet are loaded as static ones.
void World::load_particles() {
    Scratch &s = scratch_;
    s.particles = state_.particles;
    s.torn = state_.torn;
    const auto load = [&](std::uint32_t body) {
        if (!s.paces[body].is_asleep())
            return;
        s.bodies[body] = SolverBody{};
        static_cast<Motion &>(s.bodies[body]) = state_.motions[body];
    };
    for (const ParticleContact &contact : s.particle_contacts)
        load(contact.body);
    for (const Spring &spring : model_->springs)
        for (const SpringEnd &end : {spring.a, spring.b})
            if (is(end, SpringEnd::Kind::body))
                load(end.index);
}

// All particles and springs form one island, with the bodies that they touch or are attached to.
// Its index comes after those of the bodies.
void World::join_particles() {
    Scratch &s = scratch_;
    const auto particles = static_cast<std::uint32_t>(model_->bodies.size());
    s.islands.parent.push_back(particles);
    for (const ParticleContact &contact : s.particle_contacts)
        if (moves(contact.body))
            s.islands.join(contact.body, particles);
    for (std::size_t i = 0; i < model_->springs.size(); ++i)
        for (const SpringEnd &end : {model_->springs[i].a, model_->springs[i].b})
            if (s.torn[i] == 0 && is(end, SpringEnd::Kind::body) && moves(end.index))
                s.islands.join(end.index, particles);
}

// The number of substeps per second that springs need.
double World::spring_rate() const {
    Scratch &s = scratch_;
    find_spring_rates(*model_, s.bodies, s.particles, s.torn, s.solver.particle_stiffness,
                      s.solver.spring_rates);
    Vec2 most{Real(0)};
    for (const Vec2 &rates : s.solver.spring_rates)
        most = glm::max(most, rates);
    return std::max(std::sqrt(2 * static_cast<double>(most.x)) / followed_swing,
                    2 * static_cast<double>(most.y) / followed_damping);
}

// A spring or a particle contact is about an eighth of the work of a joint or contact.
void World::gather_particle_needs() {
    Scratch &s = scratch_;
    Islands::Needs &needs =
        s.islands.needs[s.islands.root_of(static_cast<std::uint32_t>(model_->bodies.size()))];
    const std::size_t rows = model_->springs.size() + s.particle_contacts.size();
    needs.is_driven = true;
    needs.work += static_cast<int>((rows + 7) / 8);
    needs.wanted = std::max(needs.wanted,
                            static_cast<int>(std::min(spring_rate() * settings_.dt, 65535.0)) + 1);
}

// Tears the springs of a removed body; their ends stay behind in the world.
void World::tear_springs_of(std::uint32_t body) {
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        Spring &spring = model_->springs[i];
        for (SpringEnd *end : {&spring.a, &spring.b})
            if (is(*end, SpringEnd::Kind::body) && end->index == body) {
                const Motion &motion = state_.motions[body];
                *end = {SpringEnd::Kind::world, 0, motion.position + motion.rotation * end->anchor};
                state_.torn[i] = 1;
            }
    }
}

void World::tear_springs() {
    Scratch &s = scratch_;
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        const Spring &spring = model_->springs[i];
        if (s.torn[i] != 0 || spring.tear_strain == Real(0))
            continue;
        const Vec3 line = spring_point(spring.b, s.bodies, s.particles).position -
                          spring_point(spring.a, s.bodies, s.particles).position;
        if (glm::length(line) > (Real(1) + spring.tear_strain) * spring.rest_length)
            s.torn[i] = 1;
    }
}

// After the method has run: springs that tore, and the report.
void World::end_particles() {
    Scratch &s = scratch_;
    tear_springs();
    report_.springs = static_cast<std::uint32_t>(std::ranges::count(s.torn, std::uint8_t{0}));
    report_.particle_contacts = static_cast<std::uint32_t>(s.particle_contacts.size());
    for (const ParticleMotion &motion : s.particles) {
        const Vec3 sum = motion.position + motion.velocity;
        report_.finite = report_.finite && std::isfinite(sum.x + sum.y + sum.z);
    }
}

double World::particle_energy() const {
    Measures m;
    add_particles(m);
    return m.energy();
}

void World::add_particles(Measures &m) const {
    for (std::size_t i = 0; i < model_->particles.size(); ++i) {
        const Particle &particle = model_->particles[i];
        if (particle.inv_mass == Real(0))
            continue;
        const auto mass = static_cast<double>(particle.mass);
        const glm::dvec3 x{state_.particles[i].position};
        const glm::dvec3 v{state_.particles[i].velocity};
        m.kinetic_energy += 0.5 * mass * glm::dot(v, v);
        m.potential_energy +=
            mass * (attraction_potential(model_->attractors, x) - glm::dot(settings_.gravity, x));
        m.linear_momentum += mass * v;
        m.angular_momentum += mass * glm::cross(x, v);
    }
    const auto place = [&](const SpringEnd &end) {
        if (is(end, SpringEnd::Kind::particle))
            return glm::dvec3{state_.particles[end.index].position};
        if (is(end, SpringEnd::Kind::world))
            return glm::dvec3{end.anchor};
        const Motion &motion = state_.motions[end.index];
        return glm::dvec3{motion.position} + glm::dquat{motion.rotation} * glm::dvec3{end.anchor};
    };
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        if (state_.torn[i] != 0)
            continue;
        const Spring &spring = model_->springs[i];
        const auto rest = static_cast<double>(spring.rest_length);
        const double stretch = glm::length(place(spring.b) - place(spring.a)) - rest;
        m.potential_energy += 0.5 * static_cast<double>(spring.stiffness) * stretch * stretch;
        if (rest > 0)
            m.max_strain = std::max(m.max_strain, std::abs(stretch) / rest);
    }
}

} // namespace plumb::inline PLUMB_PRECISION
