// Contacts of soft_step in columns: the same numbers of 16 contacts side by side, so that the
// processor works on as many at once as it can. The contacts of one block share no dynamic body
// (a colouring of the contact graph), so that the answer is the same at any width.
#pragma once

#include "engine/dynamics/bodies/body_reals.h"
#include "engine/dynamics/columns.h"
#include "engine/dynamics/contacts/contact_constraint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Of a contact's load: how much more of what the relaxing pass added is remembered, at the most.
inline constexpr Real relaxed_share = Real(1) / Real(16);
// A blow is no load: what strikes in a substep would push as hard in the next, though nothing comes
// any more, and throw off what stands on it. So where bodies close fast (struck_speed), what is
// remembered grows from so little, and no faster; what goes on is known in ten substeps.
inline constexpr Real remembered_blow = Real(1) / Real(64);
inline constexpr Real growing_blow = Real(1.5);

struct ContactBlock {
    struct Point {
        Columns3 r_a; // world, from a's centre of mass
        Columns3 r_b;
        // The separation at the start of the step (m); what the bodies moved since comes on top, to
        // second order in their turns.
        Column separation;
        Column normal_mass;  // 1 / (n^T K n); 0 where a lane has no such point
        Column tangent_mass; // ContactPointConstraint::tangent_mass
        Columns3 impulse;    // accumulated in this substep: normal, t1, t2 (N s)
        // Of the substep before; after the move: as it was before the relaxing pass.
        Columns3 remembered;
    };
    // Of each body, as an index of a Real from the first one of the array of bodies; and whether it
    // is dynamic: others are never written.
    static constexpr std::uint32_t none = UINT32_MAX;
    IndexColumn body_a;
    IndexColumn body_b;
    std::uint16_t writes_a = 0; // bit k: lane k
    std::uint16_t writes_b = 0;
    std::uint16_t turning = 0;            // likewise: Contact::turns
    std::uint16_t round = 0;              // Rolling::round
    std::uint16_t found_again = 0;        // in each substep
    std::uint16_t rearmed = 0;            // whose bodies have other arms by now
    std::uint32_t contacts[column_lanes]; // NOLINT(modernize-avoid-c-arrays) in the context
    std::size_t used = 0;                 // lanes
    int points_used = 0;
    // Whether any of its contacts is new and was not solved yet.
    bool is_new = false;
    bool spins = false;         // whether any of its spreads is not 1
    std::uint32_t ahead = none; // its StartArms, if any contact is not of the start of the step
    // Whether any of its bodies has an inertia that turns with it.
    bool inertia_turns = false;
    Columns3 normal;
    Columns3 t1; // t2 = n x t1
    Column friction;
    Column bounces;   // 1 where there is restitution
    Column struck;    // 1 where the bodies closed faster than struck_speed in this substep
    Column corrected; // by how much the last pass changed a point's speed, at most (m/s)
    Column began;     // all normal impulses that were remembered as it began (N s)
    // Lever arms of friction as a share of those of the points, about the centre of pressure
    // (spread_of).
    Column spread;
    Column rounding_a; // radius by which a round surface lies beyond its core (m)
    Column rounding_b;
    Columns3 inv_mass_a; // along the world's axes
    Columns3 inv_mass_b;
    ColumnsSymmetric inv_inertia_a;
    ColumnsSymmetric inv_inertia_b;
    Point points[4]; // NOLINT(modernize-avoid-c-arrays)
};

// Of contacts whose arms are not those of the step's start (Contact::moment): the arms to the
// bodies' cores as they were then, in world axes, which say how separations change.
struct StartArms {
    struct Point {
        Columns3 core_a;
        Columns3 core_b;
    };
    Point points[4]; // NOLINT(modernize-avoid-c-arrays)
};

// All contacts of a context that are no sensors' in blocks, one colour after another: blocks of one
// colour share no dynamic body, so that they are solved at the same time.
struct ContactSchedule {
    struct Lane {
        std::uint32_t contact = 0;
        std::uint32_t bucket = 0; // colour and number of points
    };
    // What a contact that is found again bore in the first half of the substep (N s): normal, t1,
    // t2.
    struct Borne {
        ContactBlock *block = nullptr;
        std::size_t lane = 0;
        Vec3 impulse{Real(0)};
    };
    std::vector<Borne> borne;
    std::vector<ContactBlock> blocks;
    std::vector<StartArms> start_arms;
    std::vector<std::uint32_t> colour_ends; // of blocks; those after the last stand for themselves
    bool any_turning = false;               // Contact::turns
    std::vector<Lane> lanes;
    std::vector<std::uint32_t> contacts;        // of each lane of each block, in the context
    std::vector<std::uint32_t> place_of;        // of each contact in those
    std::vector<std::uint64_t> colours_of_body; // bit c: colour c has a contact of it
    std::vector<std::uint32_t> bucket_sizes;
};

void prepare_contact_columns(StepContext &context);
// Normals and arms of contacts of what turns together, as they are t seconds from now.
void turn_contact_columns(StepContext &context, Real t);
// Arms and masses of contacts whose bodies have turned far since the step began: with those of
// another pose impulses do work, and what is thin is flung off. Where a lone pair that slides or
// rolls touches in one point, that is found again, normal and all; what pushed the two apart is
// taken back first, and what they bore is set aside until the substep is over (recall_borne).
void rearm_contact_columns(StepContext &context);
void recall_borne(StepContext &context);
// Takes over where impacts have met (ContactConstraint): the passes would stop for good what leaves
// there, but comes elsewhere.
void meet_contact_columns(StepContext &context);
// As remember_contacts, warm_start_contacts, solve_contacts and store_contacts.
void warm_start_contact_columns(StepContext &context, Real share, bool remember_first);
void solve_contact_columns(StepContext &context, const ContactBias &bias, Real h);
// Whether any bodies closed faster than struck_speed in this substep.
bool anything_is_struck(const StepContext &context);
// Whether the last pass changed the speed of any contact's point by more than this (m/s).
bool any_is_corrected(const StepContext &context, Real speed);
void store_contact_columns(StepContext &context);

// Compiled for each instruction set (contact_kernels.cpp).
namespace kernels {
// Masses, from what is there of the blocks.
void finish(std::span<ContactBlock> blocks);
void warm_start(std::span<ContactBlock> blocks, const BodyReals &bodies, Real share,
                bool remember_first);
// `any_far`: some body has turned so far that separations need more than the second order.
void solve(std::span<ContactBlock> blocks, std::span<const StartArms> start_arms,
           const BodyReals &bodies, const ContactBias &bias, Real inv_h, bool any_far);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
