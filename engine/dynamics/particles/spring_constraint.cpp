#include "engine/dynamics/particles/spring_constraint.h"

#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Slower springs keep their energy to a thousandth if they pull along the lines before and after
// the move, which keeps the angular momentum to round-off.
constexpr Real swift_turn = Real(0.1);

// Enough passes to keep the energy to a hundredth, and the angular momentum to 1e-5, over hundreds
// of steps for a load that swings through `turn` rad per substep.
int passes_for(Real turn) {
    return turn <= swift_turn ? 1 : 2 + static_cast<int>(std::min(Real(2.5) * turn, Real(3)));
}

// With fewer passes energy grows by up to a fraction of 2e-5 per radian; damping removes more.
constexpr Real least_damping = Real(0.01); // as a share of the swing rate
int passes_for_damped(Real turn) {
    return turn <= Real(0.6) ? 1 : turn <= Real(1.5) ? 2 : passes_for(turn);
}

// Dampers that take more than this of a speed in a substep, nearly, are strong; others let loads
// sink too fast by a share of half a per cent at most (x^2 / 12).
constexpr Real strong_damping = Real(0.25);
constexpr int passes_for_strong = 4; // where they share a body

// What a spring's end is attached to, as impulses see it.
struct EndMass {
    const StepContext &context;
    const SpringEnd &end;
    const Vec3 &arm;

    Vec3 answer(const Vec3 &impulse) const {
        if (end.kind == SpringEnd::Kind::particle)
            return context.model.particles[end.index].inv_mass * impulse;
        if (end.kind == SpringEnd::Kind::world)
            return Vec3{Real(0)};
        const SolverBody &body = context.bodies[end.index];
        return body.inv_mass * impulse +
               glm::cross(body.inv_inertia * glm::cross(arm, impulse), arm);
    }
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

// Updates the line between a spring's ends; returns its length.
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

// The larger of both ends' bounds: no mode swings or decays faster than twice that.
Vec2 rates_of(const StepContext &context, const Spring &spring) {
    return Real(2) * glm::max(rates_at(context, spring.a), rates_at(context, spring.b));
}

Real inverse_mass(const StepContext &context, const SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    return EndMass{context, spring.a, row.r_a}.inverse_along(row.axis) +
           EndMass{context, spring.b, row.r_b}.inverse_along(row.axis);
}

void set_mass(const StepContext &context, SpringConstraint &row) {
    const Real inverse = inverse_mass(context, row);
    row.mass = inverse > Real(0) ? Real(1) / (inverse + row.softness) : Real(0);
}

// A strong damper as a soft row; its impulse starts from what it would be alone, from the same
// velocities for all, as far as they stay stable together.
void aim_damper(const StepContext &context, SpringConstraint &row, Real h, bool before_move) {
    const Real damping = context.model.springs[row.spring].damping;
    const Real inverse = inverse_mass(context, row);
    row.mass = row.impulse = Real(0);
    if (!(inverse > Real(0)))
        return; // coincident ends
    const Real x = h * damping * inverse;
    const DamperHalf half = before_move ? damper_before_move(x) : damper_after_move(x);
    const Real taken = Real(1) - half.of_force;
    if (!(taken > Real(0)))
        return; // its ends hardly move along the line any more
    row.mass = taken / inverse;
    row.softness = half.of_force / row.mass;
    row.bias = -half.of_start / taken * row.start;
    const Real all = Real(0.5) * rates_of(context, context.model.springs[row.spring]).y;
    row.impulse = -std::min(Real(1), damping * inverse / all) * row.mass *
                  (speed_of(context, row) + row.bias);
}

void solve(StepContext &context, SpringConstraint &row) {
    if (row.mass == Real(0))
        return;
    const Real change =
        -row.mass * (speed_of(context, row) + row.bias + row.softness * row.impulse);
    row.impulse += change;
    apply(context, row, change);
}

// V = k (l - r)^2 / 2 as a discrete gradient between lengths l0 and l1: the force -k (1 - 2 r / (l0
// + l1)) times the mean of both lines does the work V(l0) - V(l1).
struct Pull {
    Vec3 middle;  // the mean of the lines
    Real across;  // the share of the stiffness that acts across it
    Vec3 impulse; // over the spring's share of the substep, on b
};
Pull pull_of(const Spring &spring, const Vec3 &line, const Vec3 &half_move, Real time) {
    const Vec3 middle = line + half_move;
    const Real lengths = glm::length(line) + glm::length(middle + half_move);
    const Real across =
        lengths > Real(0) ? Real(1) - Real(2) * spring.rest_length / lengths : Real(0);
    return {middle, across, -time * spring.stiffness * across * middle};
}

void apply(StepContext &context, const SpringConstraint &row, const Vec3 &impulse) {
    const Spring &spring = context.model.springs[row.spring];
    apply(context, spring.a, row.r_a, -impulse);
    apply(context, spring.b, row.r_b, impulse);
}

Vec3 relative_velocity(const StepContext &context, const SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    return velocity_at(context, spring.b, row.r_b) - velocity_at(context, spring.a, row.r_a);
}

// One Newton step for the impulse, as if nothing else changed the ends' velocities.
void solve_midpoint(StepContext &context, SpringConstraint &row, Real h) {
    if (!row.time.is_swift)
        return;
    const Spring &spring = context.model.springs[row.spring];
    const Real ahead = row.time.share * h;
    const Pull pull = pull_of(spring, row.line, ahead * relative_velocity(context, row), ahead);
    const EndMass a{context, spring.a, row.r_a}, b{context, spring.b, row.r_b};
    const Real squared = glm::dot(pull.middle, pull.middle);
    const Real across = std::max(pull.across, Real(0));
    Mat3 slope{Real(1)};
    for (int i = 0; i < 3; ++i) {
        Vec3 unit{Real(0)};
        unit[i] = Real(1);
        const Vec3 answer = a.answer(unit) + b.answer(unit);
        const Real along = squared > Real(0) ? glm::dot(pull.middle, answer) / squared : Real(0);
        slope[i] += ahead * ahead * spring.stiffness *
                    (across * answer + (Real(1) - across) * along * pull.middle);
    }
    const Vec3 change = glm::inverse(slope) * (pull.impulse - row.pull);
    row.pull += change;
    apply(context, row, change);
}

void refresh_midpoint(StepContext &context, SpringConstraint &row, Real h) {
    row.line = align(context, row) * row.axis;
    const Real ahead = row.time.share * h;
    const Vec3 half_move =
        row.time.is_swift ? ahead * relative_velocity(context, row) : Vec3{Real(0)};
    row.pull = row.time.guessed *
               pull_of(context.model.springs[row.spring], row.line, half_move, ahead).impulse;
    if (row.is_strong)
        aim_damper(context, row, h, true);
}

// Starts from the impulse of the explicit force at the end of the substep, as far as that is
// stable.
void refresh(StepContext &context, SpringConstraint &row) {
    const Spring &spring = context.model.springs[row.spring];
    const Real length = align(context, row);
    row.impulse = Real(0);
    row.mass = Real(0);
    if (row.axis == Vec3{Real(0)} || row.time.softness == Real(0))
        return;
    row.softness = row.time.softness;
    row.bias = row.time.bias_rate * (length - spring.rest_length);
    set_mass(context, row);
    // From the same velocities for all springs.
    if (row.mass != Real(0))
        row.impulse = -row.time.guessed * (row.bias + speed_of(context, row)) / row.softness;
}

// A pull acts at the lines before and after the move, and together its two parts turn nothing:
// where the bodies' ends swung off the straight move that it was found for, the second part makes
// up for it across the line. Light particles would be flung aside.
Vec3 rest_of_pull(const Spring &spring, const SpringConstraint &row, const Vec3 &line) {
    const Vec3 rest = (Real(1) / row.time.share - Real(1)) * row.pull;
    const Real squared = glm::dot(line, line);
    const bool is_between_bodies =
        spring.a.kind == SpringEnd::Kind::body && spring.b.kind == SpringEnd::Kind::body;
    if (!is_between_bodies || !(Real(4) * squared > glm::dot(row.line, row.line)))
        return rest;
    const Vec3 turn = glm::cross(row.line, row.pull) + glm::cross(line, rest);
    return rest + glm::cross(line, turn) / squared;
}

// The rest of the impulse, and a correction of the energy error of both impulses that the passes
// left, or that contacts or turning bodies caused.
void repeat(StepContext &context, SpringConstraint &row, Real h) {
    const Spring &spring = context.model.springs[row.spring];
    const Vec3 line = align(context, row) * row.axis;
    if (!row.time.is_swift) {
        apply(context, row, pull_of(spring, line, Vec3{Real(0)}, Real(0.5) * h).impulse);
        return;
    }
    const Vec3 move = line - row.line;
    const Vec3 both = row.pull + rest_of_pull(spring, row, line);
    const Vec3 held = pull_of(spring, row.line, Real(0.5) * move, h).impulse;
    apply(context, row, both - row.pull);
    const Real inverse = inverse_mass(context, row);
    apply(context, row,
          returned_impulse(speed_of(context, row), inverse, glm::dot(move, both - held) / h));
}

// Damping over the whole substep, of the velocities that the pulls before and after the move leave,
// which are 0 where those balance. It removes energy however few the passes are; within the move it
// would remove what the pulls pass on. Strong dampers have their second half here.
void damp(StepContext &context, Real h) {
    const auto for_damped = [&](auto &&use) {
        for (SpringConstraint &row : context.scratch.springs)
            if (context.model.springs[row.spring].damping > Real(0))
                use(row);
    };
    bool any_strong = false;
    for_damped([&](SpringConstraint &row) {
        any_strong = any_strong || row.is_strong;
        if (row.is_strong) {
            aim_damper(context, row, h, false);
            return;
        }
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
    const int passes = std::max(context.settings.iterations, any_strong ? passes_for_strong : 0);
    for (int i = 0; i < passes; ++i) {
        for_damped([&](SpringConstraint &row) { solve(context, row); });
        solve_spring_columns(context, SpringPart::damping);
    }
}

} // namespace

SpringTime spring_time(const StepContext &context, const Spring &spring, Real h, SpringRule rule) {
    SpringTime out;
    const Vec2 rates = rates_of(context, spring);
    if (rule == SpringRule::midpoint) {
        const Real turn = h * std::sqrt(rates.x);
        out.share = turn <= Real(2) ? Real(0.5) : Real(1) - Real(1) / turn;
        out.guessed = Real(1) / std::max(Real(1), out.share * out.share * turn * turn);
        out.is_swift = turn > swift_turn;
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
    const Real sum = speed + root; // the difference of the roots would round off
    if (!(squared + had_for_given * change > Real(0)) || sum == Real(0))
        return Real(0);
    return -(change > squared ? squared / inverse : Real(2) * gained) / sum;
}

Real decay_softness(Real inverse, Real damping) {
    constexpr Real none_left = Real(40); // e^-x is far below rounding
    return inverse / std::expm1(std::min(damping * inverse, none_left));
}

DamperHalf damper_before_move(Real x) {
    // (1 - e^-x) / x, and twice what is missing to 1, over x: by its series where that would round.
    const Real mean = -std::expm1(-x) / x;
    const Real of_force = x < Real(1e-2) ? Real(1) - x * (Real(1) / Real(3) - x / Real(12))
                                         : Real(2) * (Real(1) - mean) / x;
    return {of_force, mean - of_force};
}

DamperHalf damper_after_move(Real x) {
    const Real mean = -std::expm1(-x) / x;
    const Real left = std::exp(-x) / mean; // of the mean speed
    const Real of_force = x < Real(1e-2) ? Real(1) - x / Real(6) : Real(2) * (Real(1) - left) / x;
    return {of_force, left - of_force};
}

void prepare_springs(StepContext &context, SpringRule rule) {
    SolverScratch &s = context.scratch;
    const Real h = context.substep();
    if (!s.has_spring_rates)
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
    prepare_spring_columns(context, h);
    Real damped = Real(0), undamped = Real(0);
    for (const Vec2 &rates : s.spring_rates) {
        const bool is_damped = rates.y > least_damping * std::sqrt(rates.x);
        Real &most = is_damped ? damped : undamped;
        most = std::max(most, h * std::sqrt(Real(2) * rates.x));
    }
    s.spring_schedule.passes = std::max(passes_for(undamped), passes_for_damped(damped));
    if (rule != SpringRule::midpoint)
        return;
    for (SpringConstraint &row : s.springs) {
        align(context, row);
        const Real inverse = row.axis == Vec3{Real(0)} ? Real(0) : inverse_mass(context, row);
        row.is_strong = h * context.model.springs[row.spring].damping * inverse > strong_damping;
        if (row.is_strong)
            s.spring_schedule.passes = std::max(s.spring_schedule.passes, passes_for_strong);
    }
}

void note_damper_speeds(StepContext &context) {
    for (SpringConstraint &row : context.scratch.springs)
        if (row.is_strong)
            row.start = speed_of(context, row);
}

void begin_springs(StepContext &context, Real h, SpringRule rule) {
    std::vector<SpringConstraint> &rows = context.scratch.springs;
    for (SpringConstraint &row : rows) {
        row.time = spring_time(context, context.model.springs[row.spring], h, rule);
        if (rule == SpringRule::midpoint)
            refresh_midpoint(context, row, h);
        else
            refresh(context, row);
    }
    aim_spring_columns(context, SpringPart::pull);
    for (const SpringConstraint &row : rows)
        if (rule == SpringRule::midpoint) {
            apply(context, row, row.pull);
            if (row.is_strong)
                apply(context, row, row.impulse);
        } else {
            apply(context, row, row.impulse);
        }
    begin_spring_columns(context, SpringPart::pull);
}

int spring_passes(const StepContext &context) {
    return context.scratch.spring_schedule.passes;
}

void solve_springs(StepContext &context, SpringRule rule) {
    for (SpringConstraint &row : context.scratch.springs)
        if (rule == SpringRule::midpoint) {
            solve_midpoint(context, row, context.substep());
            if (row.is_strong)
                solve(context, row);
        } else {
            solve(context, row);
        }
    solve_spring_columns(context, SpringPart::pull);
    context.report.constraint_passes +=
        context.scratch.springs.size() + context.scratch.spring_schedule.springs.size();
}

void warm_start_springs(StepContext &context, Real share) {
    for (SpringConstraint &row : context.scratch.springs) {
        const Real start = share * row.remembered;
        row.impulse += start;
        apply(context, row, start);
    }
    context.report.constraint_passes += context.scratch.springs.size();
}

void repeat_particle_springs(StepContext &context, Real h) {
    for (SpringConstraint &row : context.scratch.springs)
        repeat(context, row, h);
    repeat_spring_columns(context);
    damp(context, h);
}

} // namespace plumb::inline PLUMB_PRECISION
