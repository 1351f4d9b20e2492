// The seam between a world and the methods that advance it.
#pragma once

#include "engine/core/task_pool.h"
#include "engine/dynamics/bodies/flight_columns.h"
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/contacts/contact_columns.h"
#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/events.h"
#include "engine/dynamics/joints/geometric_stiffness.h"
#include "engine/dynamics/joints/joint_columns.h"
#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/joint_system.h"
#include "engine/dynamics/method_info.h"
#include "engine/dynamics/methods/parts/descent.h"
#include "engine/dynamics/methods/parts/implicit_system.h"
#include "engine/dynamics/methods/parts/smooth_forces.h"
#include "engine/dynamics/model.h"
#include "engine/dynamics/particles/particle_constraint.h"
#include "engine/dynamics/particles/spring_columns.h"
#include "engine/dynamics/settings.h"
#include "engine/dynamics/state.h"
#include "engine/dynamics/step_report.h"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A method's working memory within a step, kept from step to step so that nothing is allocated.
struct SolverScratch {
    std::vector<ContactConstraint> contacts;
    std::vector<std::uint32_t> partners; // per body: see find_partners
    ContactSchedule schedule;
    std::vector<JointConstraint> joints;
    std::vector<std::uint8_t> braced;        // per body; empty: none is (bracing.h)
    std::vector<std::uint32_t> first_blocks; // per active joint and the grab: index into `joints`
    JointSchedule joint_schedule;
    JointSystem *joint_system = nullptr;         // of the group being advanced
    std::vector<WideVec3> sides;                 // right-hand sides of its equations, one per place
    std::vector<GeometricStiffness> stiffness;   // per body, from the last substep's impulses
    std::vector<std::uint8_t> changed;           // per body: what follow_loads changed
    std::vector<FreeFlight> flights;             // one per moving body
    std::vector<FlightBlock> flight_blocks;      // the same in columns
    std::vector<RoundedOff> rounded_off;         // one per body
    std::vector<std::array<Vec3, 2>> velocities; // per moving body, saved for pseudo velocities
    std::vector<Vec3> joint_impulses;            // saved for pseudo velocities
    std::vector<Vec3> contact_impulses;          // saved for pseudo velocities
    std::vector<Real> changes;                   // of all impulses in one pass
    std::vector<SpringConstraint> springs;
    SpringSchedule spring_schedule;
    std::vector<ParticleContactConstraint> particle_contacts;
    std::vector<Mat3> particle_stiffness;       // per particle, summed over its springs (N/m)
    std::vector<Vec2> spring_rates;             // see find_spring_rates
    bool has_spring_rates = false;              // at the start of the step
    std::array<Accelerations, 4> accelerations; // for smooth methods
    std::vector<Motion> motions;                // for smooth methods, at the start of the step
    std::vector<ParticleMotion> particle_motions;
    Descent descent;
    ImplicitSystem implicit_system;
};

// A method's input: the world at the start of a step, to be advanced by settings.dt. Contacts hold
// the manifolds at these poses. The method works on copies of the state, so the world is unchanged
// if it throws.
struct StepContext {
    const Model &model;
    const StepSettings &settings;
    std::span<SolverBody> bodies;   // one for each body of the model, holes included
    std::span<const Motion> starts; // the same, at the start of the step
    // What to advance: dynamic and kinematic bodies with their contacts and joints, ascending.
    // Everything left out is advanced separately and shares nothing with these.
    const IslandGroup &active;
    std::span<Contact> contacts;   // ascending by key
    std::span<JointMemory> joints; // one for each joint of the model
    Grab &grab;
    SolverBody &world_frame; // stands in for the world in joints; never moves
    SolverScratch &scratch;
    StepReport &report; // the method counts its work here
    std::vector<Impact> &impacts;
    std::span<ParticleMotion> particles; // one for each particle of the model
    std::span<const std::uint8_t> torn;  // one for each spring of the model
    std::span<const ParticleContact> particle_contacts;
    std::span<const ContactEnds> ends; // one per contact
    // One per contact point and per joint; empty unless the method keeps_penalties.
    std::span<std::array<PointPenalty, 4>> point_penalties;
    std::span<JointPenalty> joint_penalties;
    TaskPool *tasks = nullptr; // null: one thread; the bits are the same either way

    std::span<const std::uint32_t> moving() const { return active.moving; }
    Real substep() const { return static_cast<Real>(settings.dt / settings.substeps); } // s
    SolverBody &body(std::uint32_t index) {
        return index == Joint::world ? world_frame : bodies[index];
    }
};

using AdvanceFunction = void (*)(StepContext &);

// A row of the registry: a method's description and its whole inner loop.
struct Method {
    MethodInfo info;
    AdvanceFunction advance = nullptr;
};

// All methods, in the order used everywhere (methods/registry.cpp).
std::span<const Method> methods();

// Null if no method has that name.
const Method *find_method(std::string_view name);

} // namespace plumb::inline PLUMB_PRECISION
