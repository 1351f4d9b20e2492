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
    std::array<std::uint32_t, 3> corners{}; // particles; counter-clockwise from above in a grid
    std::array<std::uint32_t, 3> sides{};   // springs: from each corner to the next
};

struct ClothParts {
    std::vector<glm::dvec3> places; // of the particles, in the cloth's frame
    std::vector<ClothSpring> springs;
    std::vector<ClothTriangle> triangles;
};

// How many particles it has, without making them.
std::size_t particle_count(const ClothDesc &cloth);

// Of a grid, particle j * (cells[0] + 1) + i is the i-th along x in the j-th row along z. Its
// springs: the sides of the cells, both diagonals of each cell, and, two cells long, from each
// particle to the next but one along x and along z (Provot 1995). The triangles of neighbouring
// cells are cut along different diagonals, so that no direction is preferred.
//
// Of a mesh, particles are its vertices. Its springs: the edges, and across each edge between two
// triangles one from corner to corner, where there is none already. No edge may be without length.
ClothParts cloth_parts(const ClothDesc &cloth);

// Of one of its particles, in the cloth's frame.
glm::dvec3 cloth_place(const ClothDesc &cloth, std::uint32_t particle);

// How it moves at the start, in the world.
ParticleState start_of(const ClothDesc &cloth, std::uint32_t particle);

double stiffness_of(const ClothDesc &cloth, ClothSpring::Kind kind); // N/m

// How its particles are called: "sheet[3,4]" is the fourth along x of the fifth row along z,
// "sail[17]" a vertex of a mesh.
std::string particle_name(const ClothDesc &cloth, std::uint32_t particle);
// Of what follows the cloth's name: "[3,4]"; none when that is no particle of it.
std::optional<std::uint32_t> find_particle(const ClothDesc &cloth, std::string_view brackets);

} // namespace plumb
