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

HWY_INLINE Vector lines(const SpringBlock &block, const ParticleReals &particles,
                        std::size_t lane) {
    return minus(gather(particles.first, ParticleReals::position, load(block.b, lane)),
                 gather(particles.first, ParticleReals::position, load(block.a, lane)));
}

HWY_INLINE Lanes quotient(Lanes x, Lanes y) {
    const auto any = hn::Gt(y, hn::Zero(tag));
    return hn::IfThenElseZero(any, hn::Div(x, hn::IfThenElse(any, y, all(Real(1)))));
}

struct Pull {
    Vector axis;
    Lanes impulse; // of the spring's share of the substep, along it
};

// As pull_of in particle_constraint.cpp.
HWY_INLINE Pull pull_of(const SpringBlock &block, const Vector &line, const Vector &half_move,
                        std::size_t lane) {
    const Vector middle = plus(line, half_move);
    const Vector after = plus(middle, half_move);
    const Lanes lengths = hn::Add(load(block.length, lane), hn::Sqrt(dot(after, after)));
    const Lanes distance = hn::Sqrt(dot(middle, middle));
    const Lanes share = quotient(distance, lengths);
    const Lanes stretch =
        hn::Sub(distance, hn::Mul(hn::Add(share, share), load(block.rest_length, lane)));
    return {times(quotient(all(Real(1)), distance), middle),
            hn::Neg(hn::Mul(load(block.of_stretch, lane), stretch))};
}

void aim_pull(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector line = lines(block, particles, lane);
        store(line, block.line, lane);
        store(hn::Sqrt(dot(line, line)), block.length, lane);
        const Ends ends = velocities(block, particles, lane);
        const Pull pull =
            pull_of(block, line, times(load(block.time, lane), minus(ends.b, ends.a)), lane);
        store(pull.axis, block.axis, lane);
        store(hn::Mul(load(block.guessed, lane), pull.impulse), block.impulse, lane);
    }
}

void aim_damping(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector line = lines(block, particles, lane);
        store(times(quotient(all(Real(1)), hn::Sqrt(dot(line, line))), line), block.axis, lane);
        const Lanes speed = velocities(block, particles, lane).speed_along(load(block.axis, lane));
        store(hn::Neg(hn::Mul(load(block.damping.of_speed, lane), speed)), block.impulse, lane);
    }
}

void begin_impl(const SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag))
        apply(velocities(block, particles, lane),
              times(load(block.impulse, lane), load(block.axis, lane)), block, particles, lane);
}

void solve_pull(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Ends ends = velocities(block, particles, lane);
        const Pull pull = pull_of(block, load(block.line, lane),
                                  times(load(block.time, lane), minus(ends.b, ends.a)), lane);
        const Vector before = times(load(block.impulse, lane), load(block.axis, lane));
        const Lanes along = dot(before, pull.axis);
        const Lanes now =
            hn::Add(along, hn::Mul(load(block.answer, lane), hn::Sub(pull.impulse, along)));
        store(pull.axis, block.axis, lane);
        store(now, block.impulse, lane);
        apply(ends, minus(times(now, pull.axis), before), block, particles, lane);
    }
}

void solve_damping(SpringBlock &block, const ParticleReals &particles) {
    const SpringBlock::Row &row = block.damping;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector axis = load(block.axis, lane);
        const Ends ends = velocities(block, particles, lane);
        const Lanes before = load(block.impulse, lane);
        const Lanes error =
            hn::Add(ends.speed_along(axis), hn::Mul(load(row.softness, lane), before));
        const Lanes change = hn::Neg(hn::Mul(load(row.mass, lane), error));
        store(hn::Add(before, change), block.impulse, lane);
        apply(ends, times(change, axis), block, particles, lane);
    }
}

// returned_impulse (particle_constraint.h), lane by lane.
HWY_INLINE Lanes returned(Lanes speed, Lanes inverse, Lanes gained) {
    const Lanes zero = hn::Zero(tag);
    const Lanes squared = hn::Mul(speed, speed);
    const Lanes change = hn::Mul(all(Real(2)), hn::Mul(inverse, gained));
    const Lanes root = hn::CopySign(hn::Sqrt(hn::Max(zero, hn::Sub(squared, change))), speed);
    const Lanes sum = hn::Add(speed, root);
    const auto does = hn::And(hn::Gt(hn::Add(squared, hn::Mul(all(had_for_given), change)), zero),
                              hn::Ne(sum, zero));
    const Lanes taken = hn::IfThenElse(hn::Gt(change, squared), quotient(squared, inverse),
                                       hn::Mul(all(Real(2)), gained));
    return hn::IfThenElseZero(does,
                              hn::Neg(hn::Div(taken, hn::IfThenElse(does, sum, all(Real(1))))));
}

void repeat_impl(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector before = load(block.line, lane);
        const Vector after = lines(block, particles, lane);
        const Vector move = minus(after, before);
        const Pull pull = pull_of(block, before, times(all(Real(0.5)), move), lane);
        const Vector first = times(load(block.impulse, lane), load(block.axis, lane));
        const Vector both = times(load(block.of_both, lane), first);
        const Vector impulse = minus(both, first);
        const Vector held = times(load(block.of_both, lane), times(pull.impulse, pull.axis));
        const Lanes gained = hn::Mul(all(block.rate), dot(move, minus(both, held)));
        Ends ends = velocities(block, particles, lane);
        const Lanes in_a = load(block.inv_mass_a, lane);
        const Lanes in_b = load(block.inv_mass_b, lane);
        ends.a = minus(ends.a, times(in_a, impulse));
        ends.b = plus(ends.b, times(in_b, impulse));
        const Vector axis = times(quotient(all(Real(1)), hn::Sqrt(dot(after, after))), after);
        const Lanes back = returned(ends.speed_along(axis), hn::Add(in_a, in_b), gained);
        apply(ends, times(back, axis), block, particles, lane);
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
        if (part == SpringPart::pull) {
            if (block.any_swift)
                solve_pull(block, particles);
        } else if (block.any_damped)
            solve_damping(block, particles);
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
