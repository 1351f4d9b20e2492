// The flights of all moving bodies (FreeFlight, motion.h) in columns, as soft_step advances them:
// with Kick::around.
#pragma once

#include "engine/dynamics/bodies/body_reals.h"
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/columns.h"

#include <cstdint>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// 16 moving bodies. In masks bit k is lane k's.
struct FlightBlock {
    std::size_t used = 0; // number of lanes; the others repeat the first body
    // The same in each substep of a step.
    std::uint16_t in_lanes = 0;    // those that the kernels advance: dynamic, nothing locked
    std::uint16_t gyroscopic = 0;  // of these: has_gyroscopic_spin
    std::uint16_t spin_damped = 0; // has angular damping
    // In a substep.
    std::uint16_t loaded = 0;  // see FreeFlight
    std::uint16_t jointed = 0; // see HeldBy
    std::uint16_t sprung = 0;
    // Lanes that the last kernel did not advance: in these round-off, or a large turn, needs more
    // care than is worth having there.
    std::uint16_t left = 0;
    std::uint16_t far = 0; // has_turned_far

    IndexColumn body;        // offset in BodyReals
    IndexColumn rounded_off; // offset in the array of RoundedOff, in Reals
    // The same in each substep of a step. In the mean over a substep, and as much more at its end:
    // times the velocity, plus a gain.
    Column mean_kept, late_kept;
    Columns3 mean_gain, late_gain;
    Column spin_kept, mean_spin_kept; // of the angular velocity, by its damping
    Columns3 inertia, inv_inertia;
    Column symmetry_axis; // the axis across which both moments are equal: 0, 1, 2; 3: none
    // (h / 2) (I_across - I_along) / I_across: times the spin about that axis, half the angle by
    // which the rest of the spin turns about it.
    Column precession;
    // See FreeFlight.
    Columns3 velocity, angular_velocity, mean_velocity, late_velocity;
    Columns3 start_spin, mean_spin, end_spin, late_spin;
};

// For a step's substeps of h seconds each.
void prepare_flight_columns(StepContext &context, const Vec3 &gravity, Real h);
// As begin_flights, note_lasting_loads and end_flights (motion.h), with the same bits.
void begin_flight_columns(StepContext &context, const Vec3 &gravity, Real h);
void note_lasting_loads(StepContext &context);
void end_flight_columns(StepContext &context, Real h);

// Compiled for each instruction set (flight_kernels.cpp).
namespace kernels {
void begin(std::span<FlightBlock> blocks, const BodyReals &bodies, Real h,
           int gyroscopic_iterations);
void end(std::span<FlightBlock> blocks, const BodyReals &bodies, Real *rounded_off, Real h,
         int gyroscopic_iterations);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
