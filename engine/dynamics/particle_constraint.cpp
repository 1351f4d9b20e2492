#include "engine/dynamics/particle_constraint.h"

#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// What a spring's end is fastened to, as far as impulses move it.
struct EndMass {
    const StepContext &context;
    const SpringEnd &end;
    const Vec3 &arm;

    Real inverse_along(const Vec3 &axis) const {
        if (end.kind == SpringEnd::Kind::particle)
            return context.model.particles[end.index].inv_mass;
        if (end.kind == SpringEnd::Kind::world)
            return Real(0);
        const SolverBody &body = context.bodies[end.index];
        const Vec3 turn = glm::cross(arm, axis);
        return body.inv_mass_along(axis) + glm::dot(body.inv_inertia * turn, turn);
    }
};

void apply(StepContext &context, const SpringEnd &end, const Vec3 &arm, const Vec3 &impulse) {
    if (end.kind == SpringEnd::Kind::particle)
        context.particles[end.index].velocity +=
            context.model.particles[end.index].inv_mass * impulse;
    else if (end.kind == SpringEnd::Kind::body)
        context.bodies[end.index].apply_impulse(impulse, arm);
}

Vec3 velocity_at(const StepContext &context, const SpringEnd &end, const Vec3 &arm) {
    if (end.kind == SpringEnd::Kind::particle)
        return context.particles[end.index].velocity;
    return end.kind == SpringEnd::Kind::body ? context.bodies[end.index].velocity_at(arm)
                                             : Vec3{Real(0)};
}

void apply(StepContext &context, const SpringConstraint &row, Real impulse) {
    const Spring &spring = context.model.springs[row.spring];
    apply(context, spring.a, row.r_a, -impulse * row.axis);
    apply(context, spring.b, row.r_b, impulse * row.axis);
}

Real speed_of(const StepContext &context, const SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    return glm::dot(velocity_at(context, spring.b, row.r_b) -
                        velocity_at(context, spring.a, row.r_a),
                    row.axis);
}

// The line between a spring's ends as they are now; its length.
Real align(const StepContext &context, SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    const SpringPoint a = spring_point(spring.a, context.bodies, context.particles);
    const SpringPoint b = spring_point(spring.b, context.bodies, context.particles);
    const Vec3 line = b.position - a.position;
    const Real length = glm::length(line);
    row.axis = length > Real(0) ? line / length : Vec3{Real(0)};
    row.r_a = a.arm;
    row.r_b = b.arm;
    return length;
}

Vec2 rates_at(const StepContext &context, const SpringEnd &end) {
    switch (end.kind) {
    case SpringEnd::Kind::world:
        break;
    case SpringEnd::Kind::particle:
        return context.scratch.spring_rates[context.bodies.size() + end.index];
    case SpringEnd::Kind::body:
        return context.scratch.spring_rates[end.index];
    }
    return Vec2{Real(0)};
}

// The larger of the two ends: none swings or slows down faster than twice that.
Vec2 rates_of(const StepContext &context, const Spring &spring) {
    return Real(2) * glm::max(rates_at(context, spring.a), rates_at(context, spring.b));
}

void set_mass(const StepContext &context, SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    const Real inverse = EndMass{context, spring.a, row.r_a}.inverse_along(row.axis) +
                         EndMass{context, spring.b, row.r_b}.inverse_along(row.axis);
    row.mass = inverse > Real(0) ? Real(1) / (inverse + row.softness) : Real(0);
}

void solve(StepContext &context, SpringConstraint &row) {
    if (row.mass == Real(0))
        return;
    const Real change =
        -row.mass * (speed_of(context, row) + row.bias + row.softness * row.impulse);
    row.impulse += change;
    apply(context, row, change);
}

struct Pull {
    Vec3 axis;
    Real impulse; // of the spring's share of the substep, along it
};

// V = k (l - r)^2 / 2 as a discrete gradient between lengths l0 and l1: the force -k (1 - 2 r / (l0
// + l1)) times the mean of the two lines does the work V(l0) - V(l1).
Pull pull_of(const Spring &spring, const Vec3 &line, const Vec3 &half_move, Real time) {
    const Vec3 middle = line + half_move;
    const Real lengths = glm::length(line) + glm::length(middle + half_move);
    const Real distance = glm::length(middle);
    if (!(distance > Real(0)))
        return {Vec3{Real(0)}, Real(0)};
    const Real stretch = distance * (Real(1) - Real(2) * spring.rest_length / lengths);
    return {middle / distance, -time * spring.stiffness * stretch};
}

Real inverse_of(const StepContext &context, const SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    return EndMass{context, spring.a, row.r_a}.inverse_along(row.axis) +
           EndMass{context, spring.b, row.r_b}.inverse_along(row.axis);
}

Vec3 relative_velocity(const StepContext &context, const SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    return velocity_at(context, spring.b, row.r_b) - velocity_at(context, spring.a, row.r_a);
}

// Both set the axis.
Real aim(const StepContext &context, SpringConstraint &row, Real h) {
    const Spring &spring = context.model.springs[row.spring];
    const Real ahead = row.time.share * h;
    const Pull pull = pull_of(spring, row.line, ahead * relative_velocity(context, row), ahead);
    row.axis = pull.axis;
    row.mass = Real(1) / (Real(1) + ahead * ahead * spring.stiffness * inverse_of(context, row));
    return pull.impulse;
}
void solve_midpoint(StepContext &context, SpringConstraint &row, Real h) {
    const Vec3 before = row.impulse * row.axis;
    const Real wanted = aim(context, row, h);
    const Real along = glm::dot(before, row.axis);
    row.impulse = along + row.mass * (wanted - along);
    const Spring &spring = context.model.springs[row.spring];
    const Vec3 change = row.impulse * row.axis - before;
    apply(context, spring.a, row.r_a, -change);
    apply(context, spring.b, row.r_b, change);
}

// Begins with the impulse of the explicit force at the middle or end of the substep, as far as that
// is stable.
void refresh(StepContext &context, SpringConstraint &row, Real h, SpringRule rule) {
    const Spring &spring = context.model.springs[row.spring];
    const Real length = align(context, row);
    row.impulse = Real(0);
    row.mass = Real(0);
    row.time = spring_time(context, spring, h, rule);
    if (rule == SpringRule::midpoint) {
        row.line = length * row.axis;
        row.impulse = row.time.guessed * aim(context, row, h);
        return;
    }
    if (row.axis == Vec3{Real(0)} || row.time.softness == Real(0))
        return;
    row.softness = row.time.softness;
    row.bias = row.time.bias_rate * (length - spring.rest_length);
    set_mass(context, row);
    // For all springs from the same velocities.
    if (row.mass != Real(0))
        row.impulse = -row.time.guessed * (row.bias + speed_of(context, row)) / row.softness;
}

// The rest of the impulse; and what the two have done too much or too little, as far as the passes
// have left that, or contacts or turning bodies have made it.
void repeat(StepContext &context, SpringConstraint &row, Real h) {
    const Spring &spring = context.model.springs[row.spring];
    const Vec3 first = row.impulse * row.axis;
    const Vec3 both = first / row.time.share;
    const Real length = align(context, row);
    const Vec3 move = length * row.axis - row.line;
    const Pull pull = pull_of(spring, row.line, Real(0.5) * move, row.time.share * h);
    const Vec3 held = (pull.impulse / row.time.share) * pull.axis;
    apply(context, spring.a, row.r_a, first - both);
    apply(context, spring.b, row.r_b, both - first);
    apply(context, row,
          returned_impulse(speed_of(context, row), inverse_of(context, row),
                           glm::dot(move, both - held) / h));
}

// The damping, over all of the substep: of the velocities that the pulls before and after the move
// have left, which are 0 where these balance. It takes energy out however few the passes are;
// within the move it would take away what the pulls hand on.
void damp(StepContext &context, Real h) {
    const auto for_damped = [&](auto &&use) {
        for (SpringConstraint &row : context.scratch.springs)
            if (context.model.springs[row.spring].damping > Real(0))
                use(row);
    };
    for_damped([&](SpringConstraint &row) {
        const Real damping = h * context.model.springs[row.spring].damping;
        row.bias = Real(0);
        row.impulse = -row.time.damped * damping * speed_of(context, row);
        row.softness = Real(0);
        set_mass(context, row);
        if (row.mass == Real(0))
            return;
        row.softness = decay_softness(Real(1) / row.mass, damping);
        set_mass(context, row);
    });
    aim_spring_columns(context, SpringPart::damping);
    for_damped([&](SpringConstraint &row) { apply(context, row, row.impulse); });
    begin_spring_columns(context, SpringPart::damping);
    for (int i = 0; i < context.settings.iterations; ++i) {
        for_damped([&](SpringConstraint &row) { solve(context, row); });
        solve_spring_columns(context, SpringPart::damping);
    }
}

Vec3 relative_velocity(const StepContext &context, const ParticleContact &contact,
                       const ParticleContactConstraint &row) {
    return context.particles[contact.particle].velocity -
           context.bodies[contact.body].velocity_at(row.arm);
}

void apply(StepContext &context, const ParticleContact &contact,
           const ParticleContactConstraint &row, const Vec3 &impulse) {
    context.particles[contact.particle].velocity +=
        context.model.particles[contact.particle].inv_mass * impulse;
    context.bodies[contact.body].apply_impulse(-impulse, row.arm);
}

Real separation_of(const StepContext &context, const ParticleContact &contact) {
    const SolverBody &body = context.bodies[contact.body];
    const Vec3 gap = (context.particles[contact.particle].position - body.position) -
                     body.rotation * contact.anchor;
    return glm::dot(gap, contact.normal) - context.model.particles[contact.particle].radius;
}

void refresh(StepContext &context, ParticleContactConstraint &row) {
    const ParticleContact &contact = context.particle_contacts[row.contact];
    const SolverBody &body = context.bodies[contact.body];
    const Real inv_mass = context.model.particles[contact.particle].inv_mass;
    row.arm = context.particles[contact.particle].position - body.position;
    row.separation = separation_of(context, contact);
    row.impulse = Vec3{Real(0)};
    const auto coupling = [&](const Vec3 &u, const Vec3 &v) {
        const Real linear = glm::dot(u, body.inv_mass * v) + inv_mass * glm::dot(u, v);
        return linear + glm::dot(body.inv_inertia * glm::cross(row.arm, u), glm::cross(row.arm, v));
    };
    const Real normal = coupling(contact.normal, contact.normal);
    row.normal_mass = normal > Real(0) ? Real(1) / normal : Real(0);
    const Real k11 = coupling(row.tangents.t1, row.tangents.t1);
    const Real k12 = coupling(row.tangents.t1, row.tangents.t2);
    const Real k22 = coupling(row.tangents.t2, row.tangents.t2);
    const Real half = Real(0.5) * (k11 - k22);
    const Real largest = Real(0.5) * (k11 + k22) + std::sqrt(half * half + k12 * k12);
    row.tangent_mass = largest > Real(0) ? Real(1) / largest : Real(0);
    row.approach = glm::dot(relative_velocity(context, contact, row), contact.normal);
}

void solve_friction(StepContext &context, const ParticleContact &contact,
                    ParticleContactConstraint &row) {
    const Vec3 v = relative_velocity(context, contact, row);
    Vec2 total{row.impulse.y - row.tangent_mass * glm::dot(v, row.tangents.t1),
               row.impulse.z - row.tangent_mass * glm::dot(v, row.tangents.t2)};
    const Real limit = contact.friction * row.impulse.x;
    const Real length = glm::length(total);
    if (length > limit)
        total *= limit / length;
    const Vec3 change =
        (total.x - row.impulse.y) * row.tangents.t1 + (total.y - row.impulse.z) * row.tangents.t2;
    row.impulse.y = total.x;
    row.impulse.z = total.y;
    apply(context, contact, row, change);
}

} // namespace

void find_spring_rates(const Model &model, std::span<const SolverBody> bodies,
                       std::span<const ParticleMotion> particles,
                       std::span<const std::uint8_t> torn, std::vector<Mat3> &stiffness,
                       std::vector<Vec2> &rates) {
    stiffness.assign(particles.size(), Mat3{Real(0)});
    rates.assign(bodies.size() + particles.size(), Vec2{Real(0)});
    for (std::size_t i = 0; i < model.springs.size(); ++i) {
        if (torn[i] != 0)
            continue;
        const Spring &spring = model.springs[i];
        const SpringPoint a = spring_point(spring.a, bodies, particles);
        const SpringPoint b = spring_point(spring.b, bodies, particles);
        const Vec3 line = b.position - a.position;
        const Real length = glm::length(line);
        // Along the line as the spring is, across it as what it bears makes it.
        const Real across =
            length > spring.rest_length ? Real(1) - spring.rest_length / length : Real(0);
        const Vec3 axis = length > Real(0) ? line / length : Vec3{Real(0)};
        for (const auto &[end, arm] : {std::pair{&spring.a, a.arm}, std::pair{&spring.b, b.arm}}) {
            if (end->kind == SpringEnd::Kind::particle) {
                const Real along = length > Real(0) ? Real(1) - across : Real(0);
                stiffness[end->index] += spring.stiffness * (across * Mat3{Real(1)} +
                                                             along * glm::outerProduct(axis, axis));
                rates[bodies.size() + end->index].y +=
                    spring.damping * model.particles[end->index].inv_mass;
            } else if (end->kind == SpringEnd::Kind::body) {
                const SolverBody &body = bodies[end->index];
                const Mat3 &inverse = body.inv_inertia;
                const Vec3 turn = glm::cross(arm, axis);
                const Real along = body.inv_mass_along(axis) + glm::dot(inverse * turn, turn);
                const Real least = inverse[0][0] + inverse[1][1] + inverse[2][2];
                const Real any = body.inv_mass.x + glm::dot(arm, arm) * least;
                rates[end->index] +=
                    Vec2{spring.stiffness * (along + across * any), spring.damping * along};
            }
        }
    }
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Mat3 &k = stiffness[p];
        Real most = Real(0);
        for (int row = 0; row < 3; ++row)
            most = std::max(most, std::abs(k[row].x) + std::abs(k[row].y) + std::abs(k[row].z));
        rates[bodies.size() + p].x = most * model.particles[p].inv_mass;
    }
}

SpringTime spring_time(const StepContext &context, const Spring &spring, Real h, SpringRule rule) {
    SpringTime out;
    const Vec2 rates = rates_of(context, spring);
    if (rule == SpringRule::midpoint) {
        const Real turn = h * std::sqrt(rates.x);
        out.share = turn <= Real(2) ? Real(0.5) : Real(1) - Real(1) / turn;
        out.guessed = Real(1) / std::max(Real(1), out.share * out.share * turn * turn);
        out.is_swift = turn > Real(0.1);
        out.damped = Real(1) / std::max(Real(1), h * rates.y);
        return out;
    }
    const Real pull = spring.damping + h * spring.stiffness;
    if (!(pull > Real(0)))
        return out;
    out.softness = Real(1) / (h * pull);
    out.bias_rate = spring.stiffness / pull;
    out.guessed = Real(1) / std::max(Real(1), h * (h * rates.x + rates.y));
    return out;
}

Real returned_impulse(Real speed, Real inverse, Real gained) {
    const Real squared = speed * speed;
    const Real change = Real(2) * inverse * gained;
    const Real root = std::copysign(std::sqrt(std::max(Real(0), squared - change)), speed);
    const Real sum = speed + root; // the difference of the roots would round
    if (!(squared + had_for_given * change > Real(0)) || sum == Real(0))
        return Real(0);
    return -(change > squared ? squared / inverse : Real(2) * gained) / sum;
}

Real decay_softness(Real inverse, Real damping) {
    constexpr Real none_left = Real(40); // e^-x is far below rounding
    return inverse / std::expm1(std::min(damping * inverse, none_left));
}

void prepare_particles(StepContext &context, SpringRule rule) {
    SolverScratch &s = context.scratch;
    s.springs.clear();
    s.spring_schedule.springs.clear();
    s.particle_contacts.clear();
    if (!context.active.has_particles)
        return;
    find_spring_rates(context.model, context.bodies, context.particles, context.torn,
                      s.particle_stiffness, s.spring_rates);
    for (std::uint32_t i = 0; i < context.model.springs.size(); ++i) {
        if (context.torn[i] != 0)
            continue;
        const Spring &spring = context.model.springs[i];
        if (rule == SpringRule::midpoint && spring.a.kind == SpringEnd::Kind::particle &&
            spring.b.kind == SpringEnd::Kind::particle)
            s.spring_schedule.springs.push_back(i);
        else
            s.springs.emplace_back().spring = i;
    }
    prepare_spring_columns(context, context.substep());
    Real most = Real(0);
    for (const Vec2 &rates : s.spring_rates)
        most = std::max(most, rates.x);
    const Real turn = context.substep() * std::sqrt(Real(2) * most);
    s.spring_schedule.passes = turn < Real(3) ? 2 + static_cast<int>(turn) : 5;
    for (std::uint32_t i = 0; i < context.particle_contacts.size(); ++i) {
        ParticleContactConstraint &row = s.particle_contacts.emplace_back();
        row.contact = i;
        row.tangents = tangent_basis(context.particle_contacts[i].normal);
    }
}

void kick_particles(StepContext &context, const Vec3 &gravity, Real h) {
    if (!context.active.has_particles)
        return;
    for (std::size_t i = 0; i < context.particles.size(); ++i)
        if (context.model.particles[i].inv_mass > Real(0))
            context.particles[i].velocity += h * gravity;
}

void pull_particle(StepContext &context, Real h) {
    const Grab &grab = context.grab;
    if (!grab.holds_particle())
        return;
    ParticleMotion &held = context.particles[grab.particle];
    const Real omega = Real(2) * std::numbers::pi_v<Real> * grab.frequency;
    const Real stiffness = grab.held_mass * omega * omega;
    const Real damping = Real(2) * grab.damping_ratio * grab.held_mass * omega;
    const Real pull = damping + h * stiffness;
    const Real inv_mass = context.model.particles[grab.particle].inv_mass;
    const Vec3 error = held.position - grab.target;
    Vec3 impulse =
        -(held.velocity + (stiffness / pull) * error) / (inv_mass + Real(1) / (h * pull));
    const Real limit = grab.max_force * h;
    const Real length = glm::length(impulse);
    if (length > limit)
        impulse *= limit / length;
    held.velocity += inv_mass * impulse;
}

void refresh_particles(StepContext &context, Real h, SpringRule rule) {
    if (!context.active.has_particles)
        return;
    pull_particle(context, h);
    SolverScratch &s = context.scratch;
    for (SpringConstraint &row : s.springs)
        refresh(context, row, h, rule);
    aim_spring_columns(context, SpringPart::pull);
    for (ParticleContactConstraint &row : s.particle_contacts)
        refresh(context, row);
    for (const SpringConstraint &row : s.springs)
        apply(context, row, row.impulse);
    begin_spring_columns(context, SpringPart::pull);
}

int spring_passes(const StepContext &context) {
    return context.scratch.spring_schedule.passes;
}

void solve_springs(StepContext &context, SpringRule rule) {
    for (SpringConstraint &row : context.scratch.springs)
        if (rule == SpringRule::midpoint)
            solve_midpoint(context, row, context.substep());
        else
            solve(context, row);
    solve_spring_columns(context, SpringPart::pull);
    context.report.constraint_passes +=
        context.scratch.springs.size() + context.scratch.spring_schedule.springs.size();
}

void solve_particle_contacts(StepContext &context, const ParticlePush &push, Real h) {
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        const bool is_open = row.separation > Real(0);
        if (is_open && push.loaded_only && row.impulse.x == Real(0))
            continue;
        // The least speed at which they part.
        const Real least =
            is_open ? -row.separation / h : std::min(-push.rate * row.separation, push.velocity);
        const Real speed = glm::dot(relative_velocity(context, contact, row), contact.normal);
        const Real total = std::max(row.impulse.x + row.normal_mass * (least - speed), Real(0));
        apply(context, contact, row, (total - row.impulse.x) * contact.normal);
        row.impulse.x = total;
        if (contact.friction > Real(0))
            solve_friction(context, contact, row);
    }
    context.report.constraint_passes += context.scratch.particle_contacts.size();
}

void recall_particles(StepContext &context, Real share) {
    for (SpringConstraint &row : context.scratch.springs) {
        const Real recalled = share * row.remembered;
        row.impulse += recalled;
        apply(context, row, recalled);
    }
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        const Vec3 recalled = share * row.remembered;
        row.impulse += recalled;
        apply(context, contact, row,
              recalled.x * contact.normal + recalled.y * row.tangents.t1 +
                  recalled.z * row.tangents.t2);
    }
    context.report.constraint_passes +=
        context.scratch.springs.size() + context.scratch.particle_contacts.size();
}

void drift_particles(StepContext &context, Real h) {
    if (!context.active.has_particles)
        return;
    for (ParticleMotion &motion : context.particles)
        motion.position += h * motion.velocity;
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        row.separation = separation_of(context, contact);
        row.arm =
            context.particles[contact.particle].position - context.bodies[contact.body].position;
    }
    context.report.body_passes += context.particles.size();
}

void repeat_particle_springs(StepContext &context, Real h) {
    for (SpringConstraint &row : context.scratch.springs)
        repeat(context, row, h);
    repeat_spring_columns(context);
    damp(context, h);
}

void restitute_particles(StepContext &context, Real threshold) {
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        if (contact.restitution == Real(0) || row.impulse.x == Real(0) || row.approach > -threshold)
            continue;
        const Real speed = glm::dot(relative_velocity(context, contact, row), contact.normal);
        const Real change = row.normal_mass * (-contact.restitution * row.approach - speed);
        if (change <= Real(0))
            continue;
        row.impulse.x += change;
        apply(context, contact, row, change * contact.normal);
        ++context.report.impacts;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
