// Flights in columns match the functions for single bodies bit for bit.
#include "engine/dynamics/bodies/flight_columns.h"

#include "tests/dynamics/solver_view.h"

#include <bit>
#include <hwy/targets.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// Bodies with all, two or no equal moments, damped or not, with locked axes, forces and torques,
// and kinematic; some spin too fast for the lanes. More than fill a block, but not two.
World many_bodies(Random &random) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    for (int i = 0; i < 45; ++i) {
        const double side = random.next_in(0.1, 1);
        V half{side};
        if (i % 4 == 1)
            half[i / 4 % 3] = random.next_in(0.1, 1);
        else if (i % 4 != 0)
            half = {random.next_in(0.05, 1), random.next_in(0.05, 1), random.next_in(0.05, 1)};
        BodyDef def = dynamic_body(block(half), random.next_in(0.1, 10), any_vector(random, 100),
                                   any_vector(random, 10));
        def.pose.rotation = narrow(any_rotation(random));
        const double speed = std::pow(10.0, random.next_in(-3, 3));
        def.angular_velocity = narrow(any_vector(random, i % 6 == 0 ? 0 : speed));
        if (i % 5 == 0)
            def.angular_damping = Real(random.next_in(0, 3));
        if (i % 7 == 0)
            def.linear_damping = Real(random.next_in(0, 3));
        if (i % 8 == 0)
            def.force = narrow(any_vector(random, 10));
        if (i % 9 == 0)
            def.torque = narrow(any_vector(random, 10));
        if (i % 11 == 0)
            def.locked[static_cast<std::size_t>(i % 6)] = true;
        if (i % 13 == 0) {
            def.kind = BodyKind::kinematic;
            def.mass.reset();
            def.locked = {};
            def.force = def.torque = Vec3{Real(0)};
        }
        world.add_body(def);
    }
    return world;
}

// What a solver may do between the two halves of a flight; the same for the same seed.
void push(SolverView &view, std::uint64_t seed, bool warm) {
    Random random(seed);
    for (const std::uint32_t i : view.context.moving()) {
        const bool is_pushed = random.next_index(warm ? 3 : 2) == 0;
        const V linear = any_vector(random, 0.1);
        const V angular = any_vector(random, random.next_index(2) == 0 ? 0.0 : 0.1);
        if (!is_pushed)
            continue;
        view.bodies[i].velocity += narrow(linear);
        view.bodies[i].angular_velocity += narrow(angular);
    }
}

void hold_some(SolverView &view, std::uint64_t seed) {
    Random random(seed);
    view.scratch.stiffness.assign(view.bodies.size(), GeometricStiffness{});
    for (GeometricStiffness &stiffness : view.scratch.stiffness)
        stiffness.most = random.next_index(4) == 0 ? Real(1) : Real(0);
    view.group.has_particles = true;
    view.scratch.spring_rates.assign(view.bodies.size(), Vec2{Real(0)});
    for (Vec2 &rates : view.scratch.spring_rates)
        rates.x = random.next_index(4) == 0 ? Real(1) : Real(0);
}

// As the columns do it, one by one.
void fly_one_by_one(SolverView &view, const Vec3 &gravity, Real h, std::uint64_t seed) {
    StepContext &context = view.context;
    const int iterations = view.settings.gyroscopic_iterations;
    std::vector<FreeFlight> flights;
    attract_and_twist(context, Real(0.5) * h);
    for (const std::uint32_t i : context.moving())
        flights.push_back(begin_flight(view.bodies[i], context.model.bodies[i], gravity, h,
                                       Kick::around, iterations));
    push(view, seed, true);
    for (std::size_t k = 0; k < flights.size(); ++k)
        flights[k].loaded =
            view.bodies[context.moving()[k]].angular_velocity != flights[k].angular_velocity;
    push(view, seed + 1, false);
    for (std::size_t k = 0; k < flights.size(); ++k) {
        const std::uint32_t i = context.moving()[k];
        const HeldBy held_by{.joints = view.scratch.stiffness[i].most > Real(0),
                             .springs = view.scratch.spring_rates[i].x > Real(0)};
        move_held(view.bodies[i], view.scratch.rounded_off[i], context.model.bodies[i], flights[k],
                  h, iterations, held_by);
        track_turn(view.bodies[i], context.starts[i]);
        end_flight(view.bodies[i], context.model.bodies[i], flights[k], Kick::around);
    }
    attract_and_twist(context, Real(0.5) * h);
}

void fly_in_columns(SolverView &view, const Vec3 &gravity, Real h, std::uint64_t seed) {
    begin_flight_columns(view.context, gravity, h);
    push(view, seed, true);
    note_lasting_loads(view.context);
    push(view, seed + 1, false);
    end_flight_columns(view.context, h);
}

void expect_same(const SolverView &one, const SolverView &other, const std::string &where) {
    for (std::size_t i = 0; i < one.bodies.size(); ++i) {
        const SolverBody &a = one.bodies[i];
        const SolverBody &b = other.bodies[i];
        EXPECT_EQ(a.position, b.position) << where << i;
        EXPECT_EQ(a.rotation, b.rotation) << where << i;
        EXPECT_EQ(a.velocity, b.velocity) << where << i;
        EXPECT_EQ(a.angular_velocity, b.angular_velocity) << where << i;
        EXPECT_EQ(a.inv_inertia, b.inv_inertia) << where << i;
        EXPECT_EQ(a.moved, b.moved) << where << i;
        EXPECT_EQ(a.turned, b.turned) << where << i;
        EXPECT_EQ(one.scratch.rounded_off[i].position, other.scratch.rounded_off[i].position)
            << where << i;
        EXPECT_EQ(one.scratch.rounded_off[i].rotation, other.scratch.rounded_off[i].rotation)
            << where << i;
    }
}

TEST(FlightColumns, MatchSingleBodiesBitForBit) {
    const Vec3 gravity{Real(0.5), Real(-9.81), Real(0)};
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        Random random(12);
        std::size_t in_lanes = 0;
        for (int trial = 0; trial < 20; ++trial) {
            const World world = many_bodies(random);
            SolverView alone(world);
            SolverView columns(world);
            const Real h = Real(1) / Real(trial % 2 == 0 ? 240 : 30);
            prepare_flight_columns(columns.context, gravity, h);
            for (int substep = 0; substep < 5; ++substep) {
                const auto seed = static_cast<std::uint64_t>(100 * trial + 2 * substep);
                hold_some(alone, seed);
                hold_some(columns, seed);
                fly_one_by_one(alone, gravity, h, seed);
                fly_in_columns(columns, gravity, h, seed);
                for (const FlightBlock &block : columns.scratch.flight_blocks)
                    in_lanes += static_cast<std::size_t>(
                        std::popcount(unsigned{block.in_lanes} & ~unsigned{block.left}));
            }
            expect_same(alone, columns, std::string(hwy::TargetName(target)) + ", body ");
        }
        // Not by leaving all of them to the other functions.
        EXPECT_GT(in_lanes, sizeof(Real) == 4 ? 20U * 5 * 25 : 20U * 5 * 12);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
