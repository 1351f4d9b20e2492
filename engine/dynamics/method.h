// The seam between a world and the methods that advance it.
#pragma once

#include "engine/core/task_pool.h"
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

// Memory that a method uses within a step, kept from step to step so that nothing is allocated.
struct SolverScratch {
    std::vector<ContactConstraint> contacts;
    std::vector<std::uint32_t> partners; // of each body: see find_partners
    ContactSchedule schedule;
    std::vector<JointConstraint> joints;
    std::vector<std::uint32_t> first_blocks; // of each active joint and the grab, in `joints`
    JointSchedule joint_schedule;
    JointSystem *joint_system = nullptr;         // of what is being advanced
    std::vector<Vec3> sides;                     // of its equations, one for each place
    std::vector<GeometricStiffness> stiffness;   // of each body, by the last substep's impulses
    std::vector<std::uint8_t> changed;           // likewise: what follow_loads changed
    std::vector<FreeFlight> flights;             // one for each moving body
    std::vector<RoundedOff> rounded_off;         // one for each body
    std::vector<std::array<Vec3, 2>> velocities; // likewise, while pseudo velocities are solved
    std::vector<Vec3> joint_impulses;            // likewise
    std::vector<Vec3> contact_impulses;          // likewise
    std::vector<Real> changes;                   // of all impulses by one pass
    std::vector<SpringConstraint> springs;
    SpringSchedule spring_schedule;
    std::vector<ParticleContactConstraint> particle_contacts;
    std::vector<Mat3> particle_stiffness;       // of each particle, of all its springs (N/m)
    std::vector<Vec2> spring_rates;             // see find_spring_rates
    bool has_spring_rates = false;              // as the step began
    std::array<Accelerations, 4> accelerations; // of smooth methods
    std::vector<Motion> motions;                // likewise, where the step began
    std::vector<ParticleMotion> particle_motions;
    Descent descent;
    ImplicitSystem implicit_system;
};

// What a method is given: the world at the start of a step, to be advanced by settings.dt. Contacts
// hold the manifolds of these poses. The method works on copies of the state: nothing of the world
// has changed if it throws.
struct StepContext {
    const Model &model;
    const StepSettings &settings;
    std::span<SolverBody> bodies;   // one for each body of the model, holes included
    std::span<const Motion> starts; // likewise, as the step began
    // What is to be advanced: dynamic and kinematic bodies, and the contacts and joints that they
    // have; ascending. Those left out are advanced by themselves, and share nothing with these.
    const IslandGroup &active;
    std::span<Contact> contacts;   // ascending by key
    std::span<JointMemory> joints; // one for each joint of the model
    Grab &grab;
    SolverBody &world_frame; // stands for the world in joints: it never moves
    SolverScratch &scratch;
    StepReport &report; // the method counts its work here
    std::vector<Impact> &impacts;
    std::span<ParticleMotion> particles; // one for each particle of the model
    std::span<const std::uint8_t> torn;  // one for each spring of the model
    std::span<const ParticleContact> particle_contacts;
    std::span<const ContactEnds> ends; // of each contact
    // Of each contact's points and of each joint; empty unless the method keeps_penalties.
    std::span<std::array<PointPenalty, 4>> point_penalties;
    std::span<JointPenalty> joint_penalties;
    TaskPool *tasks = nullptr; // null: one thread; with more the bits are the same

    std::span<const std::uint32_t> moving() const { return active.moving; }
    Real substep() const { return static_cast<Real>(settings.dt / settings.substeps); } // s
    SolverBody &body(std::uint32_t index) {
        return index == Joint::world ? world_frame : bodies[index];
    }
};

using AdvanceFunction = void (*)(StepContext &);

// One row of the registry: what a method says about itself, and its whole inner loop.
struct Method {
    MethodInfo info;
    AdvanceFunction advance = nullptr;
};

// All methods, in the order in which they are listed everywhere (methods/registry.cpp).
std::span<const Method> methods();

// Null when there is none of that name.
const Method *find_method(std::string_view name);

} // namespace plumb::inline PLUMB_PRECISION
