#include "engine/geometry/triangle_exact.h"

#include "engine/math/predicates.h"

#include <algorithm>
#include <array>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The sign of one component of (b - a) x (c - a).
int turn(int axis, const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    return orient2d(seen_along(axis, a), seen_along(axis, b), seen_along(axis, c));
}

bool are_in_line(const Vec3 &a, const Vec3 &b, const Vec3 &c) {
    return turn(0, a, b, c) == 0 && turn(1, a, b, c) == 0 && turn(2, a, b, c) == 0;
}

// An axis along which the triangle's projection has an area, or -1 if the triangle is flat.
int viewing_axis(const Triangle &t) {
    for (int axis = 0; axis < 3; ++axis)
        if (turn(axis, t.a, t.b, t.c) != 0)
            return axis;
    return -1;
}

bool bounds_meet(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    for (int i = 0; i < 3; ++i)
        if (std::max(a[i], b[i]) < std::min(c[i], d[i]) ||
            std::max(c[i], d[i]) < std::min(a[i], b[i]))
            return false;
    return true;
}

bool is_on_segment(const Vec3 &a, const Vec3 &b, const Vec3 &point) {
    return bounds_meet(a, b, point, point) && are_in_line(a, b, point);
}

bool are_opposite(int a, int b) {
    return a * b < 0;
}

// Coplanar segments, projected along an axis that keeps their plane from becoming a line. Each must
// reach the other's line; if collinear, their bounds decide.
bool segments_meet_as_seen(int axis, const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const int side_c = turn(axis, a, b, c), side_d = turn(axis, a, b, d);
    if (side_c * side_d > 0)
        return false;
    const int side_a = turn(axis, c, d, a), side_b = turn(axis, c, d, b);
    if (side_a * side_b > 0)
        return false;
    return side_c != 0 || side_d != 0 || side_a != 0 || side_b != 0 || bounds_meet(a, b, c, d);
}

bool segments_meet(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    if (!bounds_meet(a, b, c, d) || orient3d(a, b, c, d) != 0)
        return false;
    for (int axis = 0; axis < 3; ++axis)
        if (turn(axis, a, b, c) != 0 || turn(axis, a, b, d) != 0 || turn(axis, c, d, a) != 0 ||
            turn(axis, c, d, b) != 0)
            return segments_meet_as_seen(axis, a, b, c, d);
    return true; // collinear, so the bounds decide
}

bool is_in_triangle_as_seen(int axis, const Triangle &t, const Vec3 &p) {
    const int ab = turn(axis, t.a, t.b, p), bc = turn(axis, t.b, t.c, p),
              ca = turn(axis, t.c, t.a, p);
    return !are_opposite(ab, bc) && !are_opposite(bc, ca) && !are_opposite(ca, ab);
}

// A segment in the plane of the triangle, or any segment and a flat triangle.
bool meets_in_plane(const Vec3 &p, const Vec3 &q, const Triangle &t) {
    const int axis = viewing_axis(t);
    if (axis < 0)
        return segments_meet(p, q, t.a, t.b) || segments_meet(p, q, t.b, t.c) ||
               segments_meet(p, q, t.c, t.a);
    return is_in_triangle_as_seen(axis, t, p) || segments_meet_as_seen(axis, p, q, t.a, t.b) ||
           segments_meet_as_seen(axis, p, q, t.b, t.c) ||
           segments_meet_as_seen(axis, p, q, t.c, t.a);
}

// `side_p` and `side_q` are sides of the triangle's plane. A segment that crosses the plane hits
// the triangle if it passes all edges on the same side.
bool segment_meets(const Vec3 &p, int side_p, const Vec3 &q, int side_q, const Triangle &t) {
    if (side_p * side_q > 0)
        return false;
    if (side_p == 0 && side_q == 0)
        return meets_in_plane(p, q, t);
    const int ab = orient3d(p, q, t.a, t.b);
    const int bc = orient3d(p, q, t.b, t.c);
    if (are_opposite(ab, bc))
        return false;
    const int ca = orient3d(p, q, t.c, t.a);
    return !are_opposite(bc, ca) && !are_opposite(ca, ab);
}

struct CornerSides {
    int a, b, c;

    CornerSides(const Triangle &plane, const Triangle &corners)
        : a(orient3d(plane.a, plane.b, plane.c, corners.a)),
          b(orient3d(plane.a, plane.b, plane.c, corners.b)),
          c(orient3d(plane.a, plane.b, plane.c, corners.c)) {}
    bool are_apart() const { return a != 0 && a == b && b == c; }
};

bool an_edge_meets(const Triangle &edges, const CornerSides &sides, const Triangle &t) {
    return segment_meets(edges.a, sides.a, edges.b, sides.b, t) ||
           segment_meets(edges.b, sides.b, edges.c, sides.c, t) ||
           segment_meets(edges.c, sides.c, edges.a, sides.a, t);
}

// The corner of the box farthest to the left, or to the right, of the direction from p to q,
// projected along the axis.
Vec3 corner_beside(int axis, const Vec3 &p, const Vec3 &q, bool is_left, const Aabb &box) {
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    Vec3 corner = box.min;
    corner[x] = (q[y] < p[y]) == is_left ? box.max[x] : box.min[x];
    corner[y] = (q[x] > p[x]) == is_left ? box.max[y] : box.min[y];
    return corner;
}

// Whether the whole box is to the right of an edge's line, projected along the axis.
bool is_right_of_edge(int axis, const Vec3 &p, const Vec3 &q, const Aabb &box) {
    return turn(axis, p, q, corner_beside(axis, p, q, true, box)) < 0;
}

bool is_left_of_edge(int axis, const Vec3 &p, const Vec3 &q, const Aabb &box) {
    return turn(axis, p, q, corner_beside(axis, p, q, false, box)) > 0;
}

bool bounds_meet(const Triangle &t, const Aabb &box) {
    for (int i = 0; i < 3; ++i)
        if (std::max({t.a[i], t.b[i], t.c[i]}) < box.min[i] ||
            std::min({t.a[i], t.b[i], t.c[i]}) > box.max[i])
            return false;
    return true;
}

} // namespace

bool point_meets_triangle(const Vec3 &point, const Triangle &triangle) {
    if (orient3d(triangle.a, triangle.b, triangle.c, point) != 0)
        return false;
    const int axis = viewing_axis(triangle);
    if (axis < 0)
        return is_on_segment(triangle.a, triangle.b, point) ||
               is_on_segment(triangle.b, triangle.c, point) ||
               is_on_segment(triangle.c, triangle.a, point);
    return is_in_triangle_as_seen(axis, triangle, point);
}

bool segment_meets_triangle(const Segment &segment, const Triangle &triangle) {
    return segment_meets(segment.a, orient3d(triangle.a, triangle.b, triangle.c, segment.a),
                         segment.b, orient3d(triangle.a, triangle.b, triangle.c, segment.b),
                         triangle);
}

// Two triangles that meet do so at an edge of one of them: if they cross, their common segment ends
// at edges; if they are coplanar, edges cross or one triangle is inside the other.
bool triangle_meets_triangle(const Triangle &a, const Triangle &b) {
    const CornerSides of_b(a, b);
    if (of_b.are_apart())
        return false;
    const CornerSides of_a(b, a);
    if (of_a.are_apart())
        return false;
    return an_edge_meets(b, of_b, a) || an_edge_meets(a, of_a, b);
}

// Separating axes (Akenine-Moeller 2001, "Fast 3D Triangle-Box Overlap Testing"): the box's three,
// the triangle's normal, and nine edge cross products. The nine are tested in the three projections
// along the box's axes, where each is the line of an edge with the box on its outer side.
bool triangle_meets_box(const Triangle &t, const Aabb &box) {
    if (!bounds_meet(t, box))
        return false;
    Vec3 front = box.min, back = box.min; // the corners farthest along and against the normal
    bool is_flat = true;
    for (int axis = 0; axis < 3; ++axis) {
        const int side = turn(axis, t.a, t.b, t.c);
        const std::array<Segment, 3> edges{Segment{t.a, t.b}, Segment{t.b, t.c}, Segment{t.c, t.a}};
        for (const Segment &edge : edges) {
            if (side >= 0 && is_right_of_edge(axis, edge.a, edge.b, box))
                return false;
            if (side <= 0 && is_left_of_edge(axis, edge.a, edge.b, box))
                return false;
        }
        is_flat = is_flat && side == 0;
        (side > 0 ? front : back)[axis] = box.max[axis];
    }
    return is_flat || (orient3d(t.a, t.b, t.c, front) >= 0 && orient3d(t.a, t.b, t.c, back) <= 0);
}

bool segment_meets_box(const Segment &segment, const Aabb &box) {
    if (!bounds_meet(segment.a, segment.b, box.min, box.max))
        return false;
    for (int axis = 0; axis < 3; ++axis)
        if (is_right_of_edge(axis, segment.a, segment.b, box) ||
            is_left_of_edge(axis, segment.a, segment.b, box))
            return false;
    return true;
}

} // namespace plumb::inline PLUMB_PRECISION
