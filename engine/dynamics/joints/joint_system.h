// Rigid joints that hang together, solved together.
#pragma once

#include "engine/dynamics/joints/joint_constraint.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// Blocks first..last - 1 in a system's order of elimination. `is_held`: solved together in this
// substep, not left to Gauss-Seidel. `is_touched`: contacts act on its bodies. In this step:
// `is_factored`: it was when its joints were refreshed last; `was_torn` before a substep began;
// `was_let_go` before it was ever torn, or torn from one substep to the next. `has_changed`: was
// let go, or has other limits among its rows, since motors and limits were weighed with it.
struct JointGroup {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    bool is_held = false;
    bool is_factored = false;
    bool is_touched = false;
    bool was_torn = false;
    bool was_let_go = false;
    bool has_changed = false;
};

// The equations of all rigid rows of joints that share dynamic bodies, and of the limits of theirs
// that bear (JointConstraint::bearing), factored as L D L^T in blocks of 3 x 3, eliminated by
// least degree. Without loops (chains, trees, a door's pin and its axis) nothing fills in, and the
// cost grows with the number of blocks (Baraff 1996, "Linear-Time Dynamics using Lagrange
// Multipliers"); what would fill in too much, such as a net, is left to Gauss-Seidel.
//
// Gauss-Seidel needs compliance, or heavy ends tear a chain; compliance damps, and takes a
// pendulum's energy. Solved together, joints need next to none.
class JointSystem {
  public:
    static constexpr std::uint32_t none = UINT32_MAX;

    // Holds no group until it is arranged again; the arrangement is kept, in case it stays.
    void release() { is_arranged_ = false; }
    // Which of the prepared blocks are solved together, and in which order; and which touch others.
    void arrange(StepContext &context);
    std::span<JointGroup> groups() {
        return is_arranged_ ? std::span<JointGroup>(groups_) : std::span<JointGroup>{};
    }
    std::uint32_t group_of(std::uint32_t body) const {
        return is_arranged_ ? group_of_body_[body] : none;
    }
    // The constraint at a place in the order of elimination.
    std::uint32_t block(std::uint32_t place) const { return order_[place]; }

    // At the present poses and inertias. Each block is made softer by `compliance` times its own
    // inverse mass, so that joints that say the same twice can be solved.
    void factor(StepContext &context, const JointGroup &group, Real compliance);
    // What `factor` added to a block's inverse mass.
    const Mat3 &softening(std::uint32_t place) const { return softening_[place]; }
    // Replaces right-hand sides, one for each place of the group, by the solution.
    void solve(const JointGroup &group, std::span<Vec3> sides) const;

  private:
    // What the rows of a block do to one of its bodies, and what comes of that: the columns are
    // their linear and angular parts.
    struct Effect {
        std::uint32_t body = 0; // of the world, that alone is set
        bool is_linear = false; // has linear parts
        bool is_point = false;  // linear: the sign alone; angular: the arm's cross product with it
        Real sign = Real(1);
        Vec3 arm{Real(0)};
        Vec3 inv_mass{Real(0)};
        Mat3 turned{Real(0)}; // inverse inertia times angular
        // Of others than points.
        Mat3 linear{Real(0)};
        Mat3 angular{Real(0)};
        Mat3 moved{Real(0)}; // inverse mass times linear
    };
    static void find_effect(StepContext &context, const JointConstraint &joint, bool is_b,
                            Effect &out);
    static void add_coupling(const Effect &u, const Effect &v, Mat3 &sum);
    void find_order(StepContext &context);
    bool eliminate(const std::vector<std::uint32_t> &members);
    void note_touched(const StepContext &context);

    bool is_arranged_ = false;
    std::vector<std::uint64_t> key_; // of the arrangement: pairs of bodies
    std::vector<JointGroup> groups_;
    std::vector<std::uint32_t> group_of_body_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> column_start_; // one more than places
    std::vector<std::uint32_t> rows_;         // of the entries, column by column, ascending
    std::vector<std::uint32_t> targets_;      // which value each product of elimination changes
    std::vector<std::uint32_t> target_start_;
    // While it is arranged: of each body its blocks; of each block those that it shares bodies with
    // or comes to by elimination, and its place; blocks by how many those are.
    std::vector<std::vector<std::uint32_t>> blocks_of_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint32_t> place_of_;
    std::vector<std::pair<std::size_t, std::uint32_t>> queue_;
    std::vector<std::array<Effect, 2>> effects_; // of each place
    std::vector<Mat3> softening_;
    std::vector<Mat3> diagonal_; // of K, then D^-1
    std::vector<Mat3> lower_;    // of K, then L
};

} // namespace plumb::inline PLUMB_PRECISION
