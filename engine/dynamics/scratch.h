// A world's working memory within a step. All of it may be discarded between steps; it is kept for
// its allocations, and because the tree's boxes change slowly. No result depends on it.
#pragma once

#include "engine/core/collect.h"
#include "engine/dynamics/method.h"
#include "engine/space/dynamic_tree.h"

#include <cstddef>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

inline constexpr std::size_t contacts_a_part = 256; // per thread

// What decides how far a collider may go in a step, from its body.
struct ColliderReach {
    Vec3 velocity{Real(0)};
    Vec3 pull{Real(0)};     // gravity on it, m/s^2
    Real turning = Real(0); // World::turning_reach
};

// Two colliders that may meet within the step, ordered by their bodies.
struct Candidate {
    ContactKey key; // without a triangle
    std::uint32_t collider_a = 0;
    std::uint32_t collider_b = 0;
    Real margin = Real(0); // how far apart they may be and still meet (m)
};

// How far the broad phase's boxes reach beyond what a step needs (m). With more, bodies move longer
// before the tree changes, but more pairs are tested.
inline constexpr Real tree_margin = Real(0.1);

// One per world, so its members are ordered by subject, not by size.
struct Scratch {               // NOLINT(clang-analyzer-optin.performance.Padding)
    TaskPool *tasks = nullptr; // of the running step; null: one thread

    // Broad phase, one for each collider of the model.
    DynamicTree tree{tree_margin};
    std::vector<DynamicTree::Leaf> leaves;
    std::vector<Shape> placed; // in the world; unused for surfaces
    std::vector<Aabb> boxes;   // around the colliders
    std::vector<Aabb> swept;   // around everything they may reach
    std::vector<ColliderReach> reach;
    std::vector<std::uint8_t> moved;
    std::vector<std::uint8_t> stays;      // placed already, and has not moved since
    std::vector<std::uint64_t> fat_pairs; // of colliders whose fat boxes touch, ascending
    std::vector<std::uint64_t> new_pairs; // those of colliders that left their fat boxes
    std::vector<std::uint64_t> merged_pairs;
    std::vector<Candidate> pair_candidates;
    std::vector<Candidate> plane_candidates;
    std::vector<Candidate> candidates;         // both, ascending by key
    std::vector<std::uint64_t> sorted_numbers; // scratch for sorting
    std::vector<Candidate> sorted_candidates;
    FoundParts<std::uint64_t> pair_parts;
    FoundParts<Candidate> candidate_parts;
    // Candidates with a static or kinematic body, a floor: (the other collider << 32 | the
    // floor's), ascending.
    std::vector<std::uint64_t> floors;

    // Contacts of the last step, or found again since. `contacts_are_current`: they belong to this
    // model, and to these poses or the step that led to them.
    std::vector<Contact> contacts;
    bool contacts_are_current = false;
    std::vector<ContactEnds> ends; // one per contact, while the step advances
    // Bodies that went another way than at the start of the step, the motion now expected of each
    // body, and the contacts that this adds.
    std::vector<std::uint8_t> deflected; // empty: none
    std::vector<Motion> deflected_motions;
    std::vector<Contact> more;
    FoundParts<Contact> contact_parts;
    std::vector<std::vector<std::uint32_t>> triangles; // near the solid, in each part of the loop
    std::vector<ContactMemory> next_memory;
    std::vector<PointMemory> next_points;
    std::vector<PointPenalty> next_penalties;
    // Per contact: how many of its points are remembered, later its place in next_memory.
    std::vector<std::uint32_t> remembered;
    // Memory of contacts between still bodies: its old place and its new one.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> kept_memory;

    // Per body: whether it does not move in this step (static, asleep, or kinematic at zero speed).
    // Pairs of still bodies are skipped.
    std::vector<std::uint8_t> still;
    std::size_t awake = 0; // bodies that move
    std::vector<std::uint8_t> marked;

    // The step's copy of the state, which becomes the state when the step is done.
    std::vector<SolverBody> bodies;
    std::vector<std::uint32_t> moving;
    std::vector<JointMemory> joints;
    std::vector<JointPenalty> joint_penalties;
    std::vector<std::array<PointPenalty, 4>> point_penalties; // per contact
    Grab grab;
    SolverBody world_frame;
    SolverScratch solver;
    std::vector<Pace> paces;
    Islands islands;
    std::vector<IslandGroup> groups; // the first group_count of them
    std::size_t group_count = 0;
    std::vector<JointSystem> joint_systems; // one per group with joints, often last step's
    JointSystem no_joints;                  // for groups without
    std::vector<double> wanted_squared;     // per body: the square of the substeps that it wants
    bool was_let_go = false;                // joints were, so that the step is repeated
    std::vector<Vec3> wall_normals;         // per body: of the first that does not move
    // Per body: the most load that its contacts count for substeps (N).
    std::vector<double> greatest_contact_load;
    // The same as wanted_squared, per contact of a group.
    std::vector<double> contact_wanted_squared;
    std::vector<GeometricStiffness> stiffness; // per body, from its joints' forces
    std::vector<Vec3> guessed_stiffness;       // the same, per newton its joints may carry (m)
    std::vector<Impact> impacts;
    std::vector<ParticleMotion> particles; // the step's copy
    std::vector<std::uint8_t> torn;
    std::vector<ParticleContact> particle_contacts; // by particle, then collider and triangle
    FoundParts<ParticleContact> particle_contact_parts;
    std::vector<std::vector<std::uint32_t>> near_particle; // colliders, per part of the loop
    std::vector<std::vector<std::uint32_t>> near_triangles;
};

} // namespace plumb::inline PLUMB_PRECISION
