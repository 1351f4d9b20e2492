#include "engine/dynamics/joints/joint_columns.h"

#include "engine/dynamics/colours.h"
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <bit>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// With fewer joints a level the gathering costs more than it saves: on an AMD EPYC, nets with 4
// joints a level take 1.03 times as long, with 5 the same, with 6.5 0.8, with 10 and 20 three
// quarters.
constexpr std::size_t least_a_level = 6;
constexpr std::uint32_t none = UINT32_MAX;

void set(ColumnsMatrix &columns, std::size_t lane, const Mat3 &m) {
    set(columns.x, lane, m[0]);
    set(columns.y, lane, m[1]);
    set(columns.z, lane, m[2]);
}
Mat3 get(const ColumnsMatrix &columns, std::size_t lane) {
    return {get(columns.x, lane), get(columns.y, lane), get(columns.z, lane)};
}

bool is_alone(const StepContext &context, std::uint32_t body) {
    return body == Joint::world ||
           context.scratch.joint_system->group_of(body) == JointSystem::none;
}

// Joints that are a single rigid point, between bodies that are in no group.
bool may_be_in_columns(StepContext &context, std::size_t k) {
    const std::span<const JointConstraint> blocks = blocks_of(context, k);
    if (blocks.size() != 1)
        return false;
    const JointConstraint &joint = blocks.front();
    return joint.joint != JointConstraint::grab && joint.rows.kind == RowKind::point &&
           joint.rows.bounds == RowBounds::equal && !joint.is_spring() &&
           is_alone(context, joint.a) && is_alone(context, joint.b);
}

// Finds the level of each joint, or none, and counts joints per level in next_lanes.
std::size_t find_levels(StepContext &context, JointSchedule &schedule) {
    schedule.level_of_body.assign(context.bodies.size(), 0);
    schedule.level_of_joint.assign(context.scratch.joints.size(), none);
    schedule.next_lanes.clear();
    std::size_t found = 0;
    for (std::size_t k = 0; k < joint_count(context); ++k) {
        if (!may_be_in_columns(context, k))
            continue;
        const std::uint32_t index = context.scratch.first_blocks[k];
        const JointConstraint &joint = context.scratch.joints[index];
        std::uint32_t level = 0;
        if (joint.moves_a)
            level = schedule.level_of_body[joint.a];
        if (joint.moves_b)
            level = std::max(level, schedule.level_of_body[joint.b]);
        if (joint.moves_a)
            schedule.level_of_body[joint.a] = level + 1;
        if (joint.moves_b)
            schedule.level_of_body[joint.b] = level + 1;
        schedule.level_of_joint[index] = level;
        if (level >= schedule.next_lanes.size())
            schedule.next_lanes.resize(level + 1, 0);
        ++schedule.next_lanes[level];
        ++found;
    }
    return found;
}

void fill_end(const StepContext &context, JointBlock::End &end, std::size_t lane,
              std::uint32_t body, bool moves, const Vec3 &anchor, const Vec3 &arm) {
    set(end.anchor, lane, anchor);
    set(end.arm, lane, arm);
    if (body == Joint::world)
        return;
    end.body.lanes[lane] = static_cast<IndexColumn::Index>(body * BodyReals::stride);
    end.is_body.lanes[lane] = Real(1);
    set(end.inv_mass, lane, context.bodies[body].inv_mass);
    if (moves)
        end.writes = static_cast<std::uint16_t>(end.writes | 1U << lane);
}

void fill_lane(StepContext &context, JointBlock &block, std::uint32_t index) {
    JointConstraint &joint = context.scratch.joints[index];
    const Joint &of = context.model.joints[joint.joint];
    const std::size_t lane = block.used++;
    joint.in_columns = true;
    block.joints[lane] = index;
    fill_end(context, block.a, lane, joint.a, joint.moves_a, of.anchor_a_local, joint.rows.r_a);
    fill_end(context, block.b, lane, joint.b, joint.moves_b, of.anchor_b_local, joint.rows.r_b);
    set(block.error, lane, joint.rows.error);
    block.meeting.lanes[lane] = is_braced(context, joint) ? Real(0.5) : Real(0);
    set(block.impulse, lane, joint.impulse);
}

// Calls use(lane) for lanes that a kernel left alone.
template <typename Use> void for_left(const JointBlock &block, Use &&use) {
    for (unsigned left = block.left & ((1U << block.used) - 1); left != 0; left &= left - 1)
        use(static_cast<std::size_t>(std::countr_zero(left)));
}

// Writes a lane back as a single joint.
JointConstraint &put_back(StepContext &context, const JointBlock &block, std::size_t lane) {
    JointConstraint &joint = context.scratch.joints[block.joints[lane]];
    joint.rows.r_a = get(block.a.arm, lane);
    joint.rows.r_b = get(block.b.arm, lane);
    joint.rows.error = get(block.error, lane);
    joint.impulse = get(block.impulse, lane);
    return joint;
}

void weigh_left(StepContext &context, JointBlock &block) {
    for_left(block, [&](std::size_t lane) {
        const JointConstraint &joint = put_back(context, block, lane);
        set(block.mass, lane, mass_of(joint.rows, context.body(joint.a), context.body(joint.b)));
    });
}

template <class Use> void for_blocks(StepContext &context, Use &&use) {
    if (std::vector<JointBlock> &blocks = context.scratch.joint_schedule.blocks; !blocks.empty())
        for_blocks(context.tasks, std::span(blocks), use);
}
template <class Use> void for_levels(StepContext &context, Use &&use) {
    JointSchedule &schedule = context.scratch.joint_schedule;
    if (schedule.blocks.empty())
        return;
    for_colours(context.tasks, std::span(schedule.blocks), schedule.level_ends, use);
}

bool is_changed(const StepContext &context, const JointBlock &block) {
    return std::any_of(block.joints, block.joints + block.used, [&](std::uint32_t index) {
        const JointConstraint &joint = context.scratch.joints[index];
        const auto changed = [&](std::uint32_t body) {
            return body != Joint::world && context.scratch.changed[body] != 0;
        };
        return changed(joint.a) || changed(joint.b);
    });
}

} // namespace

void prepare_joint_columns(StepContext &context) {
    JointSchedule &schedule = context.scratch.joint_schedule;
    if (context.scratch.joints.empty())
        return;
    const std::size_t found = find_levels(context, schedule);
    if (found == 0 || found < least_a_level * schedule.next_lanes.size())
        return;
    constexpr auto width = static_cast<std::uint32_t>(column_lanes);
    std::uint32_t block_count = 0;
    for (std::uint32_t &next : schedule.next_lanes) {
        const std::uint32_t size = next;
        next = block_count * width;
        block_count += (size + width - 1) / width;
        schedule.level_ends.push_back(block_count);
    }
    schedule.blocks.assign(block_count, JointBlock{});
    for (std::uint32_t index = 0; index < schedule.level_of_joint.size(); ++index)
        if (const std::uint32_t level = schedule.level_of_joint[index]; level != none)
            fill_lane(context, schedule.blocks[schedule.next_lanes[level]++ / width], index);
}

void weigh_joint_columns(StepContext &context, bool changed_only) {
    const BodyReals bodies = reals_of(context.bodies);
    for_blocks(context, [&](std::span<JointBlock> blocks) {
        for (JointBlock &block : blocks) {
            if (changed_only && !is_changed(context, block))
                continue;
            kernels::weigh({&block, 1}, bodies);
            weigh_left(context, block);
        }
    });
}

void refresh_joint_columns(StepContext &context) {
    const BodyReals bodies = reals_of(context.bodies);
    for_blocks(context, [&](std::span<JointBlock> blocks) {
        kernels::refresh(blocks, bodies);
        for (JointBlock &block : blocks)
            weigh_left(context, block);
    });
}

void remember_joint_columns(StepContext &context) {
    for (JointBlock &block : context.scratch.joint_schedule.blocks) {
        block.remembered = block.impulse;
        block.impulse = Columns3{};
    }
}

void warm_start_joint_columns(StepContext &context, Real share) {
    const BodyReals bodies = reals_of(context.bodies);
    for_levels(context,
               [&](std::span<JointBlock> blocks) { kernels::warm_start(blocks, bodies, share); });
}

void solve_joint_columns(StepContext &context, const JointPass &pass) {
    const BodyReals bodies = reals_of(context.bodies);
    for_levels(context, [&](std::span<JointBlock> blocks) {
        kernels::solve(blocks, bodies, pass);
        for (JointBlock &block : blocks)
            for_left(block, [&](std::size_t lane) {
                JointConstraint &joint = put_back(context, block, lane);
                joint.mass = get(block.mass, lane);
                solve_joint(context, joint, pass);
                set(block.impulse, lane, joint.impulse);
            });
    });
}

void store_joint_columns(StepContext &context) {
    for_blocks(context, [&](std::span<const JointBlock> blocks) {
        for (const JointBlock &block : blocks)
            for (std::size_t lane = 0; lane < block.used; ++lane)
                put_back(context, block, lane);
    });
}

} // namespace plumb::inline PLUMB_PRECISION
