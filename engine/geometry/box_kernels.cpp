// Contacts of two boxes, and their separating axes, with vector instructions. Compiled once per
// instruction set, by including itself.
#include "engine/geometry/box_parts.h"
#include "engine/geometry/closest.h"
#include "engine/geometry/manifold_pairs.h"
#include "engine/geometry/sat_axes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/geometry/box_kernels.cpp"
// Vectors of unknown size cannot be struct members.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/geometry/clip_face-inl.h"
#include "engine/math/four-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

using wide::HWY_NAMESPACE::abs;
using wide::HWY_NAMESPACE::all;
using wide::HWY_NAMESPACE::equal_bits;
using wide::HWY_NAMESPACE::first;
using wide::HWY_NAMESPACE::Four;
using wide::HWY_NAMESPACE::four;
using wide::HWY_NAMESPACE::greater_bits;
using wide::HWY_NAMESPACE::greatest;
using wide::HWY_NAMESPACE::load;
using wide::HWY_NAMESPACE::max;
using wide::HWY_NAMESPACE::sqrt;
using wide::HWY_NAMESPACE::store;
using wide::HWY_NAMESPACE::store_columns;
using wide::HWY_NAMESPACE::where_greater;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

constexpr std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

// Four numbers in memory; of vectors the last is unused.
using Row = std::array<Real, 4>;
using Rows = std::array<Row, 3>;

HWY_INLINE Four spread(const Vec3 &v, Real last) {
    return four(v.x, v.y, v.z, last);
}

// --- Axes ----------------------------------------------------------------------------------------

// Box B relative to box A and the other way round, by number.
struct Placing {
    Rows b_axes; // B's axes, in A's frame
    Rows a_axes; // A's axes, in B's frame
    Row b_position;
    Row a_position;
};

// The best axis of one kind: of faces `i` is the face's axis, of edges they are A's and B's.
struct Best {
    Real separation;
    std::size_t i = 0, j = 0;
};

HWY_INLINE Best best_of(const Four &separations) {
    const Four most = greatest(separations);
    // The first of equals; some lane even if all are NaN.
    const auto lane =
        static_cast<std::size_t>(std::countr_zero(equal_bits(separations, most) | 4U));
    return {first(most), lane};
}

// The best face of each box.
struct Faces {
    Best a, b;
};

HWY_INLINE Faces best_faces(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b,
                            Placing &placing) {
    const Vec3 &t = relative.position;
    const Mat3 &r = relative.axes;
    const Four column_0 = spread(r[0], Real(0));
    const Four column_1 = spread(r[1], Real(0));
    const Four column_2 = spread(r[2], Real(0));
    const Four row_0 = four(r[0].x, r[1].x, r[2].x, Real(0));
    const Four row_1 = four(r[0].y, r[1].y, r[2].y, Real(0));
    const Four row_2 = four(r[0].z, r[1].z, r[2].z, Real(0));
    const Four along_a = spread(t, Real(0));
    const Four along_b = row_0 * t.x + row_1 * t.y + row_2 * t.z;
    store(column_0, placing.b_axes[0].data());
    store(column_1, placing.b_axes[1].data());
    store(column_2, placing.b_axes[2].data());
    store(row_0, placing.a_axes[0].data());
    store(row_1, placing.a_axes[1].data());
    store(row_2, placing.a_axes[2].data());
    store(along_a, placing.b_position.data());
    store(-along_b, placing.a_position.data());
    // The last lane is never the best: its reach is infinite.
    const Four reach_a = spread(half_a, infinity) + abs(column_0) * half_b.x +
                         abs(column_1) * half_b.y + abs(column_2) * half_b.z;
    const Four reach_b = spread(half_b, infinity) +
                         (abs(row_0) * half_a.x + abs(row_1) * half_a.y + abs(row_2) * half_a.z);
    return {best_of(abs(along_a) - reach_a), best_of(abs(along_b) - reach_b)};
}

// The axes e_i x r_j for one i, j in the lanes.
struct Crossed {
    Four separation;
    Four x, y, z, along;
};

// Both boxes are projected with all three half edges, including the two whose cross product is the
// axis. So an axis turned by rounding is still valid: it never separates overlapping boxes. And
// because the Minkowski difference's face spanned by two nearly parallel edges is thin exactly
// where the axis is uncertain, what the axis misses is within rounding too.
template <int i>
HWY_INLINE Crossed across(const Four &row_next, const Four &row_after, const RelativeBox &relative,
                          const Vec3 &half_a, const Vec3 &half_b) {
    constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3 &t = relative.position;
    const Mat3 &r = relative.axes;
    const Four cross_j = -row_after, cross_k = row_next;
    const Four sine = sqrt(cross_j * cross_j + cross_k * cross_k);
    const Four axis_j = cross_j / sine, axis_k = cross_k / sine;
    const Four along = axis_j * t[j] + axis_k * t[k];
    const Four reach = abs(axis_j) * half_a[j] + abs(axis_k) * half_a[k] +
                       abs(axis_j * r[0][j] + axis_k * r[0][k]) * half_b.x +
                       abs(axis_j * r[1][j] + axis_k * r[1][k]) * half_b.y +
                       abs(axis_j * r[2][j] + axis_k * r[2][k]) * half_b.z;
    const Four separation =
        where_greater(sine, all(parallel_sine), abs(along) - reach, all(-infinity));
    if constexpr (i == 0)
        return {separation, all(Real(0)), axis_j, axis_k, along};
    else if constexpr (i == 1)
        return {separation, axis_k, all(Real(0)), axis_j, along};
    else
        return {separation, axis_j, axis_k, all(Real(0)), along};
}

// The normal is that of the best axis, and garbage if all edges are parallel.
HWY_INLINE Best best_edges(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b,
                           const Placing &placing, Vec3 &normal) {
    const Four row_0 = load(placing.a_axes[0].data());
    const Four row_1 = load(placing.a_axes[1].data());
    const Four row_2 = load(placing.a_axes[2].data());
    const Crossed axes_0 = across<0>(row_1, row_2, relative, half_a, half_b);
    const Crossed axes_1 = across<1>(row_2, row_0, relative, half_a, half_b);
    const Crossed axes_2 = across<2>(row_0, row_1, relative, half_a, half_b);
    const Four most = greatest(max(max(axes_0.separation, axes_1.separation), axes_2.separation));
    const unsigned is_most = equal_bits(axes_0.separation, most) |
                             equal_bits(axes_1.separation, most) << 4 |
                             equal_bits(axes_2.separation, most) << 8;
    // The first of equals; some lane even if all are NaN.
    const auto number = static_cast<std::size_t>(std::countr_zero(is_most | 1U << 10));
    std::array<Row, 3> x, y, z, along;
    for (std::size_t i = 0; i < 3; ++i) {
        const Crossed &axes = i == 0 ? axes_0 : i == 1 ? axes_1 : axes_2;
        store(axes.x, x[i].data());
        store(axes.y, y[i].data());
        store(axes.z, z[i].data());
        store(axes.along, along[i].data());
    }
    const std::size_t i = number / 4, j = number % 4;
    normal = (along[i][j] < Real(0) ? Real(-1) : Real(1)) * Vec3{x[i][j], y[i][j], z[i][j]};
    return {first(most), i, j};
}

const Vec3 &normal_of_face_a(const Placing &placing, std::size_t i) {
    return face_normals[2 * i + (placing.b_position[i] < Real(0) ? 0 : 1)];
}
Vec3 normal_of_face_b(const Placing &placing, std::size_t j) {
    const Row &axis = placing.b_axes[j];
    return (-placing.a_position[j] < Real(0) ? Real(-1) : Real(1)) *
           Vec3{axis[0], axis[1], axis[2]};
}

// --- Contacts of a face --------------------------------------------------------------------------

// `side` is 1 if the normal of the contacts points from the first box to the second, else -1.
HWY_INLINE Vec3 normal_in_world(const Vec3 &normal, const Box &frame, Real side) {
    return side * glm::normalize(frame.rotation * normal);
}

// Contacts with a face of the reference box, in the coordinates of the face.
struct FaceContacts {
    Clipped points;
    std::uint32_t feature; // but for the points' names
    const Box *frame;      // the reference box
    std::size_t axis;      // its face
    Real sign;
    Vec3 normal; // in the world
};

// Contacts of the face `axis`, `sign` of a reference box with the most anti-parallel face of the
// incident box. `feature` names which box is the reference.
HWY_INLINE void find_face_contacts(const Box &frame, Real side, std::size_t axis, Real sign,
                                   const Rows &incident_axes, const Row &incident_position,
                                   const Vec3 &incident_half_extents, Real margin,
                                   std::uint32_t feature, FaceContacts &contacts) {
    contacts.frame = &frame;
    contacts.axis = axis;
    contacts.sign = sign;
    const int number = face_number(static_cast<int>(axis), sign);
    // Its root and quotient take long; they run beside the search for the points.
    contacts.normal = normal_in_world(face_normals[index(number)], frame, side);

    const Numbered half = numbered(frame.half_extents);
    const Numbered incident_half = numbered(incident_half_extents);
    // Only if clearly steeper: with two faces at 45 degrees the choice must not flicker.
    std::size_t i = 0;
    Real steepest = std::abs(incident_axes[0][axis]);
    for (std::size_t k = 1; k < 3; ++k) {
        const Real slope = std::abs(incident_axes[k][axis]);
        const bool is_steeper = slope > steepest + Real(1e-3);
        steepest = is_steeper ? slope : steepest;
        i = is_steeper ? k : i;
    }
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Real incident_sign = incident_axes[i][axis] * sign > Real(0) ? Real(-1) : Real(1);
    contacts.feature =
        feature | bits(number) << 16 | bits(face_number(static_cast<int>(i), incident_sign)) << 8;

    const auto in_face = [&](const Row &row, Real scale) HWY_ATTR {
        return InFace{row[u] * scale, row[v] * scale, row[axis] * scale};
    };
    const InFace out = in_face(incident_axes[i], incident_sign * incident_half[i]);
    const FacePair faces = {{incident_position[u] + out[0], incident_position[v] + out[1],
                             incident_position[axis] + out[2]},
                            in_face(incident_axes[j], incident_half[j]),
                            in_face(incident_axes[k], incident_half[k]),
                            sign,
                            half[axis],
                            {half[u], half[v]}};
    clip_face(faces, margin, contacts.points);
}

// A number for each of at most eight points.
struct Eight {
    Four low, high;
};
template <typename Of, typename... Eights>
HWY_INLINE Eight each_half(const Of &of, const Eights &...numbers) {
    return {of(numbers.low...), of(numbers.high...)};
}

// Of more than four contacts keeps the deepest and the three that span the largest area with it. A
// later one replaces an earlier one only if clearly better, so that equally good ones do not
// alternate.
[[gnu::flatten]] HWY_NOINLINE void keep_best_four(FaceContacts &contacts) {
    constexpr Real clearly = Real(1.01);
    Clipped &points = contacts.points;
    const std::size_t count = points.count;
    const Real deepest = points.lowest, sign = contacts.sign;
    struct Flat {
        Real u, v;
    };
    const auto eight = [](const std::array<Real, 8> &numbers) HWY_ATTR {
        return Eight{load(numbers.data()), load(numbers.data() + 4)};
    };
    const Eight separation = eight(points.height);
    std::size_t first = 0;
    const auto is_shallow = [&](const Four &separations) HWY_ATTR {
        return greater_bits(separations - all(feature_tolerance), all(deepest));
    };
    const unsigned everyone = (1U << count) - 1; // bit i is for point i
    const unsigned deep =
        everyone & ~(is_shallow(separation.low) | is_shallow(separation.high) << 4);
    if (std::has_single_bit(deep)) { // no other comes near
        first = static_cast<std::size_t>(std::countr_zero(deep));
    } else {
        for (std::size_t i = 1; i < count; ++i)
            if (points.height[i] < points.height[first] - feature_tolerance)
                first = i;
        // The scan above may leave one that is shallower than the deepest by more than the
        // tolerance, because the tolerances of successive replacements add up. Allow only one.
        for (std::size_t i = 0; i < count && points.height[first] > deepest + feature_tolerance;
             ++i)
            if (points.height[i] <= deepest + feature_tolerance)
                first = i;
    }
    unsigned taken = 1U << first;

    const Flat origin = {points.u[first], points.v[first]};
    const Eight u =
        each_half([&](const Four &a) HWY_ATTR { return a - all(origin.u); }, eight(points.u));
    const Eight v =
        each_half([&](const Four &a) HWY_ATTR { return a - all(origin.v); }, eight(points.v));
    const auto pick = [&](const auto &score) HWY_ATTR {
        const Eight scores = each_half(score, u, v);
        std::array<Real, Clipped::most> score_of;
        store(scores.low, score_of.data());
        store(scores.high, score_of.data() + 4);
        std::size_t best = 0;
        Real best_score = Real(-1); // no score is negative
        for (std::size_t i = 0; i < count; ++i)
            if ((taken >> i & 1U) == 0 && score_of[i] > best_score * clearly) {
                best = i;
                best_score = score_of[i];
            }
        taken |= 1U << best;
        return Flat{points.u[best] - origin.u, points.v[best] - origin.v};
    };
    // Twice the area between two sides at a corner, positive if they turn like the face's normal.
    const auto area = [&](const Flat &a, const Four &b_u, const Four &b_v)
                          HWY_ATTR { return all(sign) * (b_v * a.u - b_u * a.v); };
    const Flat base = pick([](const Four &a, const Four &b) HWY_ATTR { return a * a + b * b; });
    const Flat apex =
        pick([&](const Four &a, const Four &b) HWY_ATTR { return abs(area(base, a, b)); });
    // The fourth adds the most area outside the triangle, beyond one of its sides.
    const Real turn = sign * (base.u * apex.v - apex.u * base.v) < Real(0) ? Real(-1) : Real(1);
    pick([&](const Four &a, const Four &b) HWY_ATTR {
        const auto beyond = [&](const Flat &from, const Flat &to) HWY_ATTR {
            return all(-turn) *
                   area({to.u - from.u, to.v - from.v}, a - all(from.u), b - all(from.v));
        };
        const Flat here{Real(0), Real(0)};
        return max(max(max(beyond(here, base), beyond(base, apex)), beyond(apex, here)),
                   all(Real(0)));
    });

    std::size_t n = 0;
    for (unsigned left = taken & everyone; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        points.u[n] = points.u[i];
        points.v[n] = points.v[i];
        points.height[n] = points.height[i];
        points.name[n] = points.name[i];
        ++n;
    }
    points.count = n;
}

void clamp_heights(Clipped &points, Real most) {
    for (Real &height : points.height)
        height = std::min(height, most);
}

HWY_INLINE void add_face_contacts(Manifold &manifold, FaceContacts &contacts) {
    const Clipped &kept = contacts.points;
    if (kept.count > 4)
        keep_best_four(contacts);
    const Box &frame = *contacts.frame;
    const Real half = numbered(frame.half_extents)[contacts.axis];
    std::array<Four, 3> local;
    const Four separation = load(kept.height.data());
    local[(contacts.axis + 1) % 3] = load(kept.u.data());
    local[(contacts.axis + 2) % 3] = load(kept.v.data());
    local[contacts.axis] = all(contacts.sign) * (all(half) + all(Real(0.5)) * separation);
    // frame.center + frame.rotation * local, in the same order of operations.
    const Quat &q = frame.rotation;
    const auto &[x, y, z] = local;
    const Four uv_x = z * q.y - y * q.z, uv_y = x * q.z - z * q.x, uv_z = y * q.x - x * q.y;
    const Four uuv_x = uv_z * q.y - uv_y * q.z;
    const Four uuv_y = uv_x * q.z - uv_z * q.x;
    const Four uuv_z = uv_y * q.x - uv_x * q.y;
    // All four points are written, for their count is hard to foresee: zeros where there is none.
    const Four place = four(Real(0), Real(1), Real(2), Real(3));
    const Four count = all(static_cast<Real>(kept.count));
    const auto if_there = [&](const Four &a)
                              HWY_ATTR { return where_greater(count, place, a, all(Real(0))); };
    std::array<Row, 4> points;
    store_columns(if_there(all(frame.center.x) + (x + (uv_x * q.w + uuv_x) * Real(2))),
                  if_there(all(frame.center.y) + (y + (uv_y * q.w + uuv_y) * Real(2))),
                  if_there(all(frame.center.z) + (z + (uv_z * q.w + uuv_z) * Real(2))),
                  if_there(separation), points[0].data());
    manifold.normal = contacts.normal;
    manifold.count = static_cast<int>(kept.count);
    const auto name = [&](std::size_t i) { return bits(static_cast<int>(kept.name[i])); };
    for (std::size_t i = 0; i < 4; ++i) {
        const Row &point = points[i];
        manifold.points[i] = {{point[0], point[1], point[2]},
                              point[3],
                              i < kept.count ? contacts.feature | name(i) : 0};
    }
}

HWY_INLINE void fill_with_point(Manifold &manifold, const Vec3 &position, Real separation,
                                std::uint32_t feature, const Vec3 &normal, const Box &frame,
                                Real side) {
    manifold.normal = normal_in_world(normal, frame, side);
    add_point(manifold, frame.center + frame.rotation * position, separation, feature);
}

// --- Contacts of edges and corners ---------------------------------------------------------------

struct PointContact {
    Vec3 position; // midway, in A's frame
    Real separation;
    std::uint32_t feature;
};

// The contact of the two edges whose cross product is the axis. `sideways` is how far the line
// between their closest points is off the axis: more than rounding if a closest point is an end.
HWY_INLINE PointContact edge_contact(const RelativeBox &b, const Vec3 &half_a, const Vec3 &half_b,
                                     const Best &edges, const Vec3 &normal, Real &sideways) {
    const int number_a = supporting_edge(static_cast<int>(edges.i), normal);
    const Vec3 normal_in_b = -(normal * b.axes); // transposed: into B's frame
    const int number_b = supporting_edge(static_cast<int>(edges.j), normal_in_b);
    const Edge on_a = edge(half_a, number_a);
    const Edge on_b = edge(half_b, number_b);
    const Vec3 start_b = b.position + b.axes * on_b.start;
    const Vec3 along_b = b.axes * on_b.along;
    const SegmentPair pair = closest_between_segments(on_a.start, on_a.along, start_b, along_b);
    sideways = glm::length(pair.difference - edges.separation * normal);
    return {on_a.start + pair.s * on_a.along + Real(0.5) * pair.difference, edges.separation,
            kind_edges | bits(number_a) << 8 | bits(number_b)};
}

// The closest points of two disjoint boxes when they are a corner and a box, not interior points of
// two edges. (If interior points of edges are closest, the edges' axis is the best of all and its
// separation is the distance, so that case never gets here.)
struct ClosestPair {
    Vec3 on_a{Real(0)};
    Vec3 difference{Real(0)};
    Real squared_distance = infinity;
    std::uint32_t feature = 0;
};

HWY_NOINLINE ClosestPair closest_corner(const RelativeBox &b, const Vec3 &half_a,
                                        const Vec3 &half_b) {
    // Two closest corners are found from both boxes; the first one found names the feature.
    constexpr Real clearly = Real(0.9999);
    ClosestPair best;
    const auto consider = [&](const Vec3 &on_a, const Vec3 &difference, std::uint32_t feature)
                              HWY_ATTR {
                                  const Real squared_distance = glm::dot(difference, difference);
                                  if (squared_distance < best.squared_distance * clearly)
                                      best = {on_a, difference, squared_distance, feature};
                              };
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner_b = b.position + b.axes * corner(half_b, i);
        const Vec3 on_a = glm::clamp(corner_b, -half_a, half_a);
        consider(on_a, corner_b - on_a, kind_closest | 1U << 16 | bits(i));
    }
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner_a = corner(half_a, i);
        const Vec3 in_b = (corner_a - b.position) * b.axes;
        const Vec3 gap = glm::clamp(in_b, -half_b, half_b) - in_b;
        consider(corner_a, b.axes * gap, kind_closest | 2U << 16 | bits(i));
    }
    return best;
}

// Whether a is the reference when both boxes' faces are equally good: the larger box is. The choice
// does not change while the bodies move or, except for boxes of equal size, with the argument
// order.
HWY_INLINE bool is_reference(const Vec3 &a, const Vec3 &b) {
    const Real sum_a = a.x + a.y + a.z;
    const Real sum_b = b.x + b.y + b.z;
    if (sum_a == sum_b) [[unlikely]] {
        if (a.x != b.x)
            return a.x > b.x;
        return a.y >= b.y;
    }
    return sum_a > sum_b;
}

} // namespace

[[gnu::flatten]] void collide_boxes(const Box &one, const Box &two, Real margin,
                                    Manifold &manifold) {
    const bool is_first = is_reference(one.half_extents, two.half_extents);
    const Box &a = is_first ? one : two;
    const Box &b = is_first ? two : one;
    const Real side = is_first ? Real(1) : Real(-1);
    const Vec3 &half_a = a.half_extents;
    const Vec3 &half_b = b.half_extents;
    manifold.normal = side * manifold.normal;

    const RelativeBox b_in_a = relative_to(a, b);
    Placing placing;
    const Faces faces = best_faces(b_in_a, half_a, half_b, placing);
    const Real best_face = std::max(faces.a.separation, faces.b.separation);
    if (best_face > margin)
        return;
    Vec3 edge_normal{};
    const Best edges = best_edges(b_in_a, half_a, half_b, placing, edge_normal);
    const Real best = std::max(best_face, edges.separation);
    if (best > margin)
        return;

    // A contact is tight if its deepest point is as deep as the best axis predicts: then no other
    // part of the boxes is deeper or closer. Overlapping boxes always have a tight contact;
    // disjoint ones do unless a corner is closest to a corner or an edge.
    constexpr Real tight = Real(2) * feature_tolerance;
    Real least_off = infinity; // from tight
    Real depth = infinity;
    std::array<FaceContacts, 2> tried;
    std::size_t closest_face = 2; // to tight; 2: none

    // Prefer A's face unless B's is better, and a face unless the edges are better. Edges do not
    // win if their axis is nearly parallel to the face's normal and the face contact is tight: then
    // two crossing edges are deepest, and their crossing is one of the clipped points anyway. So a
    // box rocking on another keeps its four points.
    constexpr Real little = Real(0.99); // cosine of 8 degrees
    if (edges.separation <= best_face + feature_tolerance ||
        glm::dot(edge_normal, faces.b.separation > faces.a.separation
                                  ? normal_of_face_b(placing, faces.b.i)
                                  : normal_of_face_a(placing, faces.a.i)) > little) {
        const bool a_first = faces.b.separation <= faces.a.separation + feature_tolerance;
        const auto is_tight_at = [&](std::size_t attempt, Real reach) HWY_ATTR {
            const bool use_a = a_first == (attempt == 0);
            const std::size_t axis = use_a ? faces.a.i : faces.b.i;
            const Real towards = use_a ? placing.b_position[axis] : placing.a_position[axis];
            const bool is_up = use_a ? !(towards < Real(0)) : towards > Real(0);
            find_face_contacts(use_a ? a : b, use_a ? side : -side, axis,
                               is_up ? Real(1) : Real(-1), use_a ? placing.b_axes : placing.a_axes,
                               use_a ? placing.b_position : placing.a_position,
                               use_a ? half_b : half_a, reach,
                               use_a ? kind_face : kind_face | 1U << 20, tried[attempt]);
            const Real off = std::abs(tried[attempt].points.lowest - best);
            if (off < least_off) {
                least_off = off;
                depth = tried[attempt].points.lowest;
                closest_face = attempt;
            }
            return off <= tight;
        };
        for (std::size_t attempt = 0; attempt < 2; ++attempt)
            if (is_tight_at(attempt, margin)) {
                add_face_contacts(manifold, tried[attempt]);
                return;
            }
        // Boxes that just touch, with points that rounding puts beyond the margin.
        for (std::size_t attempt = 0; best <= Real(0) && attempt < 2; ++attempt)
            if (is_tight_at(attempt, margin + tight)) {
                clamp_heights(tried[attempt].points, margin);
                add_face_contacts(manifold, tried[attempt]);
                return;
            }
    }
    if (edges.separation > -infinity) {
        Real sideways = Real(0);
        const PointContact contact =
            edge_contact(b_in_a, half_a, half_b, edges, edge_normal, sideways);
        const Real off = std::abs(contact.separation - best);
        if ((sideways <= tight || best <= Real(0)) && off < least_off) {
            least_off = off;
            depth = contact.separation;
            closest_face = 2;
            fill_with_point(manifold, contact.position, contact.separation, contact.feature,
                            edge_normal, a, side);
            if (off <= tight)
                return;
        }
    }
    if (best > Real(0)) {
        const ClosestPair closest = closest_corner(b_in_a, half_a, half_b);
        const Real distance = std::sqrt(closest.squared_distance);
        if (distance <= margin && distance > Real(0) && depth > distance + feature_tolerance) {
            manifold.count = 0;
            fill_with_point(manifold, closest.on_a + Real(0.5) * closest.difference, distance,
                            closest.feature, closest.difference / distance, a, side);
            return;
        }
    }
    if (closest_face < 2)
        add_face_contacts(manifold, tried[closest_face]);
}

void find_axes(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b, BoxAxes &best) {
    Placing placing;
    const Faces faces = best_faces(relative, half_a, half_b, placing);
    const int i = static_cast<int>(faces.a.i), j = static_cast<int>(faces.b.i);
    best.face_a = {faces.a.separation, normal_of_face_a(placing, faces.a.i), i, 0};
    best.face_b = {faces.b.separation, normal_of_face_b(placing, faces.b.i), 0, j};
    Vec3 normal{};
    const Best edges = best_edges(relative, half_a, half_b, placing, normal);
    if (edges.separation > -infinity)
        best.edges = {edges.separation, normal, static_cast<int>(edges.i),
                      static_cast<int>(edges.j)};
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(collide_boxes);
HWY_EXPORT(find_axes);

namespace {
void fill(Manifold &manifold, const Box &a, const Box &b, Real margin) {
    HWY_DYNAMIC_DISPATCH(collide_boxes)(a, b, margin, manifold);
}
void find(BoxAxes &best, const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b) {
    HWY_DYNAMIC_DISPATCH(find_axes)(relative, half_a, half_b, best);
}
} // namespace

} // namespace kernels

Manifold unchecked::collide(const Box &a, const Box &b, Real margin) {
    Manifold manifold;
    kernels::fill(manifold, a, b, margin);
    return manifold;
}

BoxAxes best_axes(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b) {
    BoxAxes best;
    kernels::find(best, relative, half_a, half_b);
    return best;
}

} // namespace plumb::inline PLUMB_PRECISION
#endif
