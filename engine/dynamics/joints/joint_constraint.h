// Joints' rows as velocity constraints.
#pragma once

#include "engine/dynamics/joints/joint_rows.h"
#include "engine/dynamics/softness.h"

#include <cstdint>
#include <limits>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;
struct JointGroup;

// Which of a joint's limits bears, and is solved with its group: as the third row of the block of
// two that leaves free what the limits stop. shut: both, at the same place.
enum class BearingLimit : std::uint8_t { none, lower, upper, shut };

// One block of rows between two bodies at the present poses.
struct JointConstraint {
    static constexpr std::uint32_t grab = UINT32_MAX;
    std::uint32_t joint = 0; // index in the model, or `grab`
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    bool moves_a = false; // by forces
    bool moves_b = false;
    RowBlock rows;
    Mat3 mass{Real(0)};       // inverse of K; one row: [0][0] alone
    Vec3 impulse{Real(0)};    // accumulated in this substep, on b (N s, N m s)
    Vec3 remembered{Real(0)}; // of the substep before
    // Of push_groups: the part of `impulse` that takes drift back, and no more; and the speed at
    // which rows are to close (m/s, rad/s).
    Vec3 push{Real(0)};
    Vec3 closing{Real(0)};
    // How much faster its errors grow in the mean of the substep than at its start, because the
    // bodies turn (m/s, rad/s): of foresee_turns alone.
    Vec3 turning{Real(0)};
    std::uint8_t limits = 0; // how many blocks behind it its lower limit comes; 0: it has none
    BearingLimit bearing = BearingLimit::none;
    bool is_held = false;    // solved with its group in this substep (JointSystem)
    bool in_columns = false; // in this step (JointSchedule)
    bool is_weighed = false; // by what groups make of its bodies: they answer each of its impulses
    bool is_spring() const { return rows.frequency > Real(0); }
    // A spring of several rows: `mass` is not of it.
    bool is_stiff_as_joined() const { return is_spring() && rows.count > 1 && joint != grab; }
};

// What a pass does about the joints that are springs: leaves them out, or solves them for the force
// at the substep's end (implicit Euler) or at its spring_share.
enum class Springs { skip, at_the_end, midpoint };

// One Gauss-Seidel pass over all rows.
struct JointPass {
    Softness softness; // of rigid rows: how their drift is taken back; bias_rate 0 leaves it alone
    Real held_share = Real(0); // of their drift, that rows solved together take back in a substep
    Real push_share = Real(0); // of the part of that which loads do not account for (push_groups)
    Real push_velocity = std::numeric_limits<Real>::infinity(); // m/s, the fastest it is taken back
    Real h = Real(0);                                           // s, the substep
    // Whether rows are to hold at the poses that the velocities lead to after h, as in SHAKE
    // (Ryckaert, Ciccotti, Berendsen 1977): the way of an anchor is then the chord that it turns
    // through, which no spin makes longer than its circle. Otherwise the velocities alone agree.
    bool at_the_end = false;
    Springs springs = Springs::at_the_end;
    // Whether limits that are off and bear nothing are left to the next substep.
    bool loaded_only = false;
    Real force_share = Real(1); // of max_force * h, for motors and grabs
    bool skips_motors = false;  // as a pass over pseudo velocities does
};

// The share of a substep after which a spring's force is that of all of it: 1/2, the midpoint rule,
// which keeps energy, as long as h follows the spring; more and more of it, up to implicit Euler,
// the stiffer it is: a pass solves springs that share bodies only in part, and the midpoint rule
// would double what it leaves.
Real spring_share(const RowBlock &rows, Real h);

// The length against which a block's drift is measured (m): that of its arms; 1 for angles.
Real size_of(const RowBlock &rows);

// Begins a substep, before refresh_joints: where h is too long to follow what joints' forces do to
// a body's turns, it gets the inertia that h follows (Andrews, Teichmann, Koevecses 2017,
// "Geometric Stiffness for Real-time Constrained Multibody Dynamics"). Then says which groups are
// held: those that have not been torn apart. Notes the bodies of which either changed
// (scratch.changed).
void follow_loads(StepContext &context, Real h);

// Blocks of the joints that are alive and not broken, in order, then of the grab, at the present
// poses.
void prepare_joints(StepContext &context);
// Active joints and the grab.
std::size_t joint_count(const StepContext &context);
// The blocks of the k-th of these; none where it has none.
std::span<JointConstraint> blocks_of(StepContext &context, std::size_t k);
// Its axes, arms and errors at the present poses.
void refresh_joint(StepContext &context, std::size_t k);
// Of all, and their masses, once in each substep: a joint that turns far within a step is only as
// true as its lever arms.
void refresh_joints(StepContext &context);
// Their masses alone, where nothing moved since they were prepared or refreshed.
void weigh_joints(StepContext &context);
// The same, of those bodies alone that follow_loads changed.
void weigh_changed_joints(StepContext &context);
// Warm starting, as for contacts.
void remember_joints(StepContext &context);
void warm_start_joints(StepContext &context, Real share, Springs springs);
// For passes whose rows agree in their velocities alone: an anchor that goes straight on leaves its
// circle by h^2 v^2 / 2r, and is pulled back to it along the chord beforehand, at the velocities of
// now. What is torn, or turns too far for this term of second order, is left to the bias.
void foresee_turns(StepContext &context, Real h);
// Applies what springs do in the rest of the substep, after Springs::midpoint.
void repeat_springs(StepContext &context);
void solve_joints(StepContext &context, const JointPass &pass);
// One alone.
void solve_joint(StepContext &context, JointConstraint &joint, const JointPass &pass);
// Hands the accumulated impulses back for the next step, and breaks what bore too much.
void store_joints(StepContext &context);

} // namespace plumb::inline PLUMB_PRECISION
