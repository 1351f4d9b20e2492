// Springs between particles in columns, as soft_step solves them: cloth, nets and ropes. A particle
// has no rotational inertia, so a spring's response is constant throughout a step except for the
// line along which it pulls.
#pragma once

#include "engine/dynamics/columns.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// 16 springs of one colour: no two share a particle. Unused lanes are zero.
struct SpringBlock {
    // A soft row: change = -mass (speed + softness impulse).
    struct Row {
        Column mass;
        Column softness;
        // The starting impulse for a speed of 1 m/s.
        Column of_speed;
    };
    std::size_t used = 0;
    Real rate = Real(0);     // 1 / substep (1/s)
    bool any_swift = false;  // some are swift (SpringTime); then all are solved that way
    bool any_damped = false; // some have damping
    IndexColumn a;
    IndexColumn b;
    Column inv_mass_a;
    Column inv_mass_b;
    Column rest_length;
    Column time;       // into the substep, at which the pull is evaluated (s)
    Column of_stretch; // impulse before the move per stretch (N s/m)
    Column guessed;    // the share of it that the passes start with
    Column answer;     // how much each N s of it lowers the demand, by the speed it causes
    Column of_both;    // impulses before and after the move, as a multiple of that before
    Row damping;
    Columns3 line;  // from a to b at the start of the substep (m)
    Column length;  // of the line
    Columns3 pull;  // the impulse before the move (N s, on b)
    Columns3 axis;  // of the damping, unit
    Column impulse; // of the damping, on b (N s)
};

// Solved colour by colour; blocks of one colour share no particle.
struct SpringSchedule {
    std::vector<SpringBlock> blocks;
    std::vector<std::uint32_t> colour_ends;
    std::vector<std::uint32_t> springs;             // in columns: indices in the model
    std::vector<std::uint32_t> lanes;               // spring of each lane of each block
    std::vector<std::uint8_t> colour_of_spring;     // of each of `springs`
    std::vector<std::uint64_t> colours_of_particle; // bit c: it has a spring of colour c
    std::vector<std::uint32_t> sizes;               // of each colour
    int passes = 1;                                 // needed by all springs, in columns or not
};

// Particle positions and velocities as the kernels read them: six Reals per particle.
struct ParticleReals {
    Real *first = nullptr;
    static constexpr int position = 0;
    static constexpr int velocity = 3;
    static constexpr int stride = 6;
};

// Energy is returned to a spring's ends only if they have this many times as much (see
// returned_impulse).
inline constexpr Real had_for_given = Real(10);

// pull: before the move. damping: after it.
enum class SpringPart { pull, damping };

// Prepares the springs in schedule.springs. The other functions do nothing where there are no
// blocks.
void prepare_spring_columns(StepContext &context, Real h);
// Sets the impulses that passes start with at the present velocities; for `pull`, also the lines.
void aim_spring_columns(StepContext &context, SpringPart part);
// Applies them.
void begin_spring_columns(StepContext &context, SpringPart part);
void solve_spring_columns(StepContext &context, SpringPart part);
// Applies the impulses after the move.
void repeat_spring_columns(StepContext &context);

// Compiled for each instruction set (spring_kernels.cpp).
namespace kernels {
void aim(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void begin(std::span<const SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void solve(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void repeat(std::span<SpringBlock> blocks, const ParticleReals &particles);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
