// Contacts as velocity constraints: prepared once a step, solved many times.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/contacts/contact.h"
#include "engine/dynamics/softness.h"
#include "engine/math/basis.h"

#include <array>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

// One contact point, seen from both centres of mass.
struct ContactPointConstraint {
    Vec3 r_a{Real(0)}; // world, from a's centre of mass, at the start of the step
    Vec3 r_b{Real(0)};
    // The same points less the rounding of their surfaces, in the body's frame: a round surface
    // keeps its distance when the body rolls, so only the core's point turns with it.
    Vec3 core_a{Real(0)};
    Vec3 core_b{Real(0)};
    Real rounding = Real(0);    // sum of both
    Real normal_mass = Real(0); // 1 / (n^T K n)
    // 1 / (the largest eigenvalue of K in the tangent plane). One number for both directions, so
    // that the step is along the sliding velocity and projecting onto the cone gives the friction
    // of maximal dissipation. With K's inverse the four corners of a box brace against each other
    // sideways and lose 6 % of their grip.
    Real tangent_mass = Real(0);
    Vec3 impulse{Real(0)};     // accumulated in this substep: normal, t1, t2 (N s)
    Vec3 remembered{Real(0)};  // from the previous substep
    Real separation = Real(0); // refresh_separations (m)
    Real approach = Real(0);   // relative normal velocity at the start of the step (m/s)
    Real pushed = Real(0);     // sum of normal impulses over the substeps so far (N s)
};

struct StepContext;

struct ContactConstraint {
    std::uint32_t contact = 0; // index in the context
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Vec3 normal{Real(0)};
    TangentBasis tangents;
    Real friction = Real(0);
    Real restitution = Real(0);
    int count = 0;
    bool strikes = false; // bounces, or is a collision of a lone pair (resolve_impacts)
    bool has_met = false; // in an impact, elsewhere than where it was found (resolve_impacts)
    std::array<ContactPointConstraint, 4> points{};
};

// How one solver pass treats penetration.
struct ContactBias {
    Softness softness;            // of penetrating points
    Real push_velocity = Real(0); // m/s; 0: leave penetration alone
    Real slop = Real(0);          // m, penetration left alone
    // Whether points that are apart and carry no load are left to the next substep, as in a
    // relaxation pass: what they would prevent lies beyond the end of this one.
    bool loaded_only = false;
    // Whether the pass leaves friction alone, as one over pseudo velocities does.
    bool frictionless = false;
    // m/s; contacts that close faster are swept more than once (soft_step).
    Real struck_speed = std::numeric_limits<Real>::infinity();
    // Whether each contact's points are taken from last to first.
    bool backwards = false;
    // Of penetrating points against a body without inverse mass.
    Softness stiff{};
    // Whether points that bear most of a contact's load are as stiff (ContactBlock::hard_depth);
    // `stiff` must then be of twice the frequency of `softness`.
    bool hardens = false;
};

// Not for Joint::world.
bool is_dynamic(const StepContext &context, std::uint32_t body);
bool are_both_dynamic(const StepContext &context, const Contact &contact);
// Whether both colliders are spheres.
bool are_balls(const StepContext &context, const Contact &contact);
// touch_nothing_else: whether two dynamic bodies touch each other and nothing else, and no joint or
// grab holds either. find_partners works that out for all bodies first.
void find_partners(StepContext &context);
bool touch_nothing_else(const StepContext &context, const Contact &contact);

// K along a unit vector: the inverse of the effective mass of two points against each other (1/kg),
// with their arms from the centres of mass (world, m). 0 if neither body can move.
Real inverse_effective_mass(const SolverBody &a, const SolverBody &b, const Vec3 &r_a,
                            const Vec3 &r_b, const Vec3 &direction);

// ContactPointConstraint::tangent_mass at the present poses.
Real tangent_mass_of(const ContactPointConstraint &point, const TangentBasis &tangents,
                     const SolverBody &a, const SolverBody &b);
// Changes a point's tangential impulse to stop it sliding, with the total clamped to `limit` (N s)
// in length: Coulomb's circular cone.
void solve_friction(const ContactConstraint &contact, ContactPointConstraint &point, SolverBody &a,
                    SolverBody &b, Real limit);

// One constraint per contact except sensors', in order; or only for those that strike.
enum class Prepare { all, striking };
void prepare_contacts(StepContext &context, Prepare which = Prepare::all);
// The separation of a point at the present poses (m).
Real present_separation(const ContactConstraint &contact, const ContactPointConstraint &point,
                        const SolverBody &a, const SolverBody &b);
// Updates separations to the present poses for solve_contacts, whose passes leave them as they are.
void refresh_separations(StepContext &context);
// Warm starting: a substep begins by remembering the impulses that the previous one accumulated and
// applies them, all at once or in shares, adding them to the accumulated impulses.
void remember_contacts(StepContext &context);
void warm_start_contacts(StepContext &context, Real share);
// One Gauss-Seidel pass. Points that are still apart may close the gap within h and no faster.
void solve_contacts(StepContext &context, const ContactBias &bias, Real h);
// Hands the accumulated impulses back to the world's contacts for the next step.
void store_contacts(StepContext &context);

// Bounces once a step, after its substeps (Catto 2024, "Solver2D"): a point that approached faster
// than the threshold at the start, and has carried load since, leaves at its restitution times that
// speed.
void note_approach(StepContext &context);
void note_loads(StepContext &context);
void restitute(StepContext &context, Real threshold);

// Records a bounce from each point's normal impulse (N s), at the centre of where they act; without
// an impulse there is none.
void record_impact(StepContext &context, const ContactConstraint &contact,
                   const std::array<Real, 4> &normal_impulse);

// Impacts: contacts with restitution that would touch within the next h follow Newton's impact law,
// those of one body together, until none approaches. So an impact runs through a row of touching
// bodies as in Newton's cradle, and a table comes up from its legs as level as it came down (Smith
// et al. 2012, "Reflections on Simultaneous Impact"; with restitution 1 these are its reflections).
// Where gravity acts along the normal, the rebound speed is what the body would have at its present
// height had it bounced at the surface: energy is kept whatever h is. A lone pair that collides
// within the step is resolved where its bodies touch, even without restitution. Comes at the start
// of a substep, before gravity is applied.
void resolve_impacts(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
