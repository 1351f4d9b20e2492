// A triangle mesh that can be asked quickly: rays, overlaps, closest points.
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
    // A mesh that is not valid fails a check.
    explicit MeshTree(TriangleMesh mesh);

    // The same triangles with their vertices elsewhere; as many as before. The tree is refitted.
    void move_vertices(std::span<const Vec3> vertices);

    const TriangleMesh &mesh() const { return mesh_; }
    const Bvh &tree() const { return tree_; }
    std::span<const TriangleBlock> blocks() const { return blocks_; } // one for each leaf

  private:
    void pack();

    TriangleMesh mesh_;
    Bvh tree_;
    std::vector<TriangleBlock> blocks_;
};

// Rays.
//
// A triangle is a closed set with two sides. Whether a ray meets it is decided exactly, for the
// numbers as they are given, as by raycast(triangle, ray): so a closed mesh has no leaks, at no
// edge and no corner, and a ray from inside always hits (Woop, Benthin, Wald 2013, "Watertight
// Ray/Triangle Intersection", with the exact edge functions in place of those of a rounded
// projection; the test of the boxes is conservative in the way of Ize 2013, "Robust BVH Ray
// Traversal"). t is rounded, and compared with max_t as such; t |direction| is off by at most 16
// epsilon times the distance and 4 epsilon times the largest coordinate, over the sine of the angle
// between ray and triangle, down to 0.02; below, it stays in the triangle's bounds. A ray in the
// plane of a triangle, or through a flat one, meets its first point there, which is the origin if
// that is in the triangle.
//
// The answers depend on the triangles alone, and not on the tree, on the order of traversal or on
// the width of the machine's vectors: of equal t the lowest triangle counts.
//
// A direction that is zero or not finite, an origin beyond `mesh_reach`, a NaN fail a check. So do,
// in double, directions whose largest component is outside of 1e-300 to 1e300; t overflows before.
struct MeshHit {
    Real t = Real(0);
    Vec3 point{Real(0)};       // in the triangle, to rounding
    Vec3 normal{Real(0)};      // unit, of the side that the ray comes from, or the triangle's front
                               // if that is neither; zero when it is flat
    Vec3 barycentric{Real(0)}; // of a, b, c; each >= 0
    std::uint32_t triangle = 0;
};

// The first hit.
std::optional<MeshHit> raycast(const MeshTree &mesh, const Ray &ray);
// Whether there is a hit at all; cheaper.
bool is_met(const MeshTree &mesh, const Ray &ray);
// Whether the segment from a to b meets a triangle; exact, ends and all. a == b asks for that
// point.
bool linetest(const MeshTree &mesh, const Vec3 &a, const Vec3 &b);

// Whether any triangle overlaps the shape; as true as the answer for the single triangle.
bool overlaps(const MeshTree &mesh, const Sphere &sphere);
bool overlaps(const MeshTree &mesh, const Aabb &box);
bool overlaps(const MeshTree &mesh, const Box &box);
bool overlaps(const MeshTree &mesh, const Plane &plane);
bool overlaps(const MeshTree &mesh, const Triangle &triangle);

// The point of the triangles that is closest to `point`; of several, that of the lowest triangle.
// A mesh without triangles fails a check.
Vec3 closest_point(const MeshTree &mesh, const Vec3 &point);

// Whether the point is inside of a closed mesh, or on it; decided exactly, by the number of
// triangles along +x from it (parity, points on the outlines counted once). For a mesh that is not
// closed (see is_closed) it means no more than that. A point that is not finite fails a check.
bool contains(const MeshTree &mesh, const Vec3 &point);

// Calls visit(index) for every triangle that overlaps the closed box, in no order; stops when it
// returns false.
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
