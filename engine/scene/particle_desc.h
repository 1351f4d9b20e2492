// Attractors, particles, springs and cloth of a scene as plain values. SI units.
#pragma once

#include "engine/scene/frame.h"
#include "engine/scene/shape_desc.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// Attracts everything dynamic by Newton's law of gravitation.
struct AttractorDesc {
    std::string name;
    glm::dvec3 position{0};
    double gravitational_parameter = 1; // G M, m^3/s^2
    double radius = 0.1;                // of the ball drawn for it
};

struct ParticleDesc {
    std::string name; // not that of a body or cloth
    glm::dvec3 position{0};
    glm::dvec3 velocity{0}; // m/s
    double mass = 1;        // kg
    double radius = 0.02;
    bool pinned = false;             // never moves
    std::string material;            // a MaterialDesc's name; empty: the default MaterialDesc
    std::optional<glm::vec3> colour; // sRGB, 0..1
};

// Pulls its ends together along the line between them with stiffness * (length - rest_length), and
// damps the rate of change of that length.
struct SpringDesc {
    std::string name;
    // A particle's name, a particle of a cloth ("sheet[3,4]"), or a body's; empty: the world.
    std::string a;
    std::string b;
    // In the body's frame, or in the world; 0 for particles.
    glm::dvec3 anchor_a_local{0};
    glm::dvec3 anchor_b_local{0};
    double rest_length = 1;
    double stiffness = 100; // N/m
    double damping = 0;     // N s/m
    // Tears when longer than (1 + tear_strain) * rest_length; 0: never.
    double tear_strain = 0;
    bool torn = false; // state: no longer exerts force
};

// A sheet of particles that share its mass equally, connected by springs: either a grid centred in
// the xz plane of its own frame, or the vertices and edges of a mesh.
struct ClothDesc {
    std::string name; // not that of a body or particle
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
    std::array<int, 2> cells{10, 10};     // along x and z
    glm::dvec2 size{1};                   // along x and z, m
    std::shared_ptr<const MeshData> mesh; // null: the grid
    ShapeFile file;                       // the mesh's source
    double mass = 1;                      // kg, total
    double radius = 0.01;                 // of its particles: half the thickness of its surface
    double stretch = 1000;           // N/m, springs along the sides of cells, or along mesh edges
    double shear = 500;              // N/m, springs along the diagonals of cells; unused for meshes
    double bend = 10;                // N/m, springs from one particle to the next but one
    double damping = 0.1;            // N s/m, of each spring
    double tear_strain = 0;          // as for a spring
    std::vector<std::uint32_t> pins; // particles that never move, ascending, each once
    std::string material;
    std::optional<glm::vec3> colour;
    // State: of all particles; empty: at rest where the cloth is placed.
    std::vector<ParticleState> particles;
    std::vector<std::uint32_t> torn; // springs, in the order of cloth_parts, ascending
};

inline constexpr int max_cloth_cells = 1000; // along either side

} // namespace plumb
