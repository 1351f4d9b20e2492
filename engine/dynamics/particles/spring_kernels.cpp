// soft_step's work on a block of springs between particles. Compiled once for each instruction set,
// by including itself.
#include "engine/dynamics/particles/spring_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/particles/spring_kernels.cpp"
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

// Both particles of the springs in one vector's lanes.
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
    Vector middle;
    Lanes across;
    Vector impulse;
};

// As pull_of in spring_constraint.cpp.
HWY_INLINE Pull pull_of(const SpringBlock &block, const Vector &line, const Vector &half_move,
                        std::size_t lane) {
    const Vector middle = plus(line, half_move);
    const Vector after = plus(middle, half_move);
    const Lanes lengths = hn::Add(load(block.length, lane), hn::Sqrt(dot(after, after)));
    const Lanes rest = load(block.rest_length, lane);
    const Lanes across = hn::Sub(all(Real(1)), quotient(hn::Add(rest, rest), lengths));
    return {middle, across, times(hn::Neg(hn::Mul(load(block.of_stretch, lane), across)), middle)};
}

void aim_pull(SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector line = lines(block, particles, lane);
        store(line, block.line, lane);
        store(hn::Sqrt(dot(line, line)), block.length, lane);
        Vector half_move{hn::Zero(tag), hn::Zero(tag), hn::Zero(tag)};
        if (block.any_swift) {
            const Ends ends = velocities(block, particles, lane);
            half_move = times(load(block.time, lane), minus(ends.b, ends.a));
        }
        const Pull pull = pull_of(block, line, half_move, lane);
        store(times(load(block.guessed, lane), pull.impulse), block.pull, lane);
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

void begin_impl(const SpringBlock &block, const ParticleReals &particles, SpringPart part) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag))
        apply(velocities(block, particles, lane),
              part == SpringPart::pull ? load(block.pull, lane)
                                       : times(load(block.impulse, lane), load(block.axis, lane)),
              block, particles, lane);
}

// As solve_midpoint in spring_constraint.cpp: the slope is one number along the line and one across
// it.
void solve_pull(SpringBlock &block, const ParticleReals &particles) {
    const Lanes one = all(Real(1));
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Ends ends = velocities(block, particles, lane);
        const Pull pull = pull_of(block, load(block.line, lane),
                                  times(load(block.time, lane), minus(ends.b, ends.a)), lane);
        const Vector before = load(block.pull, lane);
        const Vector missing = minus(pull.impulse, before);
        const Lanes answer = load(block.answer, lane);
        const Lanes along = hn::Div(one, hn::Add(one, answer));
        const Lanes across =
            hn::Div(one, hn::Add(one, hn::Mul(answer, hn::Max(pull.across, hn::Zero(tag)))));
        const Lanes of_middle = quotient(dot(missing, pull.middle), dot(pull.middle, pull.middle));
        const Vector change = plus(times(across, missing),
                                   times(hn::Mul(hn::Sub(along, across), of_middle), pull.middle));
        store(plus(before, change), block.pull, lane);
        apply(ends, change, block, particles, lane);
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

// returned_impulse (spring_constraint.h), lane by lane.
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

// As repeat in spring_constraint.cpp.
void repeat_slow(const SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector line = lines(block, particles, lane);
        const Lanes across = hn::Sub(
            all(Real(1)), quotient(load(block.rest_length, lane), hn::Sqrt(dot(line, line))));
        apply(velocities(block, particles, lane),
              times(hn::Neg(hn::Mul(load(block.of_stretch, lane), across)), line), block, particles,
              lane);
    }
}

void repeat_swift(const SpringBlock &block, const ParticleReals &particles) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector before = load(block.line, lane);
        const Vector after = lines(block, particles, lane);
        const Vector move = minus(after, before);
        const Pull held = pull_of(block, before, times(all(Real(0.5)), move), lane);
        const Vector first = load(block.pull, lane);
        const Lanes of_both = load(block.of_both, lane);
        const Vector both = times(of_both, first);
        const Lanes gained =
            hn::Mul(all(block.rate), dot(move, times(of_both, minus(first, held.impulse))));
        const Vector rest = minus(both, first);
        Ends ends = velocities(block, particles, lane);
        const Lanes in_a = load(block.inv_mass_a, lane);
        const Lanes in_b = load(block.inv_mass_b, lane);
        ends.a = minus(ends.a, times(in_a, rest));
        ends.b = plus(ends.b, times(in_b, rest));
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
            begin_impl(block, particles, part);
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
        if (block.any_swift)
            repeat_swift(block, particles);
        else
            repeat_slow(block, particles);
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
