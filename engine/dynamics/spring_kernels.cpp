// What soft_step does with a block of springs between particles. Compiled once for each instruction
// set, by including itself.
#include "engine/dynamics/spring_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/spring_kernels.cpp"
// Vectors of unknown size cannot stand in structs.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/dynamics/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace columns::HWY_NAMESPACE; // NOLINT(google-build-using-namespace)

// The two particles of the springs in the lanes of one vector.
struct Ends {
    Vector a, b; // velocities

    HWY_INLINE Lanes speed_along(const Vector &axis) const { return dot(minus(b, a), axis); }
};

HWY_INLINE Ends velocities(const SpringBlock &block, const ParticleReals &particles,
                           std::size_t lane) {
    return {gather(particles.first, ParticleReals::velocity, load(block.a, lane)),
            gather(particles.first, ParticleReals::velocity, load(block.b, lane))};
}

HWY_INLINE void apply(Ends ends, const Vector &impulse, const SpringBlock &block,
                      const ParticleReals &particles, std::size_t lane) {
    ends.a = minus(ends.a, times(load(block.inv_mass_a, lane), impulse));
    ends.b = plus(ends.b, times(load(block.inv_mass_b, lane), impulse));
    const unsigned used = (1U << block.used) - 1;
    scatter(ends.a, particles.first, ParticleReals::velocity, block.a, used, lane);
    scatter(ends.b, particles.first, ParticleReals::velocity, block.b, used, lane);
}

// Stores the lines as they are now; says how far the springs are stretched, 0 where there is no
// line.
HWY_INLINE Lanes align(SpringBlock &block, const ParticleReals &particles, std::size_t lane) {
    const Vector line =
        minus(gather(particles.first, ParticleReals::position, load(block.b, lane)),
              gather(particles.first, ParticleReals::position, load(block.a, lane)));
    const Lanes length = hn::Sqrt(dot(line, line));
    const auto apart = hn::Gt(length, hn::Zero(tag));
    const Lanes scale = hn::IfThenElseZero(
        apart, hn::Div(all(Real(1)), hn::IfThenElse(apart, length, all(Real(1)))));
    store(times(scale, line), block.axis, lane);
    return hn::IfThenElseZero(apart, hn::Sub(length, load(block.rest_length, lane)));
}

void aim_pull(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Lanes stretch = align(block, particles, lane);
        store(stretch, block.stretch, lane);
        Lanes impulse = hn::Neg(hn::Mul(load(block.of_stretch, lane), stretch));
        if (block.any_stiff) {
            const Lanes speed =
                velocities(block, particles, lane).speed_along(load(block.axis, lane));
            impulse = hn::Sub(impulse, hn::Mul(load(block.pull.of_speed, lane), speed));
        }
        store(impulse, block.impulse, lane);
    }
}

void aim_damping(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Lanes speed = velocities(block, particles, lane).speed_along(load(block.axis, lane));
        store(hn::Neg(hn::Mul(load(block.damping.of_speed, lane), speed)), block.impulse, lane);
    }
}

void begin_impl(const SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag))
        apply(velocities(block, particles, lane),
              times(load(block.impulse, lane), load(block.axis, lane)), block, particles, lane);
}

void solve_impl(SpringBlock &block, const ParticleReals &particles, SpringPart part) {
    const bool pulls = part == SpringPart::pull;
    const SpringBlock::Row &row = pulls ? block.pull : block.damping;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector axis = load(block.axis, lane);
        const Ends ends = velocities(block, particles, lane);
        const Lanes before = load(block.impulse, lane);
        Lanes error = hn::Add(ends.speed_along(axis), hn::Mul(load(row.softness, lane), before));
        if (pulls)
            error = hn::Add(error, hn::Mul(load(block.bias_rate, lane), load(block.stretch, lane)));
        const Lanes change = hn::Neg(hn::Mul(load(row.mass, lane), error));
        store(hn::Add(before, change), block.impulse, lane);
        apply(ends, times(change, axis), block, particles, lane);
    }
}

void repeat_impl(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Lanes stretch = align(block, particles, lane);
        const Lanes impulse =
            hn::Sub(hn::Mul(load(block.repeated, lane), load(block.impulse, lane)),
                    hn::Mul(load(block.of_stretch_after, lane), stretch));
        apply(velocities(block, particles, lane), times(impulse, load(block.axis, lane)), block,
              particles, lane);
    }
}

} // namespace

void aim_springs(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part) {
    for (SpringBlock &block : blocks)
        if (part == SpringPart::pull)
            aim_pull(block, particles);
        else if (block.any_damped)
            aim_damping(block, particles);
}
void begin_springs(std::span<const SpringBlock> blocks, const ParticleReals &particles,
                   SpringPart part) {
    for (const SpringBlock &block : blocks)
        if (part == SpringPart::pull || block.any_damped)
            begin_impl(block, particles);
}
void solve_springs(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part) {
    for (SpringBlock &block : blocks)
        if (part == SpringPart::pull ? block.any_stiff : block.any_damped)
            solve_impl(block, particles, part);
}
void repeat_springs(std::span<SpringBlock> blocks, const ParticleReals &particles) {
    for (SpringBlock &block : blocks)
        repeat_impl(block, particles);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(aim_springs);
HWY_EXPORT(begin_springs);
HWY_EXPORT(solve_springs);
HWY_EXPORT(repeat_springs);

void aim(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part) {
    HWY_DYNAMIC_DISPATCH(aim_springs)(blocks, particles, part);
}
void begin(std::span<const SpringBlock> blocks, const ParticleReals &particles, SpringPart part) {
    HWY_DYNAMIC_DISPATCH(begin_springs)(blocks, particles, part);
}
void solve(std::span<SpringBlock> blocks, const ParticleReals &particles, SpringPart part) {
    HWY_DYNAMIC_DISPATCH(solve_springs)(blocks, particles, part);
}
void repeat(std::span<SpringBlock> blocks, const ParticleReals &particles) {
    HWY_DYNAMIC_DISPATCH(repeat_springs)(blocks, particles);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
