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

// Which of a joint's limits, or whether its motor, is solved with its group: as the third row of
// the two-row block that leaves that direction free. shut: both limits, at the same place.
enum class Bearing : std::uint8_t { none, lower, upper, shut, motor };

// One block of rows between two bodies at the present poses.
struct JointConstraint {
    static constexpr std::uint32_t grab = UINT32_MAX;
    std::uint32_t joint = 0; // index in the model, or `grab`
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    bool moves_a = false; // by forces
    bool moves_b = false;
    // The length against which drift is measured (m): that of the arms, at least a body's radius of
    // gyration; 1 for angles. An arm on what forces do not move counts as long as the other: its
    // own length depends on where that body's frame happens to be.
    Real size = Real(1);
    RowBlock rows;
    Mat3 mass{Real(0)};       // inverse of K; one row: only [0][0]
    Vec3 impulse{Real(0)};    // accumulated in this substep, on b (N s, N m s)
    Vec3 remembered{Real(0)}; // from the previous substep
    // Only in push_groups: the part of `impulse` that only corrects drift, and the speed at which
    // rows should close (m/s, rad/s).
    Vec3 push{Real(0)};
    Vec3 closing{Real(0)};
    // What impacts added in this substep, and the greatest impulse of any substep of this step.
    Vec3 struck{Real(0)};
    Real greatest = Real(0);
    // How much faster the errors grow on average over the substep than at its start, because the
    // bodies turn (m/s, rad/s). Only set by foresee_turns.
    Vec3 turning{Real(0)};
    std::uint8_t limits = 0; // offset to its lower limit's block; 0: it has none
    std::uint8_t motor = 0;  // the same, to its motor's
    Bearing bearing = Bearing::none;
    bool is_held = false;    // solved with its group in this substep (JointSystem)
    bool in_columns = false; // in this step (JointSchedule)
    bool is_weighed =
        false; // its mass includes its bodies' groups, which answer each of its impulses
    bool is_spring() const { return rows.frequency > Real(0); }
    // A spring of several rows: it does not use `mass`.
    bool is_stiff_as_joined() const { return is_spring() && rows.count > 1 && joint != grab; }
};

// What a pass does with joints that are springs: skip them, or solve them for the force at the end
// of the substep (implicit Euler) or at their spring_share.
enum class Springs { skip, at_the_end, midpoint };

// One Gauss-Seidel pass over all rows.
struct JointPass {
    Softness softness;         // of rigid rows: how drift is corrected; bias_rate 0 leaves it alone
    Real held_share = Real(0); // of the drift that rows solved in groups correct per substep
    Real push_share = Real(0); // of that part of it that loads do not explain (push_groups)
    Real push_velocity = std::numeric_limits<Real>::infinity(); // m/s, the fastest correction
    Real h = Real(0);                                           // s, the substep
    // Whether rows must hold at the poses that the velocities lead to after h, as in SHAKE
    // (Ryckaert, Ciccotti, Berendsen 1977): an anchor then moves by the chord of its arc, which
    // stays within its circle at any spin. Otherwise rows hold at velocity level only.
    bool at_the_end = false;
    Springs springs = Springs::at_the_end;
    // Whether open limits without an impulse are left to the next substep.
    bool loaded_only = false;
    Real force_share = Real(1); // of max_force * h, for motors and grabs
    bool skips_motors = false;  // as passes over pseudo velocities do
};

// The fraction of a substep at which a spring's force, taken there, stands for the whole substep:
// 1/2 (the midpoint rule, which keeps energy) as long as h resolves the spring, then rising towards
// implicit Euler with stiffness. A pass only partly solves springs that share bodies, and the
// midpoint rule would double the residual.
Real spring_share(const RowBlock &rows, Real h);

// Begins a substep, before refresh_joints. Where h is too long for how joint forces stiffen a
// body's rotation, gives the body an inertia that h can follow (Andrews, Teichmann, Koevecses 2017,
// "Geometric Stiffness for Real-time Constrained Multibody Dynamics"). Then decides which groups
// are held: all but those torn apart between the places they hang from. Marks bodies changed by
// either (scratch.changed).
void follow_loads(StepContext &context, Real h);

// Blocks of all joints that are alive and not broken, in order, then of the grab, at the present
// poses.
void prepare_joints(StepContext &context);
// Whether both ends of a joint act at one place: whether it is in a braced island
// (bracing.h).
bool is_braced(const StepContext &context, const JointConstraint &joint);
// Active joints and the grab.
std::size_t joint_count(const StepContext &context);
// The blocks of the k-th of these; may be empty.
std::span<JointConstraint> blocks_of(StepContext &context, std::size_t k);
// Recomputes its axes, arms and errors at the present poses.
void refresh_joint(StepContext &context, std::size_t k);
// All joints, with their effective masses, once per substep: a joint that turns far within a step
// is only as accurate as its lever arms.
void refresh_joints(StepContext &context);
// Effective masses only, where nothing moved since the joints were prepared or refreshed.
void weigh_joints(StepContext &context);
// The same, only for bodies changed by follow_loads.
void weigh_changed_joints(StepContext &context);
// Warm starting, as for contacts.
void remember_joints(StepContext &context);
void warm_start_joints(StepContext &context, Real share, Springs springs);
// For passes whose rows hold at velocity level only: an anchor that moves straight on leaves its
// circle by h^2 v^2 / 2r, so it is pulled back along the chord beforehand, using the current
// velocities. Joints that are torn, or turn too far for this second-order term, are left to the
// bias.
void foresee_turns(StepContext &context, Real h);
// Applies the springs' impulse for the rest of the substep, after Springs::midpoint.
void repeat_springs(StepContext &context);
void solve_joints(StepContext &context, const JointPass &pass);
// A single joint.
void solve_joint(StepContext &context, JointConstraint &joint, const JointPass &pass);
// Ends a substep: notes the joints' impulses, which may be too much for them. `scale` makes
// impulses (N s) of what the method accumulates in their place.
void note_joint_loads(StepContext &context, Real scale = Real(1));
// Stores the accumulated impulses for the next step, and breaks joints that were overloaded in any
// substep.
void store_joints(StepContext &context);

} // namespace plumb::inline PLUMB_PRECISION
