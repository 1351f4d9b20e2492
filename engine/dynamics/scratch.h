// What a world works with within a step. All of it may be thrown away between two steps; it is kept
// for its memory, and because the tree's boxes change slowly. No result depends on it.
#pragma once

#include "engine/core/collect.h"
#include "engine/dynamics/method.h"
#include "engine/space/dynamic_tree.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// How far a collider may go in a step: what its body says of that.
struct ColliderReach {
    Vec3 velocity{Real(0)};
    Vec3 pull{Real(0)};     // gravity on it, m/s^2
    Real turning = Real(0); // World::turning_reach
};

// Two colliders that may meet within the step, in the order of their bodies.
struct Candidate {
    ContactKey key; // without a triangle
    std::uint32_t collider_a = 0;
    std::uint32_t collider_b = 0;
    Real margin = Real(0); // how far apart they may be and still meet (m)
};

// How far the broad phase's boxes reach beyond what a step needs (m): larger, and bodies move
// longer before the tree changes, but more pairs are looked at.
inline constexpr Real tree_margin = Real(0.1);

// One for each world: its members stand by subject, not by size.
struct Scratch {               // NOLINT(clang-analyzer-optin.performance.Padding)
    TaskPool *tasks = nullptr; // of the step that runs; null: one thread

    // Broad phase, one for each collider of the model.
    DynamicTree tree{tree_margin};
    std::vector<DynamicTree::Leaf> leaves;
    std::vector<Shape> placed; // in the world; of surfaces nothing
    std::vector<Aabb> boxes;   // around the colliders
    std::vector<Aabb> swept;   // around all that they may reach
    std::vector<ColliderReach> reach;
    std::vector<std::uint8_t> moved;
    std::vector<std::uint8_t> stays;      // placed where it still is
    std::vector<std::uint64_t> fat_pairs; // of colliders whose fat boxes touch, ascending
    std::vector<std::uint64_t> new_pairs; // those of what left its fat box
    std::vector<std::uint64_t> merged_pairs;
    std::vector<Candidate> pair_candidates;
    std::vector<Candidate> plane_candidates;
    std::vector<Candidate> candidates;         // both, ascending by key
    std::vector<std::uint64_t> sorted_numbers; // where sorting puts things
    std::vector<Candidate> sorted_candidates;
    FoundParts<std::uint64_t> pair_parts;
    FoundParts<Candidate> candidate_parts;
    // Of candidates with one static body: (the other collider << 32 | the static one), ascending.
    std::vector<std::uint64_t> beside_static;

    // Contacts of the last step, or found again. `are_current`: of this model and these poses or of
    // the step that led to them.
    std::vector<Contact> contacts;
    bool contacts_are_current = false;
    std::vector<ContactEnds> ends; // of each contact, while the step advances
    // Bodies that went another way than at the start of the step, how all go now, and whom they
    // met.
    std::vector<std::uint8_t> surprised; // empty: none
    std::vector<Motion> going;
    std::vector<Contact> more;
    FoundParts<Contact> contact_parts;
    std::vector<std::vector<std::uint32_t>> triangles; // near what a part of the loop looks at
    std::vector<ContactMemory> next_memory;
    std::vector<PointMemory> next_points;
    std::vector<PointPenalty> next_penalties;
    // Of each contact: how many of its points are remembered; then its place in next_memory.
    std::vector<std::uint32_t> remembered;
    // Of those between bodies that were still: where they were and where they are now.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> kept_memory;

    // Of each body: whether it does not move in this step (static, asleep, or driven at no speed),
    // so that it need not be met with others that do not.
    std::vector<std::uint8_t> still;
    std::size_t awake = 0; // bodies that move
    std::vector<std::uint8_t> marked;

    // The step's copy of the state, which becomes the state when the step has come to its end.
    std::vector<SolverBody> bodies;
    std::vector<std::uint32_t> moving;
    std::vector<JointMemory> joints;
    std::vector<JointPenalty> joint_penalties;
    std::vector<std::array<PointPenalty, 4>> point_penalties; // of each contact
    Grab grab;
    SolverBody world_frame;
    SolverScratch solver;
    std::vector<Pace> paces;
    Islands islands;
    std::vector<IslandGroup> groups; // the first group_count of them
    std::size_t group_count = 0;
    std::vector<JointSystem> joint_systems; // one for each group, which is often that of last step
    JointSystem no_joints;                  // of groups without
    std::vector<double> loads;         // of each body: the square of the substeps that it wants
    std::vector<double> contact_loads; // of each contact of a group, likewise
    std::vector<GeometricStiffness> stiffness; // of each body, that its joints' forces make
    std::vector<Vec3> guessed_stiffness; // likewise, for each newton that its joints may bear (m)
    std::vector<Impact> impacts;
    std::vector<ParticleMotion> particles; // the step's copy
    std::vector<std::uint8_t> torn;
    std::vector<ParticleContact> particle_contacts; // by particle, then collider and triangle
    FoundParts<ParticleContact> particle_contact_parts;
    std::vector<std::vector<std::uint32_t>> near_particle; // colliders, in each part of the loop
    std::vector<std::vector<std::uint32_t>> near_triangles;
};

} // namespace plumb::inline PLUMB_PRECISION
