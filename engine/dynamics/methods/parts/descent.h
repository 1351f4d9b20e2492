// Working memory of a method that minimises an energy body by body.
#pragma once

#include "engine/dynamics/methods/parts/augmented_rows.h"
#include "engine/dynamics/particles/particle_constraint.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Something that acts on a body or particle: a joint (index among the active ones and the grab), a
// spring or a contact (index of its constraint).
struct DescentUse {
    enum class Kind : std::uint8_t { joint, spring, particle_contact, contact };
    Kind kind = Kind::joint;
    bool is_b = false; // the body or particle is the second one
    std::uint32_t index = 0;
};

// The uses of all bodies or all particles, back to back.
struct DescentUses {
    std::vector<std::uint32_t> first; // where each one's uses start, then the end
    std::vector<DescentUse> all;
};

// A dynamic body within a substep.
struct DescentBody {
    std::uint32_t body = 0;
    Vec3 free_velocity{Real(0)}; // without any rows (m/s)
    Vec3 free_spin{Real(0)};
    Quat start = identity_rotation;     // at the substep's start
    Quat turn = identity_rotation;      // since then
    Quat free_turn = identity_rotation; // since then, without any rows
    Mat3 inertia{Real(0)};              // kg m^2, world
};

struct Descent {
    std::vector<DescentBody> bodies;
    std::vector<std::uint32_t> place; // per body of the model: index into `bodies`, or UINT32_MAX
    DescentUses body_uses;            // per entry of `bodies`
    DescentUses particle_uses;
    std::vector<AugmentedBlock> blocks; // one per entry of SolverScratch::joints
    std::vector<std::array<AugmentedPoint, 4>> contacts;
    std::vector<AugmentedPoint> particle_contacts;
    std::vector<Vec3> free_velocities; // one per particle
    std::vector<Real> start_lengths;   // one per spring (m)
};

struct StepContext;

// Fills bodies, places and uses. Call after prepare_contacts, prepare_joints and prepare_particles.
void gather_uses(StepContext &context);
std::span<const DescentUse> uses_of(const DescentUses &uses, std::size_t i);

AugmentedBlock &augmented(StepContext &context, const JointConstraint &joint);
// How far a motor's row has moved in the substep (m or rad); 0 for other rows.
Real driven(StepContext &context, const JointConstraint &joint, Real h);

// Relative displacement of a contact's two points in the substep h, along the normal and the
// tangents (m), to first order in the rotations: contacts are a truncated Taylor series about the
// substep's start (Giles, Diaz, Yuksel 2025, sec. 4).
Vec3 way_of(const StepContext &context, const ContactConstraint &contact,
            const ContactPointConstraint &point, Real h);
Vec3 way_of(const StepContext &context, const ParticleContactConstraint &row, Real h);

// One pass over bodies and particles: each moves to the minimum of the energy with the others held
// (same paper, eqs. 4 to 6, 13 and 17).
void descend(StepContext &context, const Stiffening &stiffening);

} // namespace plumb::inline PLUMB_PRECISION
