// Ball joints in columns, as soft_step solves those that are not solved together: nets.
#pragma once

#include "engine/dynamics/bodies/body_reals.h"
#include "engine/dynamics/columns.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct JointPass;
struct StepContext;

struct ColumnsMatrix {
    Columns3 x, y, z; // the matrix's columns
};

// 16 joints of one level: none shares a body that moves by forces with another.
struct JointBlock {
    // The world is no body: what is gathered for it is another's, and left out.
    struct End {
        IndexColumn body;         // as BodyReals has it
        std::uint16_t writes = 0; // bit k: lane k's moves by forces
        Column is_body;           // 1, or 0: the world
        Columns3 anchor;          // in the body's frame
        Columns3 arm;             // world
        Columns3 inv_mass;
        ColumnsMatrix inv_inertia;
    };
    std::size_t used = 0; // lanes
    // Bit k: lane k is beyond what the last kernel does, and it has left it as it was.
    std::uint16_t left = 0;
    std::uint32_t joints[column_lanes]; // NOLINT(modernize-avoid-c-arrays): among those prepared
    End a, b;
    Columns3 error;
    ColumnsMatrix mass;  // inverse of K
    Columns3 impulse;    // accumulated in this substep, on b (N s)
    Columns3 remembered; // of the substep before
};

// One level after another, each of joints that have to come after some of the level before: they
// share bodies with those, and stand behind them in the order of the model's joints. So all of them
// come to the same bits as one by one, in that order.
struct JointSchedule {
    std::vector<JointBlock> blocks;
    std::vector<std::uint32_t> level_ends; // of blocks
    std::vector<std::uint32_t> level_of_body;
    std::vector<std::uint32_t> level_of_joint;
    std::vector<std::uint32_t> next_lanes; // of each level
};

// After prepare_joints and JointSystem::arrange. None where few of them could be solved at once;
// the functions below then do nothing. Those that are here are marked (JointConstraint::in_columns)
// and left out by the functions for joints, which call these.
void prepare_joint_columns(StepContext &context);
// Their masses alone; `changed_only`: of blocks with bodies that follow_loads changed.
void weigh_joint_columns(StepContext &context, bool changed_only);
void refresh_joint_columns(StepContext &context);
void remember_joint_columns(StepContext &context);
void warm_start_joint_columns(StepContext &context, Real share);
void solve_joint_columns(StepContext &context, const JointPass &pass);
// Puts arms, errors and impulses back into the joints.
void store_joint_columns(StepContext &context);

// Compiled for each instruction set (joint_kernels.cpp). They leave lanes for which rounding, or
// turns of more than a fifth of a radian, ask for more care than is worth having here.
namespace kernels {
void weigh(std::span<JointBlock> blocks, const BodyReals &bodies);
void refresh(std::span<JointBlock> blocks, const BodyReals &bodies);
void warm_start(std::span<JointBlock> blocks, const BodyReals &bodies, Real share);
void solve(std::span<JointBlock> blocks, const BodyReals &bodies, const JointPass &pass);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
