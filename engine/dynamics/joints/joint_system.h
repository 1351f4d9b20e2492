// Connected rigid joints, solved together.
#pragma once

#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/wide_matrix.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// Blocks first..last - 1 in the system's elimination order. `is_held`: solved together in this
// substep, not left to Gauss-Seidel. `is_mesh`: has many loops, as nets and frames do.
// `is_touched`: contacts act on its bodies. In this step:
// `is_factored`: it was factored when its joints were last refreshed; `was_torn`: torn joints
// kept it from being held; `was_let_go`: it was let go before that, or torn between two substeps.
// `has_changed`: it was let go, or its active limits changed, since the masses of motors
// and limits were computed with it.
struct JointGroup {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    bool is_held = false;
    bool is_mesh = false;
    bool is_factored = false;
    bool is_touched = false;
    bool was_torn = false;
    bool was_let_go = false;
    bool has_changed = false;
};

// The equations of all rigid rows of joints that share dynamic bodies, and of their active limits
// (JointConstraint::bearing), factored as L D L^T in 3 x 3 blocks, in minimum degree order. Without
// loops (chains, trees, a door's pin and its axis) there is no fill-in, and the cost is linear in
// the number of blocks (Baraff 1996, "Linear-Time Dynamics using Lagrange Multipliers"). Groups
// with too much fill-in, such as large nets, are left to Gauss-Seidel.
//
// Gauss-Seidel needs compliance, or heavy ends tear a chain; and compliance is damping that drains
// a pendulum's energy. Solved together, joints need next to none.
class JointSystem {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    // Holds no group until the next arrange; keeps the arrangement in case it still fits then.
    void release() { is_arranged_ = false; }
    // Finds which of the prepared blocks are solved together, in which order, and which are
    // touched.
    void arrange(StepContext &context);
    std::span<JointGroup> groups() {
        return is_arranged_ ? std::span<JointGroup>(groups_) : std::span<JointGroup>{};
    }
    std::uint32_t group_of(std::uint32_t body) const {
        return is_arranged_ ? group_of_body_[body] : none;
    }
    // The constraint at a position in the elimination order.
    std::uint32_t block(std::uint32_t place) const { return order_[place]; }

    // At the present poses and inertias. Adds `compliance` times a block's own K to it, so that
    // redundant joints can be solved.
    void factor(StepContext &context, const JointGroup &group, Real compliance);
    // What `factor` added to a block's K.
    const Mat3 &softening(std::uint32_t place) const { return softening_[place]; }
    // Solves in place for right-hand sides, one per position of the group.
    void solve(const JointGroup &group, std::span<Vec3> sides) const;

  private:
    // The Jacobian of a block's rows for one of its bodies (columns: linear and angular parts), and
    // that times the inverse mass.
    struct Effect {
        std::uint32_t body = 0; // if it is the world, only this is set
        bool is_linear = false; // has linear parts
        bool is_point = false;  // linear: the sign alone; angular: the arm's cross product with it
        Real sign = Real(1);
        Vec3 arm{Real(0)};
        Vec3 inv_mass{Real(0)};
        Mat3 turned{Real(0)}; // inverse inertia times angular
        // Only for rows other than points.
        Mat3 linear{Real(0)};
        Mat3 angular{Real(0)};
        Mat3 moved{Real(0)}; // inverse mass times linear
    };
    static void find_effect(StepContext &context, const JointConstraint &joint, bool is_b,
                            Effect &out);
    static void add_coupling(const Effect &u, const Effect &v, Mat3 &sum);
    void find_order(StepContext &context);
    bool eliminate(const std::vector<std::uint32_t> &members, std::size_t work_a_block);
    void note_touched(const StepContext &context);

    bool is_arranged_ = false;
    std::vector<std::uint64_t> key_; // identifies the arrangement: pairs of bodies
    std::vector<JointGroup> groups_;
    std::vector<std::uint32_t> group_of_body_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> column_start_; // one more entry than positions
    std::vector<std::uint32_t> rows_;         // row of each entry, column by column, ascending
    std::vector<std::uint32_t> targets_;      // the value that each elimination product updates
    std::vector<std::uint32_t> target_start_;
    // While arranging: each body's blocks; for each block, the blocks that it shares bodies with or
    // is linked to by fill-in, and its position; blocks ordered by their number of neighbours.
    std::vector<std::vector<std::uint32_t>> blocks_of_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint32_t> place_of_;
    std::vector<std::pair<std::size_t, std::uint32_t>> queue_;
    std::vector<std::array<Effect, 2>> effects_; // per position
    std::vector<Mat3> softening_;
    std::vector<WideMat3> diagonal_; // of K, then D^-1
    std::vector<WideMat3> lower_;    // of K, then L
};

} // namespace plumb::inline PLUMB_PRECISION
