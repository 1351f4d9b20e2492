// The contacts of soft_step in columns: the same values of 16 contacts side by side, so that the
// processor works on as many at once as it can. The contacts of a block share no dynamic body (the
// contact graph is coloured), so the result is the same at any width.
#pragma once

#include "engine/dynamics/bodies/body_reals.h"
#include "engine/dynamics/columns.h"
#include "engine/dynamics/contacts/contact_constraint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// How much of what the relaxation pass adds to a load the next substep begins with, doubled: the
// pass adds it in the second half only, and it is missing in both. Without it a tall stack, whose
// loads one pass does not balance, sways for minutes.
inline constexpr Real relaxed_again = 1;
// The same in islands that get far fewer substeps than they want (IslandPace::remembers_all): all
// of it would feed waves in large pyramids.
inline constexpr Real relaxed_again_unbalanced = Real(0.5);
// At most this share of the load: an impact is no load of the next substep.
inline constexpr Real relaxed_share = Real(1) / Real(16);
// An impact is not a load: warm starting the next substep with it would push just as hard although
// nothing hits any more, and launch whatever rests on top. So where bodies close fast
// (struck_speed), the remembered impulse starts from remembered_blow of it and grows by
// growing_blow at most; a load that lasts is fully known after ten substeps. But a light body
// between a load and what should bear it may be thrown about so much that it is struck all the
// time, and nothing ever bears the load: what is struck without a pause for as long as
// pressed_after is no blow any more.
inline constexpr Real remembered_blow = Real(1) / Real(64);
inline constexpr Real growing_blow = Real(1.5);
inline constexpr double pressed_after = 0.4; // s

// A corner that bears the load of a whole face is as soft as the light corner that it is. In an
// island that gets far fewer substeps than it wants (IslandPace::hardens), points that bear more
// than hard_share of their contact's load are four times as stiff (ContactBias::stiff) beyond
// hard_depths, in units of substep_tolerance times the smaller width. If all points were, waves
// would grow in whatever is stacked high: walls and towers fall.
inline constexpr Real hard_share = Real(0.4);
inline constexpr double hard_depths = 3;

struct ContactBlock {
    struct Point {
        Columns3 r_a; // world, from a's centre of mass
        Columns3 r_b;
        // The separation at the start of the step (m); the bodies' motion since then is added, to
        // second order in their turns.
        Column separation;
        Column normal_mass;  // 1 / (n^T K n); 0 where a lane has no such point
        Column tangent_mass; // ContactPointConstraint::tangent_mass
        Columns3 impulse;    // accumulated in this substep: normal, t1, t2 (N s)
        // From the previous substep; after the move: as it was before the relaxation pass.
        Columns3 remembered;
    };
    // Where each lane's bodies start, in Reals from the start of the body array, and whether they
    // are dynamic: others are never written.
    IndexColumn body_a;
    IndexColumn body_b;
    // Masks; bit k stands for lane k.
    std::uint16_t writes_a = 0;
    std::uint16_t writes_b = 0;
    std::uint16_t turning = 0;            // Contact::turns
    std::uint16_t braced = 0;             // Contact::is_braced
    std::uint16_t round = 0;              // Rolling::round
    std::uint16_t found_again = 0;        // in each substep
    std::uint16_t rearmed = 0;            // arms are renewed in this substep
    std::uint32_t contacts[column_lanes]; // NOLINT(modernize-avoid-c-arrays) in the context
    std::size_t used = 0;                 // lanes
    int points_used = 0;
    // Whether any contact is new and not solved yet.
    bool is_new = false;
    bool spins = false; // whether any spread is not 1
    static constexpr std::uint32_t none = UINT32_MAX;
    std::uint32_t ahead = none; // its StartArms, if any contact is not from the start of the step
    // Whether any body's inertia turns with it.
    bool inertia_turns = false;
    Columns3 normal;
    Columns3 t1; // t2 = n x t1
    Column friction;
    Column bounces;   // 1 where there is restitution
    Column struck;    // 1 where the bodies closed faster than struck_speed in this substep
    Column pressed;   // 1 where that is no blow (Contact::is_pressed)
    Column corrected; // the most that the last pass changed a point's speed (m/s)
    Column began;     // sum of the normal impulses remembered as it began (N s)
    // Friction's lever arms about the centre of pressure, as a share of the points' (patch_spread).
    Column spread;
    // A point that bears most of the contact's load is stiffer beyond this depth (m).
    Column hard_depth;
    Column rounding_a; // radius of a round surface beyond its core (m)
    Column rounding_b;
    Columns3 inv_mass_a; // along the world's axes
    Columns3 inv_mass_b;
    ColumnsSymmetric inv_inertia_a;
    ColumnsSymmetric inv_inertia_b;
    Point points[4]; // NOLINT(modernize-avoid-c-arrays)
};

// For contacts whose arms are not from the start of the step (Contact::moment): the arms to the
// bodies' cores at that time, in world axes, which determine how separations change.
struct StartArms {
    struct Point {
        Columns3 core_a;
        Columns3 core_b;
    };
    Point points[4]; // NOLINT(modernize-avoid-c-arrays)
};

// All contacts of a context except sensors', in blocks, one colour after another. Blocks of one
// colour share no dynamic body, so they are solved at the same time.
struct ContactSchedule {
    struct Lane {
        std::uint32_t contact = 0;
        std::uint32_t bucket = 0; // colour and number of points
    };
    // The impulse that a contact that is found again carried in the first half of the substep (N
    // s): normal, t1, t2.
    struct Borne {
        ContactBlock *block = nullptr;
        std::size_t lane = 0;
        Vec3 impulse{Real(0)};
    };
    std::vector<Borne> borne;
    std::vector<ContactBlock> blocks;
    std::vector<StartArms> start_arms;
    std::vector<std::uint32_t> colour_ends; // in blocks; those after the last have no colour
    bool any_turning = false;               // Contact::turns
    std::vector<Lane> lanes;
    std::vector<std::uint32_t> contacts;        // per lane of each block, index in the context
    std::vector<std::uint32_t> place_of;        // per contact, index in `contacts`
    std::vector<std::uint64_t> colours_of_body; // bit c: the body has a contact of colour c
    std::vector<std::uint32_t> bucket_sizes;
    std::vector<std::uint8_t> turned_far; // per body: see rearm_contact_columns
};

void prepare_contact_columns(StepContext &context);
// Sets all of a block's start arms to the contacts' own cores.
void fill_start_arms(const StepContext &context, const ContactBlock &block, StartArms &arms);
// Like remember_contacts, warm_start_contacts, solve_contacts and store_contacts.
void warm_start_contact_columns(StepContext &context, Real share, bool remember_first);
void solve_contact_columns(StepContext &context, const ContactBias &bias, Real h);
// Bodies whose masses differ by more than this factor strike each other for longer: what is left of
// the blow takes many passes.
inline constexpr Real unlike_masses = Real(2);
// The greatest ratio (at least 1) of the masses of two bodies that strike each other; immovable
// bodies count as alike. 0 if none do. Their contact was struck in this substep and is not pressed,
// or their masses are unlike and the last pass changed its speed by more than `changed` (m/s).
Real striking_mass_ratio(const StepContext &context, Real changed);
// Whether the last pass changed the speed of any contact point by more than this (m/s).
bool any_is_corrected(const StepContext &context, Real speed);
void store_contact_columns(StepContext &context);

// Within a step (turning_columns.cpp).
// Moves the normals and arms of contacts that turn with their bodies to where they are t seconds
// from now; those of braced contacts only for t = 0.
void turn_contact_columns(StepContext &context, Real t);
// Updates the arms and masses of contacts whose bodies have turned far since the step began: with
// those of another pose impulses do work, and thin bodies are flung off. Where a lone pair slides
// or rolls on one point, that point is found again, normal and all. First the impulse that pushed
// the bodies apart is taken back, and the load they carried is set aside until the substep is over
// (recall_borne).
void rearm_contact_columns(StepContext &context);
void recall_borne(StepContext &context);
// Takes over the points where impacts have met (ContactConstraint): bodies that separate there, but
// still approach elsewhere, would be stopped for good by the passes.
void meet_contact_columns(StepContext &context);

// Compiled for each instruction set (contact_kernels.cpp).
namespace kernels {
// Computes the masses from the rest of the blocks.
void finish(std::span<ContactBlock> blocks);
// `again`: how much of the last relaxation pass's change is added to what is remembered.
void warm_start(std::span<ContactBlock> blocks, const BodyReals &bodies, Real share,
                bool remember_first, Real again);
// `any_far`: some body has turned so far that separations need more than the second order.
void solve(std::span<ContactBlock> blocks, std::span<const StartArms> start_arms,
           const BodyReals &bodies, const ContactBias &bias, Real inv_h, bool any_far);
} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
