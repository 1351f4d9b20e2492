// Connected rigid joints, solved together.
#pragma once

#include "engine/dynamics/joints/fronts.h"
#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/wide_matrix.h"

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// Blocks first..last - 1 in the system's elimination order.
struct JointGroup {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    bool is_held = false;    // solved together in this substep, not left to Gauss-Seidel
    bool is_mesh = false;    // has many loops, as nets and frames do
    bool is_touched = false; // contacts act on its bodies
    bool is_uneven = false;  // two joints at most, between bodies of unlike masses
    bool is_stiff = false;   // factored in double: uneven, or bodies turn far more easily than move
    // In this step:
    bool is_factored = false; // when its joints were last refreshed
    bool was_torn = false;    // torn joints kept it from being held
    bool was_let_go = false;  // before that, or torn between two substeps
    bool has_changed = false; // was let go, or its active limits changed, since masses of motors
                              // and limits were computed with it
};

// The equations of all rigid rows of joints that share dynamic bodies, and of their active limits
// (JointConstraint::bearing), factored as L D L^T in 3 x 3 blocks, in an order of little fill-in.
// Without loops (chains, trees, a door's pin and its axis) there is no fill-in, and the cost is
// linear in the number of blocks (Baraff 1996, "Linear-Time Dynamics using Lagrange Multipliers").
// Groups with too much fill-in, such as large nets, are left to Gauss-Seidel.
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

    // Compliance of the joints, as a share of their own blocks' K: enough to solve redundant
    // joints, too little to see.
    static constexpr Real held_compliance = Real(1e-3);
    // The same for stiff groups: there, K is large only because a body turns easily, and that share
    // of it would let what spins on a long arm gain energy.
    static constexpr double stiff_compliance = 1e-6;

    // At the present poses and inertias.
    void factor(StepContext &context, const JointGroup &group);
    // What `factor` added to a block's K.
    const WideMat3 &softening(std::uint32_t place) const { return softening_[place]; }
    // Solves in place for right-hand sides, one per position of the group.
    void solve(const JointGroup &group, std::span<WideVec3> sides) const;

  private:
    // The Jacobian of a block's rows for one of its bodies (columns: linear and angular parts), and
    // that times the inverse mass.
    template <typename Number> struct Effect {
        std::uint32_t body = 0; // if it is the world, only this is set
        bool is_linear = false; // has linear parts
        bool is_point = false;  // linear: the sign alone; angular: the cross product with the arm
        Number sign = Number(1);
        WideVector<Number> arm; // times the sign
        WideVector<Number> inv_mass;
        WideMatrix<Number> turned; // inverse inertia times angular
        // Only for rows other than points.
        WideMatrix<Number> linear;
        WideMatrix<Number> angular;
        WideMatrix<Number> moved; // inverse mass times linear
    };
    // By place, or by entry.
    template <typename Number> struct Factors {
        std::vector<std::array<Effect<Number>, 2>> effects;
        std::vector<WideMatrix<Number>> diagonal; // of K, then D^-1
        std::vector<WideMatrix<Number>> lower;    // of K, then L
        std::vector<WideVector<Number>> sides;    // of `solve`
        Fronts::Memory<Number> fronts;            // of meshes, instead of `lower`
        void resize(std::size_t places, std::size_t entries, const Fronts &meshes);
    };
    template <typename Number>
    static void find_effect(StepContext &context, const JointConstraint &joint, bool is_b,
                            Effect<Number> &out);
    template <typename Number>
    static void add_coupling(const Effect<Number> &u, const Effect<Number> &v,
                             WideMatrix<Number> &sum);
    template <typename Number>
    void factor(StepContext &context, const JointGroup &group, Number compliance, Number rounding,
                Factors<Number> &into);
    template <typename Number>
    void solve(const JointGroup &group, Factors<Number> &factors,
               std::span<WideVector<Number>> sides) const;
    // What it costs to eliminate a block: couples of others, and how many it is coupled with.
    struct Cost {
        double pairs = 0;
        std::size_t degree = 0;
        std::uint32_t block = none;
        auto operator<=>(const Cost &) const = default;
    };
    void find_order(StepContext &context);
    void rate_blocks(std::uint32_t body);
    std::uint32_t merge_ends(std::uint32_t block);
    void find_couplings(const StepContext &context);
    bool eliminate(const std::vector<std::uint32_t> &members, std::size_t work_a_block);
    void order_by_tree(std::uint32_t first);
    FactorColumns columns() const { return {column_start_, rows_}; }
    void note_touched(const StepContext &context);
    bool is_uneven(const StepContext &context, const JointGroup &group) const;
    void note_stiff(StepContext &context);

    bool is_arranged_ = false;
    std::vector<std::uint64_t> key_; // identifies the arrangement: pairs of bodies
    std::vector<JointGroup> groups_;
    std::vector<std::uint32_t> group_of_body_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> column_start_; // one more entry than positions
    std::vector<std::uint32_t> rows_;         // row of each entry, column by column, ascending
    std::vector<std::uint32_t> couplings_;    // entries that are not all fill-in, column by column
    std::vector<std::uint32_t> coupling_start_;
    // The value that each elimination product updates; none for meshes, which have fronts.
    std::vector<std::uint32_t> targets_;
    std::vector<std::uint32_t> target_start_;
    Fronts fronts_;
    // While arranging: each body's blocks; each block's bodies, rating and position; blocks ordered
    // by their ratings; how many blocks one body shares with each other.
    std::vector<std::vector<std::uint32_t>> blocks_of_;
    std::vector<std::array<std::uint32_t, 2>> ends_;
    std::vector<Cost> costs_;
    std::vector<std::uint32_t> place_of_;
    std::vector<Cost> queue_;
    std::vector<std::uint32_t> shared_;
    std::vector<WideMat3> softening_; // per position
    mutable Factors<Real> factors_;
    mutable Factors<double> fine_factors_; // of stiff groups
};

} // namespace plumb::inline PLUMB_PRECISION
