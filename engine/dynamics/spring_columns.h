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
    // A soft row: change = -mass (speed + softness impulse [+ what the stretch asks for]).
    struct Row {
        Column mass;
        Column softness;
        // The impulse with which it begins, for a speed of 1 m/s.
        Column of_speed;
    };
    std::size_t used = 0;
    bool any_stiff = false;  // some spring that a substep does not follow (SpringTime)
    bool any_damped = false; // some spring that it follows and that has damping
    IndexColumn a;
    IndexColumn b;
    Column inv_mass_a;
    Column inv_mass_b;
    Column rest_length;
    // Of the stretch (N s/m): the impulse before the move, and that after it.
    Column of_stretch;
    Column of_stretch_after;
    Column repeated;  // of the row's impulse, likewise after the move
    Column bias_rate; // speed that the row of a stiff spring asks for, for its stretch (1/s)
    Row pull;         // of stiff springs
    Row damping;      // of those that a substep follows
    Columns3 axis;    // unit, from a to b; 0 where they are at one point
    Column stretch;   // as the substep began (m)
    Column impulse;   // of the row that is being solved (N s)
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
};

// Positions and velocities as the kernels find them: six Reals a particle.
struct ParticleReals {
    Real *first = nullptr;
    static constexpr int position = 0;
    static constexpr int velocity = 3;
    static constexpr int stride = 6;
};

// The rows of stiff springs, before the move; or those of damping, after it.
enum class SpringPart { pull, damping };

// Of the springs in schedule.springs. All others do nothing where there are no blocks.
void prepare_spring_columns(StepContext &context, Real h);
// The impulses with which rows begin, for the present velocities; of `pull`, the lines and lengths
// too, and what springs that a substep follows give before the move.
void aim_spring_columns(StepContext &context, SpringPart part);
// Applies those.
void begin_spring_columns(StepContext &context, SpringPart part);
void solve_spring_columns(StepContext &context, SpringPart part);
// What springs do in the rest of the substep, along the lines as they are now.
void repeat_spring_columns(StepContext &context);

// Compiled for each instruction set (spring_kernels.cpp).
namespace kernels {
void aim(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void begin(std::span<const SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void solve(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part);
void repeat(std::span<SpringBlock> blocks, const ParticleReals &particles);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
