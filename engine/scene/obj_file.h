// Triangle meshes from Wavefront OBJ files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

// A file beyond these limits is refused.
inline constexpr std::size_t max_obj_bytes = 64U << 20U;
inline constexpr std::size_t max_obj_line_bytes = 1U << 16U;
inline constexpr std::size_t max_obj_vertices = 2'000'000;
inline constexpr std::size_t max_obj_triangles = 4'000'000;
inline constexpr std::size_t max_obj_polygon_corners = 255;
inline constexpr double max_obj_coordinate = 1e8; // in magnitude; the most a MeshTree takes
// Triangulating a polygon tests corners against triangles, cubic in the number of corners at worst.
// This caps the tests for all polygons of a file, which then take seconds.
inline constexpr std::size_t max_obj_corner_tests = 500'000'000;

struct ObjMesh {
    std::vector<glm::dvec3> vertices; // all of the file's, in file order, used or not
    std::vector<std::array<std::uint32_t, 3>> triangles; // in the faces' order and winding
};

struct ObjResult {
    ObjMesh mesh;      // empty unless ok()
    std::string error; // "name:line: what was wrong; what would be right"; lines count from 1
    bool ok() const { return error.empty(); }
};

// Reads the positions and faces of all objects in a file as one mesh. Names, groups, materials,
// normals, texture coordinates, lines, points and all other kinds of line are skipped.
//
// `v` gives three numbers, each read to the nearest double; further numbers are ignored. `f` lists
// three or more vertices, counted from 1 in file order, or backwards from -1, the last one so far;
// anything after a slash is ignored. Polygons are triangulated without adding vertices (ear
// clipping, Meisters 1975, with exact orientation tests), projected along the axis that keeps most
// of their area. A polygon may be concave and need not be planar, but its outline must not cross
// itself. A polygon without area becomes as many degenerate triangles.
//
// Numbers that are not finite or too large, vertices that are not in the file, files without faces
// and files beyond the limits above are refused. Never throws because of a file's contents. `name`
// is used in messages only.
ObjResult read_obj(std::istream &in, const std::string &name);

} // namespace plumb
