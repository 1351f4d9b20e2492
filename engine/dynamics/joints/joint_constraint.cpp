#include "engine/dynamics/joints/joint_constraint.h"

#include "engine/dynamics/islands/bracing.h"
#include "engine/dynamics/joints/joint_bearings.h"
#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Vec3 memory_of(const StepContext &context, const JointConstraint &constraint) {
    if (constraint.joint == JointConstraint::grab)
        return context.grab.impulse;
    const auto &impulses = context.joints[constraint.joint].impulses;
    Vec3 memory{Real(0)};
    for (int i = 0; i < constraint.rows.count; ++i)
        memory[i] = impulses[constraint.rows.first_memory + static_cast<std::size_t>(i)];
    return memory;
}

bool is_changed(const StepContext &context, std::uint32_t body) {
    return body != Joint::world && context.scratch.changed[body] != 0;
}
bool is_changed(const StepContext &context, const JointConstraint &joint) {
    return is_changed(context, joint.a) || is_changed(context, joint.b);
}

void weigh_with_groups(StepContext &context, bool changed_only) {
    if (context.scratch.joint_system->groups().empty())
        return;
    for (JointConstraint &joint : context.scratch.joints)
        if (!changed_only || is_changed(context, joint))
            weigh(context, joint);
}

// A few microseconds of work.
constexpr std::size_t joints_a_part = 16;

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

Real size_of(const StepContext &context, const JointConstraint &joint) {
    const RowBlock &rows = joint.rows;
    if (rows.kind == RowKind::angular)
        return Real(1);
    Real arms = rows.swing_length;
    Real gyration = Real(0);
    const auto add = [&](bool moves, std::uint32_t index, const Vec3 &arm) {
        if (!moves)
            return;
        const Body &body = context.model.bodies[index];
        const Real most = std::max({body.inertia.x, body.inertia.y, body.inertia.z});
        gyration = std::max(gyration, std::sqrt(most / body.mass));
        arms += glm::length(arm);
    };
    add(joint.moves_a, joint.a, rows.r_a);
    add(joint.moves_b, joint.b, rows.r_b);
    if (joint.moves_a != joint.moves_b)
        arms *= Real(2);
    return std::max(arms, gyration);
}

void emit(StepContext &context, std::size_t k, RowWriter &rows) {
    if (k < context.active.joints.size()) {
        const Joint &joint = context.model.joints[context.active.joints[k]];
        emit_rows(joint, context.body(joint.a), context.body(joint.b), rows);
    } else {
        emit_rows(context.grab, context.world_frame, context.body(context.grab.body), rows);
    }
}

// Makes a joint of a braced island act on both its bodies at one place. Springs do so anyway.
void act_at_one_place(const StepContext &context, JointConstraint &joint) {
    RowBlock &rows = joint.rows;
    if (rows.kind != RowKind::point || joint.is_spring() || !is_braced(context, joint))
        return;
    const Vec3 half = half_way(rows.error, rows.r_a, rows.r_b, joints_meet_within);
    rows.r_a += half;
    rows.r_b -= half;
}

void weigh_alone(StepContext &context, JointConstraint &joint) {
    if (!joint.is_held && !joint.in_columns && !joint.is_stiff_as_joined())
        joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
}

bool is_in_columns(StepContext &context, std::size_t k) {
    const std::span<const JointConstraint> blocks = blocks_of(context, k);
    return !blocks.empty() && blocks.front().in_columns;
}

// Factors held groups for which is_due(group).
template <typename Due> void factor_groups(StepContext &context, Due &&is_due) {
    JointSystem &system = *context.scratch.joint_system;
    const std::span<JointGroup> groups = system.groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin)) {
            group.is_factored = group.is_held;
            if (group.is_held && is_due(group))
                system.factor(context, group);
        }
    });
}

// How far a spring turns its phase in a substep (rad), at twice the joint's own rate to allow for
// other springs on its bodies and for its own lever arms.
Real spring_turn(const RowBlock &rows, Real h) {
    return Real(4) * std::numbers::pi_v<Real> * rows.frequency * h;
}

// The stiffer a midpoint spring is for the substep, the less it is warm started: a pass leaves a
// residual in a stiff spring's impulse that is reversed in the next substep, and would grow where
// springs share bodies. A soft spring without a warm start would sag: its damper would see what the
// pass has not reached yet.
Real spring_warm_start(const RowBlock &rows, Real h) {
    return std::max(Real(0), Real(1) - spring_turn(rows, h));
}

} // namespace

bool is_braced(const StepContext &context, const JointConstraint &joint) {
    const std::vector<std::uint8_t> &braced = context.scratch.braced;
    return !braced.empty() && joint.moves_a && joint.moves_b && braced[joint.a] != 0;
}

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
            block.size = size_of(context, block);
            block.impulse = memory_of(context, block);
            act_at_one_place(context, block);
        }
        find_bearings(blocks_of(context, k));
    }
}

void refresh_joint(StepContext &context, std::size_t k) {
    SameBlocks rows(context.scratch.joints.data() + context.scratch.first_blocks[k]);
    emit(context, k, rows);
    for (JointConstraint &joint : blocks_of(context, k)) {
        act_at_one_place(context, joint);
        if (joint.bearing != Bearing::none)
            add_bearing_row(joint);
    }
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
    // A changed group has changed all of its bodies.
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
    constexpr Real most_share = Real(0.02); // of the arms: a 0.2 rad turn leaves the circle by this
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
    const Vec3 change = impulse_change(context, joint, pass);
    joint.impulse += change;
    apply(context, joint, change);
    if (joint.is_weighed && change != Vec3{Real(0)})
        answer(context, joint, change);
}

// Held groups are solved first, to see whether they hold, and again after other joints changed
// their bodies, with the limits that those passes reached: Gauss-Seidel alone finds which limits
// are active, but would need very many passes to find the load on a row of them.
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
                          if (choose_bearings(context, group, pass.force_share))
                              factor_again(context, group);
                          solve_group(context, group, pass);
                      }
                  });
    };
    if (is_changed)
        solve([](const JointGroup &) { return true; });
    // Limits that were reached or opened affect others of their group.
    constexpr int most_rounds = 4;
    for (int round = 0; round < most_rounds && any_has_changed(context); ++round) {
        weigh_again(context, [&](JointConstraint &joint) { solve_joint(context, joint, pass); });
        solve([](JointGroup &group) { return std::exchange(group.has_changed, false); });
    }
    weigh_again(context);
    context.report.constraint_passes += context.scratch.joints.size();
}

void note_joint_loads(StepContext &context, Real scale) {
    for (JointConstraint &joint : context.scratch.joints) {
        Vec3 load = scale * joint.impulse + joint.struck;
        if (joint.bearing == Bearing::motor) // breaks nothing
            load.z = Real(0);
        joint.greatest = std::max(joint.greatest, glm::length(load));
        joint.struck = Vec3{Real(0)};
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
            joint.rows.bounds != RowBounds::motor &&
            std::max(joint.greatest, glm::length(total)) * rate > break_force)
            memory.broken = true;
    };
    for (JointConstraint &joint : context.scratch.joints) {
        const Vec3 &total = joint.impulse;
        if (joint.joint == JointConstraint::grab) {
            context.grab.impulse = total;
        } else if (joint.bearing == Bearing::motor) {
            store(joint, {total.x, total.y, Real(0)}, 2);
            store(motor_of(joint), Vec3{total.z, Real(0), Real(0)}, 1);
        } else if (joint.bearing != Bearing::none) {
            store(joint, {total.x, total.y, Real(0)}, 2);
            const std::span<JointConstraint, 2> limits = limits_of(joint);
            store(limits[0], Vec3{std::max(total.z, Real(0))}, 1);
            store(limits[1], Vec3{std::min(total.z, Real(0))}, 1);
        } else if (joint.rows.bounds == RowBounds::equal || !joint.is_held) { // not such a row
            store(joint, total, joint.rows.count);
        }
    }
    for (const std::uint32_t i : context.active.joints)
        if (context.joints[i].broken)
            context.joints[i].impulses = {};
}

} // namespace plumb::inline PLUMB_PRECISION
