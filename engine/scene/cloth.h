// The particles, springs and triangles that a cloth is made of.
#pragma once

#include "engine/scene/particle_desc.h"

#include <string_view>

namespace plumb {

struct ClothSpring {
    enum class Kind { stretch, shear, bend };
    Kind kind = Kind::stretch;
    std::uint32_t a = 0; // particles; a < b
    std::uint32_t b = 0;
    double rest_length = 0; // m, > 0
};

struct ClothTriangle {
    std::array<std::uint32_t, 3>
        corners{};                        // particles; counter-clockwise seen from above in a grid
    std::array<std::uint32_t, 3> sides{}; // springs: from each corner to the next
};

struct ClothParts {
    std::vector<glm::dvec3> places; // of the particles, in the cloth's frame
    std::vector<ClothSpring> springs;
    std::vector<ClothTriangle> triangles;
};

// The cloth's particle count, without building its parts.
std::size_t particle_count(const ClothDesc &cloth);

// Grid: particle j * (cells[0] + 1) + i is the i-th along x in the j-th row along z. Springs run
// along the sides and both diagonals of each cell, and, two cells long, from each particle to the
// next but one along x and z (Provot 1995). Neighbouring cells are split along opposite diagonals,
// so that no direction is preferred.
//
// Mesh: its vertices are the particles. Springs run along the edges, and across each edge shared by
// two triangles, between their opposite corners, unless there is one already. No edge may have zero
// length.
ClothParts cloth_parts(const ClothDesc &cloth);

// A particle's position in the cloth's frame.
glm::dvec3 cloth_place(const ClothDesc &cloth, std::uint32_t particle);

// A particle's initial state, in the world.
ParticleState start_of(const ClothDesc &cloth, std::uint32_t particle);

double stiffness_of(const ClothDesc &cloth, ClothSpring::Kind kind); // N/m

// Particle names: "sheet[3,4]" is the fourth along x in the fifth row along z, "sail[17]" a vertex
// of a mesh.
std::string particle_name(const ClothDesc &cloth, std::uint32_t particle);
// Takes the part after the cloth's name, "[3,4]"; empty when the cloth has no such particle.
std::optional<std::uint32_t> find_particle(const ClothDesc &cloth, std::string_view brackets);

} // namespace plumb
