// A triangle mesh with fast queries: rays, overlaps, closest points.
#pragma once

#include "engine/geometry/triangle_exact.h"
#include "engine/geometry/triangle_mesh.h"
#include "engine/space/bvh.h"
#include "engine/space/wide_raycast.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A mesh and its tree. Copyable.
class MeshTree {
  public:
    // An invalid mesh fails a check.
    explicit MeshTree(TriangleMesh mesh);

    // Moves the vertices, which must be as many as before, and refits the tree.
    void move_vertices(std::span<const Vec3> vertices);

    const TriangleMesh &mesh() const { return mesh_; }
    const Bvh &tree() const { return tree_; }
    std::span<const TriangleBlock> blocks() const { return blocks_; } // one per leaf

  private:
    void pack();

    TriangleMesh mesh_;
    Bvh tree_;
    std::vector<TriangleBlock> blocks_;
};

// Rays.
//
// Triangles are closed sets with two sides. Whether a ray hits one is decided exactly for the given
// numbers, as in raycast(triangle, ray), so a closed mesh has no leaks at edges or corners, and a
// ray from inside always hits (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection",
// with exact edge functions instead of those of a rounded projection; the box test is conservative
// as in Ize 2013, "Robust BVH Ray Traversal"). t is rounded, and compared with max_t as such; t
// |direction| is off by at most 16 epsilon times the distance and 4 epsilon times the largest
// coordinate, over the sine of the angle between ray and triangle, down to 0.02; below, it stays in
// the triangle's bounds. A ray in the plane of a triangle, or through a flat one, hits its first
// point there, which is the origin if that is in the triangle.
//
// Answers depend only on the triangles, not on the tree, the traversal order or the SIMD width: at
// equal t the lowest triangle wins.
//
// A zero or non-finite direction, an origin beyond `mesh_reach` or a NaN fails a check. So does, in
// double, a direction whose largest component is outside 1e-300 to 1e300; t overflows before that.
struct MeshHit {
    Real t = Real(0);
    Vec3 point{Real(0)};       // in the triangle, to rounding
    Vec3 normal{Real(0)};      // unit, on the side the ray comes from, or on the triangle's front
                               // if that is neither; zero for a flat triangle
    Vec3 barycentric{Real(0)}; // of a, b, c; each >= 0
    std::uint32_t triangle = 0;
};

// The first hit.
std::optional<MeshHit> raycast(const MeshTree &mesh, const Ray &ray);
// Whether there is a hit at all; cheaper.
bool is_met(const MeshTree &mesh, const Ray &ray);
// Whether the segment from a to b meets a triangle; exact, endpoints included. a == b tests that
// point.
bool linetest(const MeshTree &mesh, const Vec3 &a, const Vec3 &b);

// Whether any triangle overlaps the shape; as accurate as the test of a single triangle.
bool overlaps(const MeshTree &mesh, const Sphere &sphere);
bool overlaps(const MeshTree &mesh, const Aabb &box);
bool overlaps(const MeshTree &mesh, const Box &box);
bool overlaps(const MeshTree &mesh, const Plane &plane);
bool overlaps(const MeshTree &mesh, const Triangle &triangle);

// The point on the mesh closest to `point`; of several, the lowest triangle's. A mesh without
// triangles fails a check.
Vec3 closest_point(const MeshTree &mesh, const Vec3 &point);

// Whether the point is inside or on a closed mesh; decided exactly, by the parity of the triangles
// along +x from it (points on the outlines counted once). For an open mesh (see is_closed) the
// answer is only that parity. A non-finite point fails a check.
bool contains(const MeshTree &mesh, const Vec3 &point);

// Calls visit(index) for every triangle that overlaps the closed box, in no particular order; stops
// when visit returns false.
template <typename Visit>
void visit_triangles(const MeshTree &mesh, const Aabb &box, Visit &&visit) {
    check_valid(box);
    if (!(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z))
        return;
    mesh.tree().query(box, [&](std::uint32_t item) {
        return !triangle_meets_box(triangle(mesh.mesh(), item), box) || visit(item);
    });
}

} // namespace plumb::inline PLUMB_PRECISION
