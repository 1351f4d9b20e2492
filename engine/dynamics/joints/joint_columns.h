// Ball joints in columns, as soft_step solves those that are not solved in groups: nets.
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

// 16 joints of one level: no two share a body that moves by forces.
struct JointBlock {
    // The world is no body: its lanes gather some other body's values, which are masked out.
    struct End {
        IndexColumn body;         // offset in BodyReals
        std::uint16_t writes = 0; // bit k: lane k's body moves by forces
        Column is_body;           // 1, or 0 for the world
        Columns3 anchor;          // in the body's frame
        Columns3 arm;             // world
        Columns3 inv_mass;
        ColumnsMatrix inv_inertia;
    };
    std::size_t used = 0; // number of lanes
    // Bit k: lane k is outside the last kernel's range, and was left unchanged.
    std::uint16_t left = 0;
    std::uint32_t joints[column_lanes]; // NOLINT(modernize-avoid-c-arrays): among those prepared
    End a, b;
    Columns3 error;
    Column meeting;      // share of the error by which each end moves: 1/2 if braced, else 0
    ColumnsMatrix mass;  // inverse of K
    Columns3 impulse;    // accumulated in this substep, on b (N s)
    Columns3 remembered; // from the previous substep
};

// Solved level by level. Each joint of a level shares a body with some joint of the level before,
// and comes after it in the order of the model's joints, so the result is bit-identical to solving
// the joints one by one in that order.
struct JointSchedule {
    std::vector<JointBlock> blocks;
    std::vector<std::uint32_t> level_ends; // of blocks
    std::vector<std::uint32_t> level_of_body;
    std::vector<std::uint32_t> level_of_joint;
    std::vector<std::uint32_t> next_lanes; // per level
};

// Call after prepare_joints and JointSystem::arrange. Makes no blocks where too few joints could be
// solved simultaneously; the functions below then do nothing. Joints in columns are marked
// (JointConstraint::in_columns) and skipped by the joint functions, which call these instead.
void prepare_joint_columns(StepContext &context);
// Effective masses only; `changed_only`: of blocks with bodies that follow_loads changed.
void weigh_joint_columns(StepContext &context, bool changed_only);
void refresh_joint_columns(StepContext &context);
void remember_joint_columns(StepContext &context);
void warm_start_joint_columns(StepContext &context, Real share);
void solve_joint_columns(StepContext &context, const JointPass &pass);
// Writes arms, errors and impulses back to the joints.
void store_joint_columns(StepContext &context);

// Compiled for each instruction set (joint_kernels.cpp). They leave alone lanes where round-off, or
// turns of more than a fifth of a radian, need more care than is worth having here.
namespace kernels {
void weigh(std::span<JointBlock> blocks, const BodyReals &bodies);
void refresh(std::span<JointBlock> blocks, const BodyReals &bodies);
void warm_start(std::span<JointBlock> blocks, const BodyReals &bodies, Real share);
void solve(std::span<JointBlock> blocks, const BodyReals &bodies, const JointPass &pass);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
