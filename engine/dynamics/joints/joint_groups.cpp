#include "engine/dynamics/joints/joint_groups.h"

#include "engine/dynamics/joints/joint_bearings.h"
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// As a share of the arms' lengths: how far ends may be apart.
constexpr Real solved_to = Real(1e-6);
constexpr Real motors_solved_to = Real(1e-8);
constexpr Real mesh_solved_to = Real(5e-2);

// A group's own right-hand sides among those of all groups.
std::span<WideVec3> sides_of(StepContext &context, const JointGroup &group) {
    return std::span(context.scratch.sides).subspan(group.first, group.last - group.first);
}

// How fast rows in a group take their drift back. A limit may have any error when it is reached,
// and the other rows' drift should not wait for it.
Vec3 held_bias(const JointConstraint &joint, const JointPass &pass) {
    const Real rate = pass.held_share / pass.h;
    if (!is_limit(joint.bearing))
        return pushed(rate * joint.rows.error, pass.push_velocity);
    const Vec3 &error = joint.rows.error;
    Vec3 bias = pushed(rate * Vec3{error.x, error.y, Real(0)}, pass.push_velocity);
    const bool is_off = (joint.bearing == Bearing::lower && error.z > Real(0)) ||
                        (joint.bearing == Bearing::upper && error.z < Real(0)); // reaches it now
    bias.z = is_off ? error.z / pass.h
                    : std::clamp(rate * error.z, -pass.push_velocity, pass.push_velocity);
    return bias;
}

// How fast the rows' errors grow, beyond the speed that a motor's row should have.
WideVec3 closing_velocity(StepContext &context, const JointConstraint &joint,
                          const JointPass &pass) {
    const SolverBody &a = context.body(joint.a);
    const SolverBody &b = context.body(joint.b);
    if (joint.rows.kind == RowKind::point)
        return point_velocity(joint.rows, a, b, pass);
    Vec3 v = axial_velocity(joint.rows, a, b, pass);
    v.z -= joint.rows.speed;
    return WideVec3(v);
}

// Solves all rows of a group together. Where bodies turn far within the substep the ends of their
// arms move along circles, and take a few Newton steps to meet. Returns whether they do. In a mesh
// nearly is enough, as long as the steps bring them closer: Gauss-Seidel would let it fall apart,
// and the next substep takes the rest back.
bool solve_rows(StepContext &context, const JointGroup &group, const JointPass &pass) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<WideVec3> sides = sides_of(context, group);
    // Far more than needed when a body turns a radian within the substep.
    constexpr int most_steps = 8;
    Real before = std::numeric_limits<Real>::infinity();
    for (int step = 0; step == 0 || pass.at_the_end; ++step) {
        Real worst = Real(0); // squared, as a share of the size
        bool is_exact = true;
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            WideVec3 side = closing_velocity(context, joint, pass);
            if (pass.held_share > Real(0))
                side += WideVec3(joint.closing) + system.softening(place) * WideVec3(joint.impulse);
            sides[place - group.first] = -side;
            const WideVec3 share = (pass.h / joint.size) * side;
            const Real squared = dot(share, share);
            if (!std::isnan(worst) && !(squared <= worst))
                worst = squared;
            if (joint.bearing == Bearing::motor)
                is_exact = is_exact && squared <= motors_solved_to * motors_solved_to;
        }
        // Nothing takes back what a motor's row is off; but rounding may leave more than this.
        if (step > (is_exact ? 0 : 1) && worst <= solved_to * solved_to)
            return true;
        if (group.is_mesh && (step == most_steps || (step > 0 && !(worst < before))))
            return worst <= mesh_solved_to * mesh_solved_to;
        if (step == most_steps)
            return false;
        before = worst;
        system.solve(group, sides);
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            JointConstraint &joint = context.scratch.joints[system.block(place)];
            const Vec3 change = sides[place - group.first].narrow();
            joint.impulse += change;
            apply(context, joint, change);
        }
    }
    return true;
}

// A group's response to an impulse along the rows of a joint outside it, such as a limit: the
// impulses that keep the group's row speeds, left in its right-hand sides. Returns the sum of their
// products with the impulse's effect on those rows.
Real find_answer(StepContext &context, const JointConstraint &joint, const JointGroup &group,
                 const Vec3 &impulse) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<WideVec3> sides = sides_of(context, group);
    const auto struck = [&](std::uint32_t body) {
        SolverBody motion = context.body(body);
        motion.velocity = motion.angular_velocity = Vec3{Real(0)};
        return motion;
    };
    SolverBody a = struck(joint.a);
    SolverBody b = struck(joint.b);
    const Vec3 along = world_impulse(joint.rows, impulse);
    if (joint.moves_a)
        apply(a, joint.rows, joint.rows.r_a, -along);
    if (joint.moves_b)
        apply(b, joint.rows, joint.rows.r_b, along);
    const SolverBody still;
    const auto after = [&](std::uint32_t body) -> const SolverBody & {
        return body == Joint::world ? still : body == joint.a ? a : body == joint.b ? b : still;
    };
    const auto effect = [&](std::uint32_t place) {
        const JointConstraint &other = context.scratch.joints[system.block(place)];
        return row_velocity(other.rows, after(other.a), after(other.b), JointPass{});
    };
    for (std::uint32_t place = group.first; place < group.last; ++place)
        sides[place - group.first] = WideVec3(-effect(place));
    system.solve(group, sides);
    Real sum = Real(0);
    for (std::uint32_t place = group.first; place < group.last; ++place)
        sum -= glm::dot(effect(place), sides[place - group.first].narrow());
    return sum;
}

// Calls use(group) for the held groups of the joint's bodies.
template <typename Use>
void for_held_groups(StepContext &context, const JointConstraint &joint, Use &&use) {
    JointSystem &system = *context.scratch.joint_system;
    std::uint32_t last = JointSystem::none;
    for (const std::uint32_t body : {joint.a, joint.b}) {
        const std::uint32_t group =
            body == Joint::world ? JointSystem::none : system.group_of(body);
        if (group == JointSystem::none || group == last || !system.groups()[group].is_held)
            continue;
        last = group;
        use(system.groups()[group]);
    }
}

bool hangs_on_changed_group(StepContext &context, const JointConstraint &joint) {
    JointSystem &system = *context.scratch.joint_system;
    const auto has = [&](std::uint32_t body) {
        const std::uint32_t group =
            body == Joint::world ? JointSystem::none : system.group_of(body);
        return group != JointSystem::none && system.groups()[group].has_changed;
    };
    return has(joint.a) || has(joint.b);
}

} // namespace

void factor_again(StepContext &context, JointGroup &group) {
    context.scratch.joint_system->factor(context, group);
    group.has_changed = true;
}

bool solve_group(StepContext &context, JointGroup &group, const JointPass &pass) {
    do
        if (!solve_rows(context, group, pass))
            return false;
    while (release_bearings(context, group, pass));
    return true;
}

namespace {

// Where bodies turn far in a substep, their loads no longer point along the stretch they built up:
// that difference is not drift. 1 where they do not turn far.
Real unturned_share(StepContext &context, const JointConstraint &joint, Real h) {
    constexpr Real little = Real(0.01); // rad
    const Real turn = h * std::max(glm::length(context.body(joint.a).angular_velocity),
                                   glm::length(context.body(joint.b).angular_velocity));
    return std::clamp(Real(2) - turn / little, Real(0), Real(1));
}

// Rows in a group reach J v + closing + softening * impulse = 0, where closing = bias corrects the
// drift in full. The load so far has stretched the rows by softening * impulse; push_share of the
// rest of the bias is corrected, by the push and not by the load.
void push(StepContext &context, const JointGroup &group, const JointPass &pass) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<WideVec3> sides = sides_of(context, group);
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        const Vec3 given_way = (system.softening(place) * WideVec3(joint.impulse)).narrow();
        const Vec3 bias = held_bias(joint, pass);
        const Real share = unturned_share(context, joint, pass.h);
        Vec3 side = share * pass.push_share * (bias + given_way);
        joint.closing = side - share * given_way + (Real(1) - share) * bias;
        if (is_limit(joint.bearing)) { // may still be approaching it
            joint.closing.z = bias.z;
            side.z = Real(0);
        } else if (joint.bearing == Bearing::motor) { // would creep by what its row gives way
            joint.closing.z = -given_way.z;
            side.z = Real(0);
        }
        sides[place - group.first] = WideVec3(-side);
        const Real most = solved_to * joint.size / pass.h;
        any = any || glm::dot(side, side) > most * most;
    }
    if (!any)
        return;
    system.solve(group, sides);
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        joint.push = sides[place - group.first].narrow();
        if (is_limit(joint.bearing))
            joint.push.z = Real(0);
        joint.impulse += joint.push;
        apply(context, joint, joint.push);
    }
}

} // namespace

void push_groups(StepContext &context, const JointPass &pass) {
    const std::span<JointGroup> groups = context.scratch.joint_system->groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (const JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held)
                push(context, group, pass);
    });
}

void take_back_pushes(StepContext &context) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<JointGroup> groups = context.scratch.joint_system->groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (const JointGroup &group : groups.subspan(begin, end - begin))
            for (std::uint32_t place = group.first; place < group.last; ++place) {
                JointConstraint &joint = context.scratch.joints[system.block(place)];
                if (joint.push == Vec3{Real(0)})
                    continue;
                joint.impulse -= joint.push;
                apply(context, joint, -joint.push);
                joint.push = Vec3{Real(0)};
            }
    });
}

void hold_touched_groups(StepContext &context, const JointPass &pass) {
    const std::span<JointGroup> groups = context.scratch.joint_system->groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held && group.is_touched) {
                release_thrown_motors(context, group);
                solve_group(context, group, pass);
            }
    });
    weigh_again(context);
}

void remember_anew(StepContext &context, const JointGroup &group, Real share) {
    const JointSystem &system = *context.scratch.joint_system;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        joint.remembered = joint.impulse / share;
    }
}

void let_go(StepContext &context, JointGroup &group) {
    const JointSystem &system = *context.scratch.joint_system;
    group.is_held = false;
    group.was_let_go = !group.was_torn;
    group.has_changed = true;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        apply(context, joint, -joint.impulse);
        joint.impulse = joint.remembered = joint.push = Vec3{Real(0)};
        joint.is_held = false;
        if (joint.bearing != Bearing::none)
            set_bearing(joint, Bearing::none);
        joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
    }
}

void weigh(StepContext &context, JointConstraint &joint) {
    joint.is_weighed = false;
    Real &mass = joint.mass[0][0];
    if (joint.is_held || joint.rows.count != 1 || joint.is_spring() || !(mass > Real(0)))
        return;
    const Real alone = Real(1) / mass;
    Real inverse = alone;
    for_held_groups(context, joint, [&](const JointGroup &group) {
        inverse -= find_answer(context, joint, group, Vec3{Real(1), Real(0), Real(0)});
        joint.is_weighed = true;
    });
    mass = Real(1) / std::max(inverse, Real(1e-3) * alone);
}

bool any_has_changed(StepContext &context) {
    return std::ranges::any_of(context.scratch.joint_system->groups(), &JointGroup::has_changed);
}

void weigh_again(StepContext &context, const std::function<void(JointConstraint &)> &use) {
    if (!any_has_changed(context))
        return;
    for (JointConstraint &joint : context.scratch.joints)
        if (joint.is_weighed && hangs_on_changed_group(context, joint)) {
            joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
            weigh(context, joint);
            use(joint);
        }
}
void weigh_again(StepContext &context) {
    weigh_again(context, [](JointConstraint &) {});
    for (JointGroup &group : context.scratch.joint_system->groups())
        group.has_changed = false;
}

void answer(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    for_held_groups(context, joint, [&](const JointGroup &group) {
        find_answer(context, joint, group, impulse);
        const std::span<const WideVec3> sides = sides_of(context, group);
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            JointConstraint &other =
                context.scratch.joints[context.scratch.joint_system->block(place)];
            const Vec3 change = sides[place - group.first].narrow();
            other.impulse += change;
            apply(context, other, change);
        }
    });
}

void answer_impact(StepContext &context, std::uint32_t group) {
    if (group == JointSystem::none)
        return;
    JointSystem &system = *context.scratch.joint_system;
    JointGroup &all = system.groups()[group];
    if (!all.is_held)
        return;
    const std::span<WideVec3> sides = sides_of(context, all);
    do {
        for (std::uint32_t place = all.first; place < all.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            sides[place - all.first] = -closing_velocity(context, joint, JointPass{});
        }
        system.solve(all, sides);
    } while (open_bearings(context, all, sides));
    for (std::uint32_t place = all.first; place < all.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        const Vec3 change = sides[place - all.first].narrow();
        apply(context, joint, change);
        joint.struck += change;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
