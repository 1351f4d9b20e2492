#include "engine/dynamics/joint_constraint.h"

#include "engine/dynamics/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Of joints that are solved together, as a share of what their own blocks give way: enough for
// joints that say the same twice, too little to be seen.
constexpr Real held_compliance = Real(1e-3);

// An impulse along a joint's rows. What does not move by forces is not written to: joints of other
// bodies, that are solved at the same time, hang on it, too.
void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    const RowBlock &rows = joint.rows;
    const Vec3 along = world_impulse(rows, impulse);
    if (joint.moves_a)
        apply(context.bodies[joint.a], rows, rows.r_a, -along);
    if (joint.moves_b)
        apply(context.bodies[joint.b], rows, rows.r_b, along);
}

Vec3 memory_of(const StepContext &context, const JointConstraint &constraint) {
    if (constraint.joint == JointConstraint::grab)
        return context.grab.impulse;
    const auto &impulses = context.joints[constraint.joint].impulses;
    Vec3 memory{Real(0)};
    for (int i = 0; i < constraint.rows.count; ++i)
        memory[i] = impulses[constraint.rows.first_memory + static_cast<std::size_t>(i)];
    return memory;
}

// The right-hand sides of a group's equations, its own among those of all.
std::span<Vec3> sides_of(StepContext &context, const JointGroup &group) {
    return std::span(context.scratch.sides).subspan(group.first, group.last - group.first);
}

// The limits of a block that has some.
std::span<JointConstraint, 2> limits_of(JointConstraint &joint) {
    return std::span<JointConstraint, 2>(&joint + joint.limits, 2);
}

// The row of the limit that bears as the third of the block.
void add_limit_row(JointConstraint &joint) {
    const RowBlock &limit = limits_of(joint)[joint.bearing == BearingLimit::upper ? 1 : 0].rows;
    joint.rows.count = 3;
    joint.rows.axes[2] = limit.axes[0];
    joint.rows.error.z = limit.error.x;
}

// It bears nothing yet.
void set_bearing(JointConstraint &joint, BearingLimit bearing) {
    joint.bearing = bearing;
    joint.rows.count = 2;
    joint.rows.axes[2] = Vec3{Real(0)};
    joint.rows.error.z = joint.impulse.z = joint.remembered.z = Real(0);
    if (bearing != BearingLimit::none)
        add_limit_row(joint);
    for (JointConstraint &limit : limits_of(joint)) {
        limit.impulse = limit.remembered = Vec3{Real(0)};
        limit.is_held = bearing != BearingLimit::none;
        limit.is_weighed = !limit.is_held; // again: weigh_again
    }
}

// A limit pushes, and does not pull.
bool pulls(BearingLimit bearing, Real impulse) {
    return (bearing == BearingLimit::lower && impulse < Real(0)) ||
           (bearing == BearingLimit::upper && impulse > Real(0));
}

// Leaves a limit to Gauss-Seidel, bearing nothing.
void release_limit(StepContext &context, JointConstraint &joint) {
    apply(context, joint, {Real(0), Real(0), -joint.impulse.z});
    set_bearing(joint, BearingLimit::none);
}

// With other limits than before.
void factor_again(StepContext &context, JointGroup &group) {
    context.scratch.joint_system->factor(context, group, held_compliance);
    group.has_changed = true;
}

// Releases those that pull. Returns whether there were any.
bool release_limits(StepContext &context, JointGroup &group) {
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[context.scratch.joint_system->block(place)];
        if (!pulls(joint.bearing, joint.impulse.z))
            continue;
        release_limit(context, joint);
        any = true;
    }
    if (any)
        factor_again(context, group);
    return any;
}

// How fast rows that are solved together take their drift back. A limit may be anywhere when it
// is reached: the others' drift is not to wait for it.
Vec3 held_bias(const JointConstraint &joint, const JointPass &pass) {
    const Real rate = pass.held_share / pass.h;
    if (joint.bearing == BearingLimit::none)
        return pushed(rate * joint.rows.error, pass.push_velocity);
    const Vec3 &error = joint.rows.error;
    Vec3 bias = pushed(rate * Vec3{error.x, error.y, Real(0)}, pass.push_velocity);
    const bool is_off = pulls(joint.bearing, -error.z); // comes to its limit in this substep
    bias.z = is_off ? error.z / pass.h
                    : std::clamp(rate * error.z, -pass.push_velocity, pass.push_velocity);
    return bias;
}

// What strikes open the limits that bore less in the last substep than the blow, whose answers are
// in the right-hand sides, would have them pull. Returns whether there were any.
bool open_limits(StepContext &context, JointGroup &group) {
    JointSystem &system = *context.scratch.joint_system;
    const std::span<const Vec3> sides = sides_of(context, group);
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        if (!pulls(joint.bearing, joint.impulse.z + sides[place - group.first].z))
            continue;
        set_bearing(joint, BearingLimit::none);
        any = true;
    }
    if (any)
        factor_again(context, group);
    return any;
}

// All rows of a group at once. Where bodies turn far within the substep, the ends of their arms
// move along circles, and it takes some of Newton's steps until they meet. Returns whether they do.
bool solve_rows(StepContext &context, const JointGroup &group, const JointPass &pass) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<Vec3> sides = sides_of(context, group);
    // Far more than it takes when a body turns a radian within the substep.
    constexpr int most_steps = 8;
    constexpr Real tolerance = Real(1e-6); // of the arms' lengths
    for (int step = 0; step < (pass.at_the_end ? most_steps : 1); ++step) {
        bool holds = step > 0;
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            Vec3 side =
                row_velocity(joint.rows, context.body(joint.a), context.body(joint.b), pass);
            if (pass.held_share > Real(0))
                side += held_bias(joint, pass) + system.softening(place) * joint.impulse;
            sides[place - group.first] = -side;
            if (holds) {
                const Real most = tolerance * size_of(joint.rows) / pass.h;
                holds = glm::dot(side, side) <= most * most;
            }
        }
        if (holds)
            return true;
        system.solve(group, sides);
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            JointConstraint &joint = context.scratch.joints[system.block(place)];
            const Vec3 &change = sides[place - group.first];
            joint.impulse += change;
            apply(context, joint, change);
        }
    }
    return !pass.at_the_end;
}

// The same, without limits that would pull: each round has fewer of them.
bool solve_group(StepContext &context, JointGroup &group, const JointPass &pass) {
    do
        if (!solve_rows(context, group, pass))
            return false;
    while (release_limits(context, group));
    return true;
}

// After limits were released: what the others bore with them would not be borne again in the rest
// of the substep. `share`: of the substep, so far.
void remember_anew(StepContext &context, const JointGroup &group, Real share) {
    const JointSystem &system = *context.scratch.joint_system;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        joint.remembered = joint.impulse / share;
    }
}

// Leaves a group to Gauss-Seidel, without what it remembers: forces that nothing has stretched for
// would give more energy than they took.
void let_go(StepContext &context, JointGroup &group) {
    const JointSystem &system = *context.scratch.joint_system;
    group.is_held = false;
    group.was_let_go = !group.was_torn;
    group.has_changed = true;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        apply(context, joint, -joint.impulse);
        joint.impulse = joint.remembered = Vec3{Real(0)};
        joint.is_held = false;
        if (joint.bearing != BearingLimit::none)
            release_limit(context, joint);
        joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
    }
}

// What a group answers to an impulse along the rows of a joint that is not of it, such as a limit:
// the impulses that keep the speeds of the group's rows, in its right-hand sides. Returns the sum
// of their products with what the impulse did to those rows.
Real find_answer(StepContext &context, const JointConstraint &joint, const JointGroup &group,
                 const Vec3 &impulse) {
    const JointSystem &system = *context.scratch.joint_system;
    const std::span<Vec3> sides = sides_of(context, group);
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
        sides[place - group.first] = -effect(place);
    system.solve(group, sides);
    Real sum = Real(0);
    for (std::uint32_t place = group.first; place < group.last; ++place)
        sum -= glm::dot(effect(place), sides[place - group.first]);
    return sum;
}

// Calls use(group) for those that the joint's bodies hang on, as far as they are held.
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

// At once, so that the next limit or motor of the same bodies knows of it: each is as heavy as the
// groups make it, and would overshoot against bodies that these have not held back yet.
void answer(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    for_held_groups(context, joint, [&](const JointGroup &group) {
        find_answer(context, joint, group, impulse);
        const std::span<const Vec3> sides = sides_of(context, group);
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            JointConstraint &other =
                context.scratch.joints[context.scratch.joint_system->block(place)];
            other.impulse += sides[place - group.first];
            apply(context, other, sides[place - group.first]);
        }
    });
}

bool is_changed(const StepContext &context, std::uint32_t body) {
    return body != Joint::world && context.scratch.changed[body] != 0;
}
bool is_changed(const StepContext &context, const JointConstraint &joint) {
    return is_changed(context, joint.a) || is_changed(context, joint.b);
}

// Limits and motors against bodies whose joints are solved together: as heavy as those make them.
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

void weigh_with_groups(StepContext &context, bool changed_only) {
    if (context.scratch.joint_system->groups().empty())
        return;
    for (JointConstraint &joint : context.scratch.joints)
        if (!changed_only || is_changed(context, joint))
            weigh(context, joint);
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
bool any_has_changed(StepContext &context) {
    return std::ranges::any_of(context.scratch.joint_system->groups(), &JointGroup::has_changed);
}

// Those that hang on groups that have changed since; calls use(joint) after each.
template <typename Use> void weigh_again(StepContext &context, Use &&use) {
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
    weigh_again(context, [](const JointConstraint &) {});
    for (JointGroup &group : context.scratch.joint_system->groups())
        group.has_changed = false;
}

// Some microseconds of work.
constexpr std::size_t joints_a_part = 16;
constexpr std::size_t groups_a_part = 1;

// Appends a joint's blocks, or writes those that it has.
class NewBlocks final : public RowWriter {
  public:
    explicit NewBlocks(std::vector<JointConstraint> &blocks) : blocks_(blocks) {}

  private:
    RowBlock &next() override { return blocks_.emplace_back().rows; }
    std::vector<JointConstraint> &blocks_;
};
class SameBlocks final : public RowWriter {
  public:
    explicit SameBlocks(JointConstraint *first) : next_(first) {}

  private:
    RowBlock &next() override { return (next_++)->rows; }
    JointConstraint *next_;
};

void emit(StepContext &context, std::size_t k, RowWriter &rows) {
    if (k < context.active.joints.size()) {
        const Joint &joint = context.model.joints[context.active.joints[k]];
        emit_rows(joint, context.body(joint.a), context.body(joint.b), rows);
    } else {
        emit_rows(context.grab, context.world_frame, context.body(context.grab.body), rows);
    }
}

// Hinges and sliders: the block of the same kind that leaves one row free.
void find_limits(std::span<JointConstraint> blocks) {
    const auto lower =
        std::ranges::find(blocks, RowBounds::at_least,
                          [](const JointConstraint &joint) { return joint.rows.bounds; });
    if (lower == blocks.end())
        return;
    for (JointConstraint &joint : blocks)
        if (joint.rows.bounds == RowBounds::equal && joint.rows.count == 2 &&
            joint.rows.kind == lower->rows.kind)
            joint.limits = static_cast<std::uint8_t>(&*lower - &joint);
}

void weigh_alone(StepContext &context, JointConstraint &joint) {
    if (!joint.is_held && !joint.in_columns)
        joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
}

bool is_in_columns(StepContext &context, std::size_t k) {
    const std::span<const JointConstraint> blocks = blocks_of(context, k);
    return !blocks.empty() && blocks.front().in_columns;
}

// Factors the groups that are held, and of which `is_due` says so.
template <typename Due> void factor_groups(StepContext &context, Due &&is_due) {
    JointSystem &system = *context.scratch.joint_system;
    const std::span<JointGroup> groups = system.groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin)) {
            group.is_factored = group.is_held;
            if (group.is_held && is_due(group))
                system.factor(context, group, held_compliance);
        }
    });
}

// How far a spring turns in a substep (rad), at twice the rate of the joint by itself: for others
// at its bodies, and its own lever arms.
Real spring_turn(const RowBlock &rows, Real h) {
    return Real(4) * std::numbers::pi_v<Real> * rows.frequency * h;
}

// By the midpoint rule, a spring starts from less the stiffer it is for the substep: what one pass
// leaves of a stiff one's impulse, of which the next is the opposite, would grow from substep to
// substep where springs share bodies. A soft one that began anew would sag: its damper would see
// what the pass has not come to yet.
Real spring_warm_start(const RowBlock &rows, Real h) {
    return std::max(Real(0), Real(1) - spring_turn(rows, h));
}

} // namespace

std::size_t joint_count(const StepContext &context) {
    return context.active.joints.size() + (context.active.holds_grab ? 1 : 0);
}

std::span<JointConstraint> blocks_of(StepContext &context, std::size_t k) {
    SolverScratch &s = context.scratch;
    const std::size_t last =
        k + 1 < s.first_blocks.size() ? s.first_blocks[k + 1] : s.joints.size();
    return std::span(s.joints).subspan(s.first_blocks[k], last - s.first_blocks[k]);
}

void prepare_joints(StepContext &context) {
    std::vector<JointConstraint> &blocks = context.scratch.joints;
    blocks.clear();
    context.scratch.joint_system->release();
    context.scratch.joint_schedule.blocks.clear();
    context.scratch.joint_schedule.level_ends.clear();
    context.scratch.first_blocks.clear();
    const auto is_dynamic = [&](std::uint32_t body) {
        return body != Joint::world && context.model.bodies[body].kind == BodyKind::dynamic;
    };
    NewBlocks rows(blocks);
    for (std::size_t k = 0; k < joint_count(context); ++k) {
        context.scratch.first_blocks.push_back(static_cast<std::uint32_t>(blocks.size()));
        emit(context, k, rows);
        const bool is_grab = k == context.active.joints.size();
        const std::uint32_t index = is_grab ? JointConstraint::grab : context.active.joints[k];
        for (JointConstraint &block : blocks_of(context, k)) {
            block.joint = index;
            block.a = is_grab ? Joint::world : context.model.joints[index].a;
            block.b = is_grab ? context.grab.body : context.model.joints[index].b;
            block.moves_a = is_dynamic(block.a);
            block.moves_b = is_dynamic(block.b);
            block.impulse = memory_of(context, block);
        }
        find_limits(blocks_of(context, k));
    }
}

void refresh_joint(StepContext &context, std::size_t k) {
    SameBlocks rows(context.scratch.joints.data() + context.scratch.first_blocks[k]);
    emit(context, k, rows);
    for (JointConstraint &joint : blocks_of(context, k))
        if (joint.bearing != BearingLimit::none)
            add_limit_row(joint);
}

bool choose_limits(StepContext &context, const JointGroup &group) {
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[context.scratch.joint_system->block(place)];
        if (joint.limits == 0)
            continue;
        const std::span<JointConstraint, 2> limits = limits_of(joint);
        BearingLimit bearing = joint.bearing;
        Real load = joint.impulse.z;
        if (bearing == BearingLimit::none) {
            load = limits[0].impulse.x + limits[1].impulse.x;
            bearing = load > Real(0) ? BearingLimit::lower : BearingLimit::upper;
        }
        if (limits[0].rows.error.x == limits[1].rows.error.x)
            bearing = BearingLimit::shut;
        else if (load == Real(0))
            bearing = BearingLimit::none;
        if (!group.is_held)
            bearing = BearingLimit::none;
        if (bearing == joint.bearing)
            continue;
        set_bearing(joint, bearing);
        if (bearing != BearingLimit::none)
            joint.impulse.z = load;
        any = true;
    }
    // What has torn it apart may have been a blow at those limits, which is not to go on.
    for (std::uint32_t place = group.first; any && !group.is_held && place < group.last; ++place)
        context.scratch.joints[context.scratch.joint_system->block(place)].impulse = Vec3{Real(0)};
    return any;
}

void refresh_joints(StepContext &context) {
    const auto refresh = [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (is_in_columns(context, k))
                continue;
            refresh_joint(context, k);
            for (JointConstraint &block : blocks_of(context, k))
                weigh_alone(context, block);
        }
    };
    for_parts(context.tasks, joint_count(context), joints_a_part, refresh);
    refresh_joint_columns(context);
    factor_groups(context, [](const JointGroup &) { return true; });
    weigh_with_groups(context, false);
}

void weigh_joints(StepContext &context) {
    const std::span<JointConstraint> joints = context.scratch.joints;
    for_parts(context.tasks, joints.size(), joints_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointConstraint &joint : joints.subspan(begin, end - begin))
            weigh_alone(context, joint);
    });
    weigh_joint_columns(context, false);
    factor_groups(context, [](const JointGroup &) { return true; });
    weigh_with_groups(context, false);
}

void weigh_changed_joints(StepContext &context) {
    JointSystem &system = *context.scratch.joint_system;
    for (JointConstraint &joint : context.scratch.joints)
        if (is_changed(context, joint))
            weigh_alone(context, joint);
    weigh_joint_columns(context, true);
    // A group that has changed has changed all of its bodies.
    factor_groups(context, [&](const JointGroup &group) {
        return is_changed(context, context.scratch.joints[system.block(group.first)]);
    });
    weigh_with_groups(context, true);
}

void remember_joints(StepContext &context) {
    for (JointConstraint &joint : context.scratch.joints) {
        joint.remembered = joint.impulse;
        joint.impulse = Vec3{Real(0)};
    }
    remember_joint_columns(context);
}

Real spring_share(const RowBlock &rows, Real h) {
    const Real turn = spring_turn(rows, h);
    return turn <= Real(2) ? Real(0.5) : Real(1) - Real(1) / turn;
}

void warm_start_joints(StepContext &context, Real share, Springs springs) {
    const Real h = context.substep();
    warm_start_joint_columns(context, share);
    for (JointConstraint &joint : context.scratch.joints) {
        if (joint.in_columns || (springs == Springs::skip && joint.is_spring()))
            continue;
        const bool is_midpoint = springs == Springs::midpoint && joint.is_spring();
        const Vec3 start =
            (is_midpoint ? share * spring_warm_start(joint.rows, h) : share) * joint.remembered;
        joint.impulse += start;
        apply(context, joint, start);
    }
    context.report.constraint_passes += context.scratch.joints.size();
}

void foresee_turns(StepContext &context, Real h) {
    constexpr Real most_share = Real(0.02); // of the arms: what turns 0.2 rad leaves its circle by
    for (JointConstraint &joint : context.scratch.joints) {
        const RowBlock &rows = joint.rows;
        joint.turning = Vec3{Real(0)};
        const Real squared_most = most_share * most_share *
                                  (glm::dot(rows.r_a, rows.r_a) + glm::dot(rows.r_b, rows.r_b) +
                                   rows.swing_length * rows.swing_length);
        if (rows.kind == RowKind::angular || rows.bounds == RowBounds::motor || joint.is_spring() ||
            glm::dot(rows.error, rows.error) > squared_most)
            continue;
        const Vec3 bend = half_bend(rows, context.body(joint.a), context.body(joint.b), h);
        const Real squared = h * h * glm::dot(bend, bend);
        joint.turning = squared > squared_most ? std::sqrt(squared_most / squared) * bend : bend;
    }
}

void repeat_springs(StepContext &context) {
    const Real h = context.substep();
    for (JointConstraint &joint : context.scratch.joints)
        if (joint.is_spring()) {
            const Vec3 rest = (Real(1) / spring_share(joint.rows, h) - Real(1)) * joint.impulse;
            apply(context, joint, rest);
            joint.impulse += rest;
        }
}

void solve_joint(StepContext &context, JointConstraint &joint, const JointPass &pass) {
    const Vec3 change = impulse_change(joint, context.body(joint.a), context.body(joint.b), pass);
    joint.impulse += change;
    apply(context, joint, change);
    if (joint.is_weighed && change != Vec3{Real(0)})
        answer(context, joint, change);
}

// Groups come first, to see whether they hold, and again after other joints have changed what they
// did, with the limits that these passes have reached: Gauss-Seidel alone finds which of them bear,
// but what a row of limits bears it would find only in very many passes.
void solve_joints(StepContext &context, const JointPass &pass) {
    const std::span<JointGroup> groups = context.scratch.joint_system->groups();
    const auto hold = [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held) {
                if (!solve_group(context, group, pass))
                    let_go(context, group);
                else if (group.has_changed)
                    remember_anew(context, group, pass.force_share);
            }
    };
    if (pass.at_the_end) {
        for_parts(context.tasks, groups.size(), groups_a_part, hold);
        weigh_again(context);
    }
    solve_joint_columns(context, pass);
    bool is_changed = !pass.at_the_end;
    for (JointConstraint &joint : context.scratch.joints) {
        if (joint.is_held || joint.in_columns ||
            (pass.springs == Springs::skip && joint.is_spring()) ||
            (pass.skips_motors && joint.rows.bounds == RowBounds::motor))
            continue;
        solve_joint(context, joint, pass);
        is_changed = true;
    }
    const auto solve = [&](auto &&is_due) {
        for_parts(context.tasks, groups.size(), groups_a_part,
                  [&](std::size_t begin, std::size_t end) {
                      for (JointGroup &group : groups.subspan(begin, end - begin)) {
                          if (!is_due(group) || !group.is_held)
                              continue;
                          if (choose_limits(context, group))
                              factor_again(context, group);
                          solve_group(context, group, pass);
                      }
                  });
    };
    if (is_changed)
        solve([](const JointGroup &) { return true; });
    // Limits that were reached or opened change what others of their group do.
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds && any_has_changed(context); ++round) {
        weigh_again(context, [&](JointConstraint &joint) { solve_joint(context, joint, pass); });
        solve([](JointGroup &group) { return std::exchange(group.has_changed, false); });
    }
    weigh_again(context);
    context.report.constraint_passes += context.scratch.joints.size();
}

void hold_touched_groups(StepContext &context, const JointPass &pass) {
    const std::span<JointGroup> groups = context.scratch.joint_system->groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held && group.is_touched)
                solve_group(context, group, pass);
    });
    weigh_again(context);
}

void answer_impact(StepContext &context, std::uint32_t group) {
    if (group == JointSystem::none)
        return;
    JointSystem &system = *context.scratch.joint_system;
    JointGroup &all = system.groups()[group];
    if (!all.is_held)
        return;
    const std::span<Vec3> sides = sides_of(context, all);
    do {
        for (std::uint32_t place = all.first; place < all.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            sides[place - all.first] = -row_velocity(joint.rows, context.body(joint.a),
                                                     context.body(joint.b), JointPass{});
        }
        system.solve(all, sides);
    } while (open_limits(context, all));
    for (std::uint32_t place = all.first; place < all.last; ++place) {
        const JointConstraint &joint = context.scratch.joints[system.block(place)];
        apply(context, joint, sides[place - all.first]);
    }
}

void store_joints(StepContext &context) {
    const Real rate =
        static_cast<Real>(context.settings.substeps) / static_cast<Real>(context.settings.dt);
    const auto store = [&](const JointConstraint &joint, const Vec3 &total, int count) {
        JointMemory &memory = context.joints[joint.joint];
        for (int i = 0; i < count; ++i)
            memory.impulses[joint.rows.first_memory + static_cast<std::size_t>(i)] = total[i];
        const Real break_force = context.model.joints[joint.joint].break_force;
        if (break_force > Real(0) && joint.rows.kind != RowKind::angular &&
            joint.rows.bounds != RowBounds::motor && glm::length(total) * rate > break_force)
            memory.broken = true;
    };
    for (JointConstraint &joint : context.scratch.joints) {
        const Vec3 &total = joint.impulse;
        if (joint.joint == JointConstraint::grab) {
            context.grab.impulse = total;
        } else if (joint.bearing != BearingLimit::none) {
            store(joint, {total.x, total.y, Real(0)}, 2);
            const std::span<JointConstraint, 2> limits = limits_of(joint);
            store(limits[0], Vec3{std::max(total.z, Real(0))}, 1);
            store(limits[1], Vec3{std::min(total.z, Real(0))}, 1);
        } else if (joint.rows.bounds == RowBounds::equal || !joint.is_held) { // no limit of those
            store(joint, total, joint.rows.count);
        }
    }
    for (const std::uint32_t i : context.active.joints)
        if (context.joints[i].broken)
            context.joints[i].impulses = {};
}

} // namespace plumb::inline PLUMB_PRECISION
