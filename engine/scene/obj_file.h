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

// Stated limits: a file beyond these is refused.
inline constexpr std::size_t max_obj_bytes = 64U << 20U;
inline constexpr std::size_t max_obj_line_bytes = 1U << 16U;
inline constexpr std::size_t max_obj_vertices = 2'000'000;
inline constexpr std::size_t max_obj_triangles = 4'000'000;
inline constexpr std::size_t max_obj_polygon_corners = 255;
inline constexpr double max_obj_coordinate = 1e8; // in magnitude; what a MeshTree takes
// Cutting a polygon compares corners with triangles, in the worst case its corners' number cubed
// times; all polygons of a file together at most so often, which takes seconds.
inline constexpr std::size_t max_obj_corner_tests = 500'000'000;

struct ObjMesh {
    std::vector<glm::dvec3> vertices; // all of the file's, in its order, used or not
    std::vector<std::array<std::uint32_t, 3>> triangles; // in the order and sense of the faces
};

struct ObjResult {
    ObjMesh mesh;      // empty unless ok()
    std::string error; // "name:line: what was wrong; what would be right"; lines count from 1
    bool ok() const { return error.empty(); }
};

// The positions and faces of all objects of a file as one mesh. Names, groups, materials, normals,
// texture coordinates, lines, points and whatever else a line begins with are passed over unread.
//
// `v` gives three numbers, each read to the nearest double; more on the line are passed over. `f`
// names three or more vertices, from 1 in the order of the file, or from the last one so far by -1;
// what follows a slash is not used. A polygon is cut into triangles with its own corners (ear
// clipping, Meisters 1975; which side a corner is on is decided exactly), after the projection
// along an axis that keeps most of its area. It may be concave and need not be plane, but its
// outline must not cross itself. One without area becomes as many flat triangles.
//
// A number that is not finite or too large, a vertex that is not in the file, a file without faces,
// and what is beyond the limits above, are refused. Never throws for what is in the file. `name`
// stands in messages only.
ObjResult read_obj(std::istream &in, const std::string &name);

} // namespace plumb
