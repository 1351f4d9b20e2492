// The one acceleration function of the smooth methods: gravity, attractors, springs, constant
// forces and torques, damping and the torque of free spin, at the present state.
#pragma once

#include "engine/dynamics/bodies/body.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// Moving bodies by their place in context.moving(), particles by index; world axes.
struct Accelerations {
    struct OfBody {
        Vec3 linear{Real(0)};
        Vec3 angular{Real(0)};
        Vec3 torque{Real(0)}; // of springs, and its own (N m), about the centre of mass
    };
    std::vector<OfBody> bodies;
    std::vector<Vec3> particles;
};

// Counts one pass over bodies, particles and springs.
void find_accelerations(StepContext &context, Accelerations &out);
// The same without the bodies' angular accelerations, for methods that solve Euler's equations in
// body axes.
void find_linear_accelerations(StepContext &context, Accelerations &out);

// v += h a, with the accelerations at the present state; then x += h v.
void kick_smoothly(StepContext &context, Real h);
void drift_smoothly(StepContext &context, Real h);
// v += h a, with the given accelerations.
void kick_smoothly(StepContext &context, const Accelerations &by, Real h);

// Save and restore velocities, for a second evaluation within a substep.
void remember_velocities(StepContext &context);
void restore_velocities(StepContext &context);

// Whether any acceleration depends on velocities.
bool depend_on_velocities(const StepContext &context);

} // namespace plumb::inline PLUMB_PRECISION
