// What only an edit changes: bodies, colliders, joints, particles, springs, attractors.
#pragma once

#include "engine/dynamics/attractor.h"
#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/joints/joint.h"
#include "engine/dynamics/particles/particles.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Shared by a world and everything saved of it; an edit of a shared model copies it first.
struct Model {
    std::vector<Body> bodies;          // holes included (Body::alive)
    std::vector<Collider> colliders;   // holes included (Collider::body); a body's are in a row
    std::vector<Joint> joints;         // holes included
    std::vector<Particle> particles;   // never removed
    std::vector<Spring> springs;       // likewise
    std::vector<Attractor> attractors; // likewise
    std::vector<std::uint32_t> free_bodies; // descending
    std::vector<std::uint32_t> free_joints;
    // Pairs of bodies that a joint keeps from colliding, (lesser << 32 | greater), ascending; a
    // pair comes as often as there are such joints.
    std::vector<std::uint64_t> joined;
    std::vector<std::uint32_t> half_spaces; // colliders, ascending
    // Bit n: layer n. Those that colliders are on, and those that some do not ignore.
    std::uint32_t layers = 0;
    std::uint32_t heeded_layers = 0;
    std::uint32_t alive_bodies = 0;
    std::uint32_t dynamic_bodies = 0;
    std::uint32_t alive_joints = 0;
    std::uint32_t free_particles = 0; // not pinned

    bool has_particles() const { return !particles.empty() || !springs.empty(); }
    void note_layers(const Filter &filter) {
        layers |= std::uint32_t{1} << filter.layer;
        heeded_layers |= ~filter.ignores;
    }
    // Whether it ignores every layer that there is: it collides with no body.
    bool ignores_all(const Filter &filter) const { return (~filter.ignores & layers) == 0; }
};

inline std::uint64_t body_pair(std::uint32_t a, std::uint32_t b) {
    return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
}

} // namespace plumb::inline PLUMB_PRECISION
