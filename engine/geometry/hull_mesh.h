// Convex polyhedron data; a ConvexHull (shapes.h) places it in the world.
#pragma once

#include "engine/geometry/shapes.h"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A closed convex polyhedron in its own frame. Made by `convex_hull` (quickhull.h) and immutable
// afterwards.
struct HullMesh {
    // vertices[vertex_indices[first .. first + count)], counter-clockwise from outside; count >= 3.
    struct Face {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };
    // Each edge once, from vertex a to vertex b. Left and right are as seen from outside, going
    // from a to b: the left face lists a before b.
    struct Edge {
        std::uint32_t a = 0, b = 0;
        std::uint32_t left_face = 0, right_face = 0;
    };

    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Plane> planes; // of the faces, outward; no vertex is in front of any plane
    std::vector<std::uint32_t> vertex_indices;
    // Three vertices of each face, counter-clockwise, such that no vertex is in front of the plane
    // through them, by exact signs. They decide where the rounded planes leave doubt.
    std::vector<std::array<std::uint32_t, 3>> face_corners;
    std::vector<Edge> edges;
    // The vertices that share an edge with vertex v:
    // neighbors[first_neighbor[v] .. first_neighbor[v + 1]).
    std::vector<std::uint32_t> first_neighbor;
    std::vector<std::uint32_t> neighbors;
    Aabb box; // of the vertices, exactly
    // Bound (m) on the difference between the height of a point in `box` above a face's plane,
    // computed in Real, and its height above the plane through the face's three corners.
    Real slack = Real(0);
    std::uint32_t most_corners = 0; // of a face
    bool has_flat_faces = true;     // exactly: the vertices of each face are coplanar
    Vec3 center{Real(0)};           // of mass, for uniform density
    Real volume = Real(0);          // m^3
    Mat3 inertia{Real(0)};          // about the centre, for a density of 1 kg/m^3
};

// A missing mesh, a mesh without vertices, a non-finite position, or a rotation that is not of unit
// length (is_unit) fails a check: here, and in every query that takes a ConvexHull.
void check_valid(const ConvexHull &hull);

} // namespace plumb::inline PLUMB_PRECISION
