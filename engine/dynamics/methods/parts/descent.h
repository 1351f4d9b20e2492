// Memory of a method that goes down an energy body by body.
#pragma once

#include "engine/dynamics/methods/parts/augmented_rows.h"
#include "engine/dynamics/particles/particle_constraint.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// What acts on a body or a particle: joint (index among the active ones and the grab), spring and
// contacts (indices of their constraints).
struct DescentUse {
    enum class Kind : std::uint8_t { joint, spring, particle_contact, contact };
    Kind kind = Kind::joint;
    bool is_b = false; // it is the second of the two
    std::uint32_t index = 0;
};

// The uses of each of many, one after the other.
struct DescentUses {
    std::vector<std::uint32_t> first; // of each, and the end
    std::vector<DescentUse> all;
};

// A body within a substep; of those that move by forces.
struct DescentBody {
    std::uint32_t body = 0;
    Vec3 free_velocity{Real(0)}; // that it would have with no rows (m/s)
    Vec3 free_spin{Real(0)};
    Quat start = identity_rotation;     // as the substep began
    Quat turn = identity_rotation;      // since then
    Quat free_turn = identity_rotation; // that it would have turned with no rows
    Mat3 inertia{Real(0)};              // kg m^2, world
};

struct Descent {
    std::vector<DescentBody> bodies;
    std::vector<std::uint32_t> place; // of each body of the model among `bodies`, or UINT32_MAX
    DescentUses body_uses;            // of each of `bodies`
    DescentUses particle_uses;
    std::vector<AugmentedBlock> blocks; // of SolverScratch::joints
    std::vector<std::array<AugmentedPoint, 4>> contacts;
    std::vector<AugmentedPoint> particle_contacts;
    std::vector<Vec3> free_velocities; // of each particle
    std::vector<Real> start_lengths;   // of each spring (m)
};

struct StepContext;

// Bodies, places and uses, after prepare_contacts, prepare_joints and prepare_particles.
void gather_uses(StepContext &context);
std::span<const DescentUse> uses_of(const DescentUses &uses, std::size_t i);

AugmentedBlock &augmented(StepContext &context, const JointConstraint &joint);
// How far what a motor drives has come in the substep (m or rad); 0 for other rows.
Real driven(StepContext &context, const JointConstraint &joint, Real h);

// How far the places of a contact have come against each other in the substep h, along the normal
// and the tangents (m), to first order in the turns: contacts are a truncated Taylor series about
// its start (Giles, Diaz, Yuksel 2025, sec. 4).
Vec3 way_of(const StepContext &context, const ContactConstraint &contact,
            const ContactPointConstraint &point, Real h);
Vec3 way_of(const StepContext &context, const ParticleContactConstraint &row, Real h);

// One pass over bodies and particles: each is put where the energy is least, the others held
// (likewise, eqs. 4 to 6, 13 and 17).
void descend(StepContext &context, const Stiffening &stiffening);

} // namespace plumb::inline PLUMB_PRECISION
