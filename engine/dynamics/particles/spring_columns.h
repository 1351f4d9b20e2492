// Springs between particles in columns, as soft_step solves them: cloth, nets and ropes. A particle
// has no inertia that turns, so all that says how such a spring answers is the same throughout a
// step, but for the line along which it pulls.
#pragma once

#include "engine/dynamics/columns.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// 16 springs of one colour: none shares a particle with another. Lanes that are not used are zeros.
struct SpringBlock {
    // A soft row: change = -mass (speed + softness impulse).
    struct Row {
        Column mass;
        Column softness;
        // The impulse with which it begins, for a speed of 1 m/s.
        Column of_speed;
    };
    std::size_t used = 0;
    Real rate = Real(0);     // 1 / substep (1/s)
    bool any_swift = false;  // of these springs some are (SpringTime); then all are solved as such
    bool any_damped = false; // some spring that has damping
    IndexColumn a;
    IndexColumn b;
    Column inv_mass_a;
    Column inv_mass_b;
    Column rest_length;
    Column time;       // of the substep, at which the pull is taken (s)
    Column of_stretch; // the impulse before the move, of the stretch (N s/m)
    Column guessed;    // the part of it with which the passes begin
    Column answer;     // how much less each N s of it asks for, by the speed that it makes
    Column of_both;    // the impulses before and after the move, as multiples of that before it
    Row damping;
    Columns3 line;  // from a to b as the substep began (m)
    Column length;  // of that
    Columns3 pull;  // the impulse before the move (N s, on b)
    Columns3 axis;  // unit, of the damping
    Column impulse; // of that, on b (N s)
};

// One colour after another; blocks of one colour share no particle.
struct SpringSchedule {
    std::vector<SpringBlock> blocks;
    std::vector<std::uint32_t> colour_ends;
    std::vector<std::uint32_t> springs;             // that are in columns, in the model
    std::vector<std::uint32_t> lanes;               // spring of each lane of each block
    std::vector<std::uint8_t> colour_of_spring;     // likewise
    std::vector<std::uint64_t> colours_of_particle; // bit c: colour c has a spring of it
    std::vector<std::uint32_t> sizes;               // of the colours
    int passes = 1;                                 // that all springs need, these and others
};

// Positions and velocities as the kernels find them: six Reals a particle.
struct ParticleReals {
    Real *first = nullptr;
    static constexpr int position = 0;
    static constexpr int velocity = 3;
    static constexpr int stride = 6;
};

// Energy is given back to a spring's ends only where they have so many times as much (see
// returned_impulse).
inline constexpr Real had_for_given = Real(10);

// Before the move; after it.
enum class SpringPart { pull, damping };

// Of the springs in schedule.springs. All others do nothing where there are no blocks.
void prepare_spring_columns(StepContext &context, Real h);
// The impulses with which passes begin, for the present velocities; of `pull`, the lines too.
void aim_spring_columns(StepContext &context, SpringPart part);
// Applies those.
void begin_spring_columns(StepContext &context, SpringPart part);
void solve_spring_columns(StepContext &context, SpringPart part);
// The impulses after the move.
void repeat_spring_columns(StepContext &context);

// Compiled for each instruction set (spring_kernels.cpp).
namespace kernels {
void aim(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void begin(std::span<const SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void solve(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void repeat(std::span<SpringBlock> blocks, const ParticleReals &particles);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
