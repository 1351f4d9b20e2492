// Joints' rows as velocity constraints.
#pragma once

#include "engine/dynamics/joint_rows.h"
#include "engine/dynamics/softness.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// One block of rows between two bodies at the present poses.
struct JointConstraint {
    static constexpr std::uint32_t grab = UINT32_MAX;
    std::uint32_t joint = 0; // index in the model, or `grab`
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    RowBlock rows;
    Mat3 mass{Real(0)};       // inverse of K; one row: [0][0] alone
    Vec3 impulse{Real(0)};    // accumulated in this substep, on b (N s, N m s)
    Vec3 remembered{Real(0)}; // of the substep before
    bool is_spring() const { return rows.frequency > Real(0); }
};

// Whether a pass leaves out the joints that are springs.
enum class Springs { solve, skip };

// One Gauss-Seidel pass over all rows.
struct JointPass {
    Softness softness; // of rigid rows: how their drift is taken back; bias_rate 0 leaves it alone
    Real h = Real(0);  // s, the substep
    // Whether rows are to hold at the poses that the velocities lead to after h, to second order:
    // the anchors' centripetal way, w x (w x r) h^2 / 2, is then part of the constraint, as in
    // SHAKE (Ryckaert, Ciccotti, Berendsen 1977). Otherwise the velocities alone agree.
    bool to_second_order = false;
    Springs springs = Springs::solve;
    // s over which a spring's force acts in this pass: h for the implicit Euler rule, h / 2 for the
    // first half of the midpoint rule.
    Real spring_time = Real(0);
    // Whether limits that are off and bear nothing are left to the next substep.
    bool loaded_only = false;
    Real force_share = Real(1); // of max_force * h, for motors and grabs
};

// Blocks of the joints that are alive and not broken, in order, then of the grab; poses are read by
// refresh_joints.
void prepare_joints(StepContext &context);
// Axes, arms, errors and masses at the present poses, once in each substep: a joint that turns far
// within a step is only as true as its lever arms.
void refresh_joints(StepContext &context);
// Warm starting, as for contacts.
void remember_joints(StepContext &context);
void recall_joints(StepContext &context, Real share, Springs springs);
// Applies what the springs did in the first half of the substep once more.
void repeat_springs(StepContext &context);
void solve_joints(StepContext &context, const JointPass &pass);
// Hands the accumulated impulses back for the next step, and breaks what bore too much.
void store_joints(StepContext &context);

} // namespace plumb::inline PLUMB_PRECISION
