// Unit meshes for instanced shapes.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

struct MeshVertex {
    glm::vec3 position{0};
    glm::vec3 normal{0};
    // -1, 0 or 1: which end of a capsule or cylinder the vertex moves with, so that one mesh serves
    // every height.
    float end = 0;
};

// Triangles, counter-clockwise from outside.
struct Mesh {
    std::vector<MeshVertex> vertices;
    std::vector<std::uint16_t> indices;
};

[[nodiscard]] Mesh box_mesh(); // corners at +-1
// An icosahedron whose faces are split in four `splits` times (at most 5), on the unit sphere.
[[nodiscard]] Mesh sphere_mesh(int splits);
// Two unit hemispheres about y of `rings` rings (>= 1) and `segments` sides (>= 3); the band
// between them has no height until the ends are moved apart.
[[nodiscard]] Mesh capsule_mesh(int segments, int rings);
// Two unit discs across y of `segments` sides (>= 3), and the band between them, also without
// height.
[[nodiscard]] Mesh cylinder_mesh(int segments);

} // namespace plumb
