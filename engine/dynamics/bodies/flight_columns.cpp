#include "engine/dynamics/bodies/flight_columns.h"

#include "engine/dynamics/bodies/drive.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <bit>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A few microseconds of work.
constexpr std::size_t blocks_a_part = 4;

void set_bit(std::uint16_t &mask, std::size_t lane, bool value) {
    const unsigned bit = 1U << lane;
    mask = static_cast<std::uint16_t>(value ? mask | bit : mask & ~bit);
}
bool has_bit(unsigned mask, std::size_t lane) {
    return ((mask >> lane) & 1U) != 0;
}

// Calls use(lane) for each bit that is set.
template <typename Use> void for_lanes(unsigned mask, const Use &use) {
    for (; mask != 0; mask &= mask - 1)
        use(static_cast<std::size_t>(std::countr_zero(mask)));
}

// The lanes that are to be advanced one by one.
unsigned alone(const FlightBlock &block) {
    const unsigned used = (1U << block.used) - 1U;
    return used & (~unsigned{block.in_lanes} | block.left);
}

// The axis across which both moments are equal, the first if there are several; 3: none.
int symmetry_axis_of(const Vec3 &inertia) {
    for (int k = 0; k < 3; ++k)
        if (inertia[(k + 1) % 3] == inertia[(k + 2) % 3])
            return k;
    return 3;
}

void fill_lane(FlightBlock &block, std::size_t lane, const Body &body, const Drive &drive, Real h) {
    const bool is_odd =
        body.has_locks || is_isotropic(body.inertia) != is_isotropic(body.inv_inertia);
    set_bit(block.in_lanes, lane, drive.is_dynamic && !is_odd);
    set_bit(block.gyroscopic, lane, drive.is_gyroscopic && !is_odd);
    set_bit(block.spin_damped, lane, body.angular_damping > Real(0));
    block.mean_kept.lanes[lane] = drive.mean_kept;
    block.late_kept.lanes[lane] = drive.late_kept;
    set(block.mean_gain, lane, drive.mean_gain);
    set(block.late_gain, lane, drive.late_gain);
    block.spin_kept.lanes[lane] = drive.angular.kept;
    block.mean_spin_kept.lanes[lane] = drive.angular.mean_kept;
    set(block.inertia, lane, body.inertia);
    set(block.inv_inertia, lane, body.inv_inertia);
    const int axis = symmetry_axis_of(body.inertia);
    block.symmetry_axis.lanes[lane] = static_cast<Real>(axis);
    const Real across = body.inertia[(axis + 1) % 3];
    const Real along = body.inertia[axis % 3];
    block.precession.lanes[lane] =
        axis < 3 && across > Real(0) ? Real(0.5) * h * (across - along) / across : Real(0);
}

FreeFlight flight_of(const FlightBlock &block, std::size_t lane) {
    FreeFlight flight;
    flight.velocity = get(block.velocity, lane);
    flight.angular_velocity = get(block.angular_velocity, lane);
    flight.mean_velocity = get(block.mean_velocity, lane);
    flight.late_velocity = get(block.late_velocity, lane);
    flight.start_spin = get(block.start_spin, lane);
    flight.mean_spin = get(block.mean_spin, lane);
    flight.end_spin = get(block.end_spin, lane);
    flight.late_spin = get(block.late_spin, lane);
    flight.loaded = has_bit(block.loaded, lane);
    return flight;
}

void set_flight(FlightBlock &block, std::size_t lane, const FreeFlight &flight) {
    set(block.velocity, lane, flight.velocity);
    set(block.angular_velocity, lane, flight.angular_velocity);
    set(block.mean_velocity, lane, flight.mean_velocity);
    set(block.late_velocity, lane, flight.late_velocity);
    set(block.start_spin, lane, flight.start_spin);
    set(block.mean_spin, lane, flight.mean_spin);
    set(block.end_spin, lane, flight.end_spin);
    set(block.late_spin, lane, flight.late_spin);
}

// The moving body in a lane of the block of that number.
std::uint32_t body_in(const StepContext &context, std::size_t block, std::size_t lane) {
    return context.moving()[block * column_lanes + lane];
}

// Which bodies are held, as of the last substep's impulses.
void note_what_holds(const StepContext &context, FlightBlock &block, std::size_t number) {
    const std::vector<GeometricStiffness> &stiffness = context.scratch.stiffness;
    block.jointed = block.sprung = 0;
    if (stiffness.empty() && !context.active.has_particles)
        return;
    for (std::size_t lane = 0; lane < block.used; ++lane) {
        const std::uint32_t body = body_in(context, number, lane);
        set_bit(block.jointed, lane, !stiffness.empty() && stiffness[body].most > Real(0));
        set_bit(block.sprung, lane,
                context.active.has_particles && context.scratch.spring_rates[body].x > Real(0));
    }
}

// Calls use(block, number) for all blocks.
template <typename Use> void for_flights(StepContext &context, const Use &use) {
    std::vector<FlightBlock> &blocks = context.scratch.flight_blocks;
    for_parts(context.tasks, blocks.size(), blocks_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            use(blocks[i], i);
    });
}

} // namespace

void prepare_flight_columns(StepContext &context, const Vec3 &gravity, Real h) {
    const std::span<const std::uint32_t> moving = context.moving();
    context.scratch.flight_blocks.resize((moving.size() + column_lanes - 1) / column_lanes);
    for_flights(context, [&](FlightBlock &block, std::size_t number) {
        const std::size_t first = number * column_lanes;
        block.used = std::min(column_lanes, moving.size() - first);
        block.in_lanes = block.gyroscopic = block.spin_damped = block.loaded = 0;
        for (std::size_t lane = 0; lane < column_lanes; ++lane) {
            const bool is_used = lane < block.used;
            const std::uint32_t index = moving[first + (is_used ? lane : 0)];
            const Body &body = context.model.bodies[index];
            block.body.lanes[lane] = static_cast<IndexColumn::Index>(index * BodyReals::stride);
            block.rounded_off.lanes[lane] =
                static_cast<IndexColumn::Index>(index * (sizeof(RoundedOff) / sizeof(Real)));
            if (is_used)
                fill_lane(block, lane, body, drive_of(body, gravity, h), h);
        }
    });
}

void begin_flight_columns(StepContext &context, const Vec3 &gravity, Real h) {
    attract_and_twist(context, Real(0.5) * h);
    const BodyReals reals = reals_of(context.bodies);
    const int iterations = context.settings.gyroscopic_iterations;
    for_flights(context, [&](FlightBlock &block, std::size_t number) {
        kernels::begin({&block, 1}, reals, h, iterations);
        for_lanes(alone(block), [&](std::size_t lane) {
            const std::uint32_t body = body_in(context, number, lane);
            set_flight(block, lane,
                       begin_flight(context.bodies[body], context.model.bodies[body], gravity, h,
                                    Kick::around, iterations));
        });
    });
    context.report.body_passes += context.moving().size();
}

void note_lasting_loads(StepContext &context) {
    std::vector<FlightBlock> &blocks = context.scratch.flight_blocks;
    for (std::size_t number = 0; number < blocks.size(); ++number) {
        FlightBlock &block = blocks[number];
        for (std::size_t lane = 0; lane < block.used; ++lane)
            set_bit(block.loaded, lane,
                    context.bodies[body_in(context, number, lane)].angular_velocity !=
                        get(block.angular_velocity, lane));
    }
}

void end_flight_columns(StepContext &context, Real h) {
    const BodyReals reals = reals_of(context.bodies);
    std::vector<RoundedOff> &rounded_off = context.scratch.rounded_off;
    const int iterations = context.settings.gyroscopic_iterations;
    for_flights(context, [&](FlightBlock &block, std::size_t number) {
        note_what_holds(context, block, number);
        kernels::end({&block, 1}, reals, &rounded_off.front().position.x, h, iterations);
        for_lanes(block.far, [&](std::size_t lane) {
            const std::uint32_t index = body_in(context, number, lane);
            track_turn(context.bodies[index], context.starts[index]);
        });
        for_lanes(alone(block), [&](std::size_t lane) {
            const std::uint32_t index = body_in(context, number, lane);
            SolverBody &motion = context.bodies[index];
            const Body &body = context.model.bodies[index];
            FreeFlight flight = flight_of(block, lane);
            move_held(
                motion, rounded_off[index], body, flight, h, iterations,
                {.joints = has_bit(block.jointed, lane), .springs = has_bit(block.sprung, lane)});
            track_turn(motion, context.starts[index]);
            end_flight(motion, body, flight, Kick::around);
        });
    });
    context.report.body_passes += context.moving().size();
    attract_and_twist(context, Real(0.5) * h);
}

} // namespace plumb::inline PLUMB_PRECISION
