// What only an edit changes: bodies, colliders, joints, particles, springs, attractors.
#pragma once

#include "engine/dynamics/attractor.h"
#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/joints/joined_bodies.h"
#include "engine/dynamics/joints/joint.h"
#include "engine/dynamics/particles/particles.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Shared by a world and its saves; editing a shared model copies it first.
struct Model {
    std::vector<Body> bodies;          // holes included (Body::alive)
    std::vector<Collider> colliders;   // holes included (Collider::body); a body's are contiguous
    std::vector<Joint> joints;         // holes included
    std::vector<Particle> particles;   // never removed
    std::vector<Spring> springs;       // never removed
    std::vector<Attractor> attractors; // never removed
    std::vector<std::uint32_t> free_bodies; // descending
    std::vector<std::uint32_t> free_joints; // descending
    JoinedBodies joined;
    std::vector<std::uint32_t> half_spaces; // colliders, ascending
    // Bit n: layer n. `layers`: some collider is on it; `heeded_layers`: some collider does not
    // ignore it.
    std::uint32_t layers = 0;
    std::uint32_t heeded_layers = 0;
    std::uint32_t alive_bodies = 0;
    std::uint32_t dynamic_bodies = 0;
    std::uint32_t bodies_with_force = 0;
    std::uint32_t bodies_with_torque = 0;
    std::uint32_t alive_joints = 0;
    std::uint32_t free_particles = 0; // not pinned

    bool has_particles() const { return !particles.empty() || !springs.empty(); }
    void note_layers(const Filter &filter) {
        layers |= std::uint32_t{1} << filter.layer;
        heeded_layers |= ~filter.ignores;
    }
    // Whether it ignores every layer in use, and so collides with no body.
    bool ignores_all(const Filter &filter) const { return (~filter.ignores & layers) == 0; }
};

} // namespace plumb::inline PLUMB_PRECISION
