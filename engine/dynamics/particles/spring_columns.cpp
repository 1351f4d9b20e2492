#include "engine/dynamics/particles/spring_columns.h"

#include "engine/dynamics/colours.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <bit>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::size_t colours = 64;
// Springs that find no free colour are solved one by one, each in its own block.
constexpr std::size_t alone = colours;
constexpr std::uint32_t none = UINT32_MAX;

ParticleReals reals_of(std::span<ParticleMotion> particles) {
    static_assert(sizeof(ParticleMotion) == ParticleReals::stride * sizeof(Real));
    return {particles.empty() ? nullptr : &particles.front().position.x};
}

template <class Use> void for_blocks(StepContext &context, Use &&use) {
    for_blocks(context.tasks, std::span(context.scratch.spring_schedule.blocks), use);
}
template <class Use> void for_colours(StepContext &context, Use &&use) {
    SpringSchedule &schedule = context.scratch.spring_schedule;
    for_colours(context.tasks, std::span(schedule.blocks), schedule.colour_ends, use);
}

// The first colour free at both particles, in the order of the model's springs.
void colour(const Model &model, SpringSchedule &schedule) {
    schedule.sizes.assign(colours + 1, 0);
    schedule.colours_of_particle.assign(model.particles.size(), 0);
    schedule.colour_of_spring.clear();
    for (const std::uint32_t i : schedule.springs) {
        std::uint64_t &of_a = schedule.colours_of_particle[model.springs[i].a.index];
        std::uint64_t &of_b = schedule.colours_of_particle[model.springs[i].b.index];
        const auto chosen = static_cast<std::uint8_t>(std::countr_one(of_a | of_b));
        if (chosen < alone) {
            of_a |= std::uint64_t{1} << chosen;
            of_b |= std::uint64_t{1} << chosen;
        }
        schedule.colour_of_spring.push_back(chosen);
        ++schedule.sizes[chosen];
    }
}

// Assigns springs to lanes.
void arrange(SpringSchedule &schedule) {
    constexpr auto width = static_cast<std::uint32_t>(column_lanes);
    std::uint32_t block_count = 0;
    std::vector<std::uint32_t> &next = schedule.sizes; // becomes: the colour's next lane
    for (std::size_t c = 0; c <= alone; ++c) {
        const std::uint32_t size = next[c];
        next[c] = block_count * width;
        block_count += c == alone ? size : (size + width - 1) / width;
        if (c < alone && size > 0)
            schedule.colour_ends.push_back(block_count);
    }
    schedule.lanes.assign(std::size_t{block_count} * width, none);
    for (std::size_t k = 0; k < schedule.springs.size(); ++k) {
        const std::uint8_t c = schedule.colour_of_spring[k];
        schedule.lanes[next[c]] = schedule.springs[k];
        next[c] += c == alone ? width : 1;
    }
    schedule.blocks.resize(block_count);
}

void fill_lane(const StepContext &context, SpringBlock &block, std::uint32_t index, Real h) {
    const Spring &spring = context.model.springs[index];
    const std::size_t lane = block.used++;
    const Particle &a = context.model.particles[spring.a.index];
    const Particle &b = context.model.particles[spring.b.index];
    const auto place = [](std::uint32_t particle) {
        return static_cast<IndexColumn::Index>(particle * ParticleReals::stride);
    };
    block.a.lanes[lane] = place(spring.a.index);
    block.b.lanes[lane] = place(spring.b.index);
    block.inv_mass_a.lanes[lane] = a.inv_mass;
    block.inv_mass_b.lanes[lane] = b.inv_mass;
    block.rest_length.lanes[lane] = spring.rest_length;
    block.rate = Real(1) / h;
    const Real inverse = a.inv_mass + b.inv_mass;
    if (!(inverse > Real(0)))
        return;
    const SpringTime time = spring_time(context, spring, h, SpringRule::midpoint);
    const Real ahead = time.share * h;
    block.any_swift = block.any_swift || time.is_swift;
    block.time.lanes[lane] = ahead;
    block.of_stretch.lanes[lane] = ahead * spring.stiffness;
    block.guessed.lanes[lane] = time.guessed;
    block.answer.lanes[lane] = ahead * ahead * spring.stiffness * inverse;
    block.of_both.lanes[lane] = Real(1) / time.share;
    const Real damping = h * spring.damping;
    if (damping > Real(0)) {
        block.any_damped = true;
        const Real softness = decay_softness(inverse, damping);
        block.damping.softness.lanes[lane] = softness;
        block.damping.mass.lanes[lane] = Real(1) / (inverse + softness);
        block.damping.of_speed.lanes[lane] = time.damped * damping;
    }
}

} // namespace

void prepare_spring_columns(StepContext &context, Real h) {
    SpringSchedule &schedule = context.scratch.spring_schedule;
    schedule.blocks.clear();
    schedule.colour_ends.clear();
    if (schedule.springs.empty())
        return;
    colour(context.model, schedule);
    arrange(schedule);
    for_blocks(context, [&](std::span<SpringBlock> blocks) {
        const auto first = static_cast<std::size_t>(blocks.data() - schedule.blocks.data());
        const std::uint32_t *spring = schedule.lanes.data() + first * column_lanes;
        for (SpringBlock &block : blocks) {
            block = SpringBlock{};
            for (std::size_t lane = 0; lane < column_lanes; ++lane, ++spring)
                if (*spring != none)
                    fill_lane(context, block, *spring, h);
        }
    });
}

void aim_spring_columns(StepContext &context, SpringPart part) {
    const ParticleReals particles = reals_of(context.particles);
    for_blocks(context,
               [&](std::span<SpringBlock> blocks) { kernels::aim(blocks, particles, part); });
}

void begin_spring_columns(StepContext &context, SpringPart part) {
    const ParticleReals particles = reals_of(context.particles);
    for_colours(context,
                [&](std::span<SpringBlock> blocks) { kernels::begin(blocks, particles, part); });
}

void solve_spring_columns(StepContext &context, SpringPart part) {
    const ParticleReals particles = reals_of(context.particles);
    for_colours(context,
                [&](std::span<SpringBlock> blocks) { kernels::solve(blocks, particles, part); });
}

void repeat_spring_columns(StepContext &context) {
    const ParticleReals particles = reals_of(context.particles);
    for_colours(context,
                [&](std::span<SpringBlock> blocks) { kernels::repeat(blocks, particles); });
}

} // namespace plumb::inline PLUMB_PRECISION
