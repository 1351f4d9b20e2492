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

// Attracts all that moves by forces, by Newton's law of gravitation.
struct AttractorDesc {
    std::string name;
    glm::dvec3 position{0};
    double gravitational_parameter = 1; // G M, m^3/s^2
    double radius = 0.1;                // of the ball that it is drawn as
};

struct ParticleDesc {
    std::string name; // no body and no cloth has it
    glm::dvec3 position{0};
    glm::dvec3 velocity{0}; // m/s
    double mass = 1;        // kg
    double radius = 0.02;
    bool pinned = false;             // never moves
    std::string material;            // a MaterialDesc's name; empty: the default MaterialDesc
    std::optional<glm::vec3> colour; // sRGB, 0..1
};

// Pulls its ends together along the line between them with stiffness * (length - rest_length), and
// brakes the rate of that length.
struct SpringDesc {
    std::string name;
    // A particle's name, a particle of a cloth ("sheet[3,4]"), or a body's; empty: the world.
    std::string a;
    std::string b;
    // In the body's frame, or a point of the world; of particles 0.
    glm::dvec3 anchor_a_local{0};
    glm::dvec3 anchor_b_local{0};
    double rest_length = 1;
    double stiffness = 100; // N/m
    double damping = 0;     // N s/m
    // It tears when longer than (1 + tear_strain) * rest_length; 0: never.
    double tear_strain = 0;
    bool torn = false; // state: exerts no force any more
};

// A sheet of particles that share its mass evenly, held together by springs. Either a grid in the
// xz plane of its own frame, centred, or the vertices and edges of a mesh.
struct ClothDesc {
    std::string name; // no body and no particle has it
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
    std::array<int, 2> cells{10, 10};     // along x and z
    glm::dvec2 size{1};                   // likewise, m
    std::shared_ptr<const MeshData> mesh; // null: the grid
    ShapeFile file;                       // that the mesh is from
    double mass = 1;                      // kg, of the whole
    double radius = 0.01;                 // of its particles: half the thickness of its surface
    double stretch = 1000;  // N/m, of the springs along the sides of its cells, or along its edges
    double shear = 500;     // N/m, of those along the diagonals of its cells; of meshes unused
    double bend = 10;       // N/m, of those from one particle to the next but one
    double damping = 0.1;   // N s/m, of each spring
    double tear_strain = 0; // as of a spring
    std::vector<std::uint32_t> pins; // particles that never move, ascending, each once
    std::string material;
    std::optional<glm::vec3> colour;
    // State: of all its particles, or empty: at rest where the cloth is put.
    std::vector<ParticleState> particles;
    std::vector<std::uint32_t> torn; // springs, in the order of cloth_parts, ascending
};

inline constexpr int max_cloth_cells = 1000; // along either side

} // namespace plumb
