// Contacts of boxes.
#include "engine/geometry/closest.h"
#include "engine/geometry/manifold_pairs.h"
#include "engine/geometry/sat_axes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Feature ids. The lowest bits name the part, these the kind of contact, so that no two kinds share
// an id.
constexpr std::uint32_t kind_face = 1U << 24;
constexpr std::uint32_t kind_edges = 2U << 24;
constexpr std::uint32_t kind_closest = 3U << 24;

std::uint32_t bits(int value) {
    return static_cast<std::uint32_t>(value);
}

// Faces are numbered 2 * axis, plus 1 on the positive side.
int face_number(int axis, Real sign) {
    return 2 * axis + (sign > Real(0) ? 1 : 0);
}

Vec3 corner(const Vec3 &half_extents, int index) {
    return {(index & 1) != 0 ? half_extents.x : -half_extents.x,
            (index & 2) != 0 ? half_extents.y : -half_extents.y,
            (index & 4) != 0 ? half_extents.z : -half_extents.z};
}

// Edges are numbered 4 * direction, plus 1 if the next coordinate is positive, plus 2 if the one
// after it is.
struct Edge {
    Vec3 start{Real(0)};
    Vec3 along{Real(0)};
};

Edge edge(const Vec3 &half_extents, int number) {
    const int i = number / 4;
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    Edge result;
    result.start[i] = -half_extents[i];
    result.start[j] = (number & 1) != 0 ? half_extents[j] : -half_extents[j];
    result.start[k] = (number & 2) != 0 ? half_extents[k] : -half_extents[k];
    result.along[i] = Real(2) * half_extents[i];
    return result;
}

// The edge along axis i that contains the support point for `direction`.
int supporting_edge(int i, const Vec3 &direction) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    return 4 * i + (direction[j] > Real(0) ? 1 : 0) + (direction[k] > Real(0) ? 2 : 0);
}

// A contact point before it is transformed to the world.
struct FaceContact {
    Vec3 position{Real(0)}; // midway, in the frame of the reference box
    Real separation = Real(0);
    std::uint32_t feature = 0;
};

// At most eight points; four are kept.
struct FaceContacts {
    std::array<FaceContact, 8> points{};
    int count = 0;

    const FaceContact &operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
    void add(const Vec3 &position, Real separation, std::uint32_t feature) {
        if (count < 8)
            points[static_cast<std::size_t>(count++)] = {position, separation, feature};
    }
    Real deepest() const {
        Real least = std::numeric_limits<Real>::infinity();
        for (int i = 0; i < count; ++i)
            least = std::min(least, (*this)[i].separation);
        return least;
    }
};

// Keeps the deepest point and the three that span the largest area with it, seen along `normal`. A
// later point replaces an earlier one only if clearly better, so that equally good points do not
// alternate.
FaceContacts best_four(const FaceContacts &all, const Vec3 &normal) {
    if (all.count <= 4)
        return all;
    constexpr Real clearly = Real(1.01);
    std::array<int, 4> kept{};
    std::array<bool, 8> taken{};

    int first = 0;
    for (int i = 1; i < all.count; ++i)
        if (all[i].separation < all[first].separation - feature_tolerance)
            first = i;
    // The scan above may leave a point that is shallower than the deepest by more than the
    // tolerance, because the tolerances of successive replacements add up. Allow only one.
    const Real deepest = all.deepest();
    for (int i = 0; i < all.count && all[first].separation > deepest + feature_tolerance; ++i)
        if (all[i].separation <= deepest + feature_tolerance)
            first = i;
    kept[0] = first;
    taken[static_cast<std::size_t>(first)] = true;
    const Vec3 &origin = all[first].position;

    const auto pick = [&](int slot, const auto &score) {
        int best = -1;
        Real best_score = Real(0);
        for (int i = 0; i < all.count; ++i) {
            if (taken[static_cast<std::size_t>(i)])
                continue;
            const Real value = score(all[i].position - origin);
            if (best < 0 || value > best_score * clearly) {
                best = i;
                best_score = value;
            }
        }
        kept[static_cast<std::size_t>(slot)] = best;
        taken[static_cast<std::size_t>(best)] = true;
    };
    const auto flattened = [&](const Vec3 &v) { return v - normal * glm::dot(v, normal); };

    pick(1, [&](const Vec3 &v) {
        const Vec3 flat = flattened(v);
        return glm::dot(flat, flat);
    });
    const Vec3 base = all[kept[1]].position - origin;
    const auto signed_area = [&](const Vec3 &v) { return glm::dot(glm::cross(base, v), normal); };
    pick(2, [&](const Vec3 &v) { return std::abs(signed_area(v)); });
    // The fourth adds the most area outside the triangle, beyond one of its sides.
    const Vec3 apex = all[kept[2]].position - origin;
    const Real turn = signed_area(apex) < Real(0) ? Real(-1) : Real(1);
    pick(3, [&](const Vec3 &v) {
        const auto beyond = [&](const Vec3 &from, const Vec3 &to) {
            return -turn * glm::dot(glm::cross(to - from, v - from), normal);
        };
        const Real most = std::max(
            {beyond(Vec3{Real(0)}, base), beyond(base, apex), beyond(apex, Vec3{Real(0)})});
        return std::max(most, Real(0));
    });

    std::sort(kept.begin(), kept.end());
    FaceContacts result;
    for (const int i : kept)
        result.add(all[i].position, all[i].separation, all[i].feature);
    return result;
}

Manifold in_world(const FaceContacts &local, const Vec3 &local_normal, const Box &frame,
                  bool is_flipped) {
    Manifold manifold;
    if (local.count == 0)
        return manifold;
    const FaceContacts kept = best_four(local, local_normal);
    manifold.normal = glm::normalize(frame.rotation * local_normal);
    if (is_flipped)
        manifold.normal = -manifold.normal;
    for (int i = 0; i < kept.count; ++i)
        add_point(manifold, frame.center + frame.rotation * kept[i].position, kept[i].separation,
                  kept[i].feature);
    return manifold;
}

// --- Box against box ---------------------------------------------------------------------------

// A corner of the polygon being clipped, in the coordinates of the reference face. `name` is 0..3
// for a corner of the incident face, else 4 + 4 * label of the polygon side + clip plane. `side`
// labels the side from this corner to the next: 0..3 for the incident face, 4..7 for clip planes.
struct FaceCorner {
    Real u = Real(0);
    Real v = Real(0);
    Real height = Real(0);
    int name = 0;
    int side = 0;
};

struct FacePolygon {
    std::array<FaceCorner, 8> corners{};
    int count = 0;

    void add(const FaceCorner &corner) {
        if (count < 8)
            corners[static_cast<std::size_t>(count++)] = corner;
    }
};

// One plane of Sutherland and Hodgman 1974, "Reentrant polygon clipping". Corners within
// feature_tolerance of the plane count as on it and keep their names.
FacePolygon clipped(const FacePolygon &in, int plane, Real limit) {
    const auto beyond = [&](const FaceCorner &c) {
        const Real coordinate = plane < 2 ? c.u : c.v;
        const Real distance = (plane % 2 == 0 ? -coordinate : coordinate) - limit;
        return std::abs(distance) <= feature_tolerance ? Real(0) : distance;
    };
    FacePolygon out;
    for (int i = 0; i < in.count; ++i) {
        const FaceCorner &here = in.corners[static_cast<std::size_t>(i)];
        const FaceCorner &next = in.corners[static_cast<std::size_t>((i + 1) % in.count)];
        const Real d0 = beyond(here);
        const Real d1 = beyond(next);
        if (d0 <= Real(0)) {
            FaceCorner kept = here;
            if (d0 == Real(0) && d1 > Real(0))
                kept.side = 4 + plane; // the polygon continues along the plane
            out.add(kept);
        }
        if ((d0 < Real(0) && d1 > Real(0)) || (d0 > Real(0) && d1 < Real(0))) {
            const Real s = d0 / (d0 - d1);
            FaceCorner crossing;
            crossing.u = here.u + s * (next.u - here.u);
            crossing.v = here.v + s * (next.v - here.v);
            crossing.height = here.height + s * (next.height - here.height);
            crossing.name = 4 + 4 * here.side + plane;
            crossing.side = d0 < Real(0) ? 4 + plane : here.side;
            out.add(crossing);
        }
    }
    return out;
}

// Contacts of the face `axis`, `sign` of a reference box with the most anti-parallel face of the
// incident box. `feature` names which box is the reference.
FaceContacts face_contacts(const Vec3 &half, int axis, Real sign, const RelativeBox &incident,
                           const Vec3 &incident_half, Real margin, std::uint32_t feature) {
    int incident_axis = 0;
    Real steepest = Real(-1);
    for (int j = 0; j < 3; ++j) {
        const Real slope = std::abs(incident.axes[j][axis]);
        // Only if clearly steeper: with two faces at 45 degrees the choice must not flicker.
        if (slope > steepest + Real(1e-3)) {
            steepest = slope;
            incident_axis = j;
        }
    }
    const Real incident_sign =
        incident.axes[incident_axis][axis] * sign > Real(0) ? Real(-1) : Real(1);
    const int j = (incident_axis + 1) % 3;
    const int k = (incident_axis + 2) % 3;
    const Vec3 middle = incident.position + incident.axes[incident_axis] *
                                                (incident_sign * incident_half[incident_axis]);
    const Vec3 side_j = incident.axes[j] * incident_half[j];
    const Vec3 side_k = incident.axes[k] * incident_half[k];
    const std::array<Vec3, 4> face = {middle - side_j - side_k, middle + side_j - side_k,
                                      middle + side_j + side_k, middle - side_j + side_k};

    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    FacePolygon polygon;
    for (int i = 0; i < 4; ++i) {
        const Vec3 &p = face[static_cast<std::size_t>(i)];
        polygon.add({p[u], p[v], sign * p[axis] - half[axis], i, i});
    }
    for (int plane = 0; plane < 4 && polygon.count > 0; ++plane)
        polygon = clipped(polygon, plane, plane < 2 ? half[u] : half[v]);

    feature |= bits(face_number(axis, sign)) << 16 | bits(face_number(incident_axis, incident_sign))
                                                         << 8;
    FaceContacts result;
    for (int i = 0; i < polygon.count; ++i) {
        const FaceCorner &c = polygon.corners[static_cast<std::size_t>(i)];
        if (c.height > margin)
            continue;
        Vec3 position{Real(0)};
        position[u] = c.u;
        position[v] = c.v;
        position[axis] = sign * (half[axis] + Real(0.5) * c.height);
        result.add(position, c.height, feature | bits(c.name));
    }
    return result;
}

// The contact of the two edges whose cross product is the axis. `sideways` is how far the line
// between their closest points is off the axis: more than rounding if a closest point is an end.
FaceContacts edge_contact(const RelativeBox &b, const Vec3 &half_a, const Vec3 &half_b,
                          const BoxAxis &axis, Real &sideways) {
    const int number_a = supporting_edge(axis.index_a, axis.normal);
    const Vec3 normal_in_b = -(axis.normal * b.axes); // transposed: into B's frame
    const int number_b = supporting_edge(axis.index_b, normal_in_b);
    const Edge on_a = edge(half_a, number_a);
    const Edge on_b = edge(half_b, number_b);
    const Vec3 start_b = b.position + b.axes * on_b.start;
    const Vec3 along_b = b.axes * on_b.along;
    const SegmentPair pair = closest_between_segments(on_a.start, on_a.along, start_b, along_b);
    sideways = glm::length(pair.difference - axis.separation * axis.normal);
    const Vec3 middle = on_a.start + pair.s * on_a.along + Real(0.5) * pair.difference;
    FaceContacts result;
    result.add(middle, axis.separation, kind_edges | bits(number_a) << 8 | bits(number_b));
    return result;
}

bool is_inner(Real parameter) {
    return parameter > Real(0) && parameter < Real(1);
}

// The closest points of two disjoint boxes when they are a corner and a box, not interior points of
// two edges. (If interior points of edges are closest, the edges' axis is the best of all and its
// separation is the distance, so that case never gets here.)
struct ClosestPair {
    Vec3 on_a{Real(0)};
    Vec3 difference{Real(0)};
    Real squared_distance = std::numeric_limits<Real>::infinity();
    std::uint32_t feature = 0;
};

ClosestPair closest_corner(const RelativeBox &b, const Vec3 &half_a, const Vec3 &half_b) {
    // Two closest corners are found from both boxes; the first one found names the feature.
    constexpr Real clearly = Real(0.9999);
    ClosestPair best;
    const auto consider = [&](const Vec3 &on_a, const Vec3 &difference, std::uint32_t feature) {
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
bool is_reference(const Vec3 &a, const Vec3 &b) {
    const Real sum_a = a.x + a.y + a.z;
    const Real sum_b = b.x + b.y + b.z;
    if (sum_a != sum_b)
        return sum_a > sum_b;
    if (a.x != b.x)
        return a.x > b.x;
    return a.y >= b.y;
}

} // namespace

namespace unchecked {

Manifold collide(const Box &a, const Box &b, Real margin) {
    if (!is_reference(a.half_extents, b.half_extents))
        return mirrored(collide(b, a, margin));

    const Vec3 &half_a = a.half_extents;
    const Vec3 &half_b = b.half_extents;
    const RelativeBox b_in_a = relative_to(a, b);
    const BoxAxes axes = best_axes(b_in_a, half_a, half_b, margin);
    const BoxAxis &best_face =
        axes.face_b.separation > axes.face_a.separation ? axes.face_b : axes.face_a;
    const BoxAxis &best = axes.edges.separation > best_face.separation ? axes.edges : best_face;
    if (best.separation > margin)
        return {};

    // A contact is tight if its deepest point is as deep as the best axis predicts: then no other
    // part of the boxes is deeper or closer. Overlapping boxes always have a tight contact;
    // disjoint ones do unless a corner is closest to a corner or an edge.
    constexpr Real tight = Real(2) * feature_tolerance;
    const auto with_face_of_a = [&] {
        const int i = axes.face_a.index_a;
        return face_contacts(half_a, i, axes.face_a.normal[i], b_in_a, half_b, margin, kind_face);
    };
    const auto with_face_of_b = [&] {
        const Mat3 to_b = glm::transpose(b_in_a.axes);
        const RelativeBox a_in_b = {-(to_b * b_in_a.position), to_b};
        const int j = axes.face_b.index_b;
        const Real sign =
            glm::dot(axes.face_b.normal, b_in_a.axes[j]) > Real(0) ? Real(-1) : Real(1);
        return face_contacts(half_b, j, sign, a_in_b, half_a, margin, kind_face | 1U << 20);
    };
    const auto normal_of_b = [&] {
        const int j = axes.face_b.index_b;
        Vec3 normal{Real(0)};
        normal[j] = glm::dot(axes.face_b.normal, b_in_a.axes[j]) > Real(0) ? Real(-1) : Real(1);
        return normal;
    };

    Manifold result; // the closest to tight so far
    Real off_best = std::numeric_limits<Real>::infinity();
    Real depth = std::numeric_limits<Real>::infinity();
    const auto accept = [&](const FaceContacts &contacts, const Vec3 &normal, const Box &frame,
                            bool is_flipped) {
        const Real deepest = contacts.deepest();
        const Real off = std::abs(deepest - best.separation);
        if (off < off_best) {
            result = in_world(contacts, normal, frame, is_flipped);
            off_best = off;
            depth = deepest;
        }
        return off <= tight;
    };

    // Prefer A's face unless B's is better, and a face unless the edges are better. Edges do not
    // win if their axis is nearly parallel to the face's normal and the face contact is tight: then
    // two crossing edges are deepest, and their crossing is one of the clipped points anyway. So a
    // box rocking on another keeps its four points.
    constexpr Real little = Real(0.99); // cosine of 8 degrees
    if (axes.edges.separation <= best_face.separation + feature_tolerance ||
        glm::dot(axes.edges.normal, best_face.normal) > little) {
        const bool a_first = axes.face_b.separation <= axes.face_a.separation + feature_tolerance;
        for (const bool use_a : {a_first, !a_first}) {
            if (use_a && accept(with_face_of_a(), axes.face_a.normal, a, false))
                return result;
            if (!use_a && accept(with_face_of_b(), normal_of_b(), b, true))
                return result;
        }
    }
    if (axes.edges.separation > -std::numeric_limits<Real>::infinity()) {
        Real sideways = Real(0);
        const FaceContacts contact = edge_contact(b_in_a, half_a, half_b, axes.edges, sideways);
        const bool is_tight = sideways <= tight;
        if ((is_tight || best.separation <= Real(0)) &&
            accept(contact, axes.edges.normal, a, false))
            return result;
    }
    if (best.separation <= Real(0))
        return result;

    const ClosestPair closest = closest_corner(b_in_a, half_a, half_b);
    const Real distance = std::sqrt(closest.squared_distance);
    if (distance > margin || !(distance > Real(0)))
        return result;
    if (depth <= distance + feature_tolerance)
        return result;
    FaceContacts contact;
    contact.add(closest.on_a + Real(0.5) * closest.difference, distance, closest.feature);
    return in_world(contact, closest.difference / distance, a, false);
}

// --- Box against round shapes and half-space -----------------------------------------------------

Manifold collide(const Sphere &a, const Box &b, Real margin) {
    const Vec3 center = glm::conjugate(b.rotation) * (a.center - b.center);
    const Vec3 on_box = glm::clamp(center, -b.half_extents, b.half_extents);
    const Vec3 outside = center - on_box;
    const Real squared_distance = glm::dot(outside, outside);

    // The feature is the closest region of the box, in base 3: 0 below, 1 within, 2 above.
    Vec3 normal{Real(0)}; // out of the box, in the box's frame
    Vec3 surface = on_box;
    Real distance = std::sqrt(squared_distance);
    std::uint32_t feature = 0;
    if (squared_distance >= std::numeric_limits<Real>::min()) {
        normal = outside / distance;
        std::uint32_t place = 1;
        for (int i = 0; i < 3; ++i, place *= 3)
            feature += place * (outside[i] > Real(0) ? 2U : outside[i] < Real(0) ? 0U : 1U);
    } else {
        // The centre is in the box: push out through the nearest face.
        int axis = 0;
        Real depth = std::numeric_limits<Real>::infinity();
        for (int i = 0; i < 3; ++i) {
            const Real to_face = b.half_extents[i] - std::abs(center[i]);
            if (to_face < depth) {
                depth = to_face;
                axis = i;
            }
        }
        const Real sign = center[axis] < Real(0) ? Real(-1) : Real(1);
        normal[axis] = sign;
        surface[axis] = sign * b.half_extents[axis];
        distance = -depth;
        std::uint32_t place = 1;
        for (int i = 0; i < 3; ++i, place *= 3)
            feature += place * (i != axis ? 1U : sign > Real(0) ? 2U : 0U);
    }
    const Real separation = distance - a.radius;
    if (separation > margin)
        return {};
    FaceContacts contact;
    contact.add(surface + Real(0.5) * separation * normal, separation, feature);
    return in_world(contact, normal, b, true);
}

Manifold collide(const Box &a, const Capsule &b, Real margin) {
    const Vec3 &half = a.half_extents;
    const Quat to_box = glm::conjugate(a.rotation);
    const Vec3 start = to_box * (b.a - a.center);
    const Vec3 along = to_box * (b.b - b.a);
    const Vec3 end = start + along;
    const Real length = glm::length(along);
    if (!(length >= std::sqrt(std::numeric_limits<Real>::min())))
        return mirrored(collide(Sphere{b.a, b.radius}, a, margin));

    // The separating axis test of a segment and a box: three face normals and three cross products.
    BoxAxis face;
    for (int i = 0; i < 3; ++i) {
        for (const Real sign : {Real(1), Real(-1)}) {
            const Real separation = std::min(sign * start[i], sign * end[i]) - half[i];
            if (separation > face.separation) {
                Vec3 normal{Real(0)};
                normal[i] = sign;
                face = {separation, normal, i, 0};
            }
        }
    }
    BoxAxis edges;
    const Vec3 direction = along / length;
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{Real(0)}; // e_i x direction
        axis[(i + 1) % 3] = -direction[(i + 2) % 3];
        axis[(i + 2) % 3] = direction[(i + 1) % 3];
        const Real sine = glm::length(axis);
        if (sine <= Real(16) * std::numeric_limits<Real>::epsilon())
            continue;
        axis /= sine;
        const Real at_start = glm::dot(start, axis);
        const Real at_end = glm::dot(end, axis);
        const Real sign = at_start + at_end < Real(0) ? Real(-1) : Real(1);
        const Real separation =
            std::min(sign * at_start, sign * at_end) - glm::dot(glm::abs(axis), half);
        if (separation > edges.separation)
            edges = {separation, sign * axis, i, 0};
    }
    const BoxAxis &best = edges.separation > face.separation ? edges : face;
    if (best.separation - b.radius > margin)
        return {};

    // On a face: both ends of the part of the segment above it.
    FaceContacts on_face;
    const Vec3 face_normal = face.normal;
    if (edges.separation <= face.separation + feature_tolerance) {
        const int axis = face.index_a;
        const Real sign = face_normal[axis];
        Real low = Real(0);
        Real high = Real(1);
        std::uint32_t low_name = 0;
        std::uint32_t high_name = 1;
        for (const int side : {(axis + 1) % 3, (axis + 2) % 3}) {
            for (const Real way : {Real(1), Real(-1)}) {
                // Clip to way * (start + s * along) <= half; ends on the border keep their names.
                Real d0 = way * start[side] - half[side];
                Real d1 = way * end[side] - half[side];
                if (std::abs(d0) <= feature_tolerance)
                    d0 = Real(0);
                if (std::abs(d1) <= feature_tolerance)
                    d1 = Real(0);
                if (d0 <= Real(0) && d1 <= Real(0))
                    continue;
                const std::uint32_t name = 2 + bits(face_number(side, way));
                if (d0 > Real(0) && d1 > Real(0)) {
                    high = Real(-1);
                } else if (d1 > d0) {
                    const Real s = d0 / (d0 - d1);
                    if (s < high) {
                        high = s;
                        high_name = name;
                    }
                } else {
                    const Real s = d0 / (d0 - d1);
                    if (s > low) {
                        low = s;
                        low_name = name;
                    }
                }
            }
        }
        const std::uint32_t feature = kind_face | bits(face_number(axis, sign)) << 16;
        const auto add = [&](Real s, std::uint32_t name) {
            const Vec3 p = s == Real(1) ? end : start + s * along;
            const Real separation = sign * p[axis] - half[axis] - b.radius;
            if (separation > margin)
                return;
            Vec3 position = p;
            position[axis] = sign * (half[axis] + Real(0.5) * separation);
            on_face.add(position, separation, feature | name);
        };
        if (low <= high) {
            add(low, low_name);
            if (high > low)
                add(high, high_name);
        }
        if (on_face.deepest() <= best.separation - b.radius + Real(2) * feature_tolerance)
            return in_world(on_face, face_normal, a, false);
    }

    if (best.separation <= Real(0)) {
        // The segment runs through the box, and the shortest way out is across an edge.
        if (!(edges.separation > -std::numeric_limits<Real>::infinity()))
            return in_world(on_face, face_normal, a, false);
        const int number = supporting_edge(edges.index_a, edges.normal);
        const Edge box_edge = edge(half, number);
        const SegmentPair pair =
            closest_between_segments(box_edge.start, box_edge.along, start, along);
        const Vec3 surface = box_edge.start + pair.s * box_edge.along;
        const Real separation = edges.separation - b.radius;
        FaceContacts contact;
        contact.add(surface + Real(0.5) * separation * edges.normal, separation,
                    kind_edges | bits(number));
        return in_world(contact, edges.normal, a, false);
    }

    // Disjoint: the closest points are an end and the box, a corner and the segment, or interior
    // points of an edge and the segment. An end over a face was already found above, up to
    // tolerances.
    Real least = std::numeric_limits<Real>::infinity();
    Vec3 surface{Real(0)};
    Vec3 difference{Real(0)};
    std::uint32_t feature = 0;
    const auto consider = [&](const Vec3 &on_box, const Vec3 &away, std::uint32_t name) {
        constexpr Real clearly = Real(0.9999); // if several find the same pair, the first names it
        const Real squared_distance = glm::dot(away, away);
        if (squared_distance < least * clearly) {
            least = squared_distance;
            surface = on_box;
            difference = away;
            feature = kind_closest | name;
        }
    };
    for (int i = 0; i < 2; ++i) {
        const Vec3 &p = i == 0 ? start : end;
        const Vec3 on_box = glm::clamp(p, -half, half);
        consider(on_box, p - on_box, 1U << 16 | bits(i));
    }
    for (int i = 0; i < 8; ++i) {
        const Vec3 p = corner(half, i);
        consider(p, (start - p) + closest_parameter(start, along, p) * along, 2U << 16 | bits(i));
    }
    for (int i = 0; i < 12; ++i) {
        const Edge box_edge = edge(half, i);
        const SegmentPair pair =
            closest_between_segments(box_edge.start, box_edge.along, start, along);
        if (is_inner(pair.s) && is_inner(pair.t))
            consider(box_edge.start + pair.s * box_edge.along, pair.difference, 3U << 16 | bits(i));
    }
    const Real distance = std::sqrt(least);
    const Real separation = distance - b.radius;
    if (separation > margin || !(distance > Real(0)))
        return in_world(on_face, face_normal, a, false);
    if (on_face.deepest() <= separation + feature_tolerance)
        return in_world(on_face, face_normal, a, false);

    FaceContacts contacts;
    const Vec3 normal = difference / distance;
    const Vec3 slope = glm::abs(direction);
    const int main_axis =
        slope.x >= slope.y && slope.x >= slope.z ? 0 : (slope.y >= slope.z ? 1 : 2);
    const int next = (main_axis + 1) % 3;
    const int last = (main_axis + 2) % 3;
    if (std::abs(surface[next]) >= half[next] && std::abs(surface[last]) >= half[last]) {
        // Along the most nearly parallel edge there may be two contacts.
        const Edge box_edge = edge(half, supporting_edge(main_axis, surface));
        const Capsule as_capsule{box_edge.start, box_edge.start + box_edge.along, Real(0)};
        const Manifold beside = collide(as_capsule, Capsule{start, end, b.radius}, margin);
        if (beside.count == 2) {
            for (int i = 0; i < 2; ++i) {
                const ManifoldPoint &point = beside.points[static_cast<std::size_t>(i)];
                contacts.add(point.position, point.separation,
                             kind_edges | 1U << 16 | point.feature << 8 |
                                 bits(supporting_edge(main_axis, surface)));
            }
            return in_world(contacts, beside.normal, a, false);
        }
    }
    contacts.add(surface + Real(0.5) * separation * normal, separation, feature);
    return in_world(contacts, normal, a, false);
}

Manifold collide(const Box &a, const HalfSpace &b, Real margin) {
    const Vec3 up = glm::conjugate(a.rotation) * b.normal; // in the box's frame
    const Real height = glm::dot(b.normal, a.center) - b.offset;
    FaceContacts corners;
    for (int i = 0; i < 8; ++i) {
        const Vec3 p = corner(a.half_extents, i);
        const Real separation = height + glm::dot(up, p);
        if (separation <= margin)
            corners.add(p - Real(0.5) * separation * up, separation, bits(i));
    }
    if (corners.count > 4) {
        // Keep the corners of the face turned most towards the plane: they have the widest spread
        // and include the deepest, and no kept corner has a deeper one below it.
        const Vec3 steep = glm::abs(up);
        const int axis =
            steep.y >= steep.x && steep.y >= steep.z ? 1 : (steep.x >= steep.z ? 0 : 2);
        const int lower = up[axis] < Real(0) ? 1 << axis : 0;
        FaceContacts kept;
        for (int i = 0; i < corners.count; ++i)
            if ((static_cast<int>(corners[i].feature) & (1 << axis)) == lower)
                kept.add(corners[i].position, corners[i].separation, corners[i].feature);
        corners = kept;
    }
    return in_world(corners, -up, a, false);
}

} // namespace unchecked

} // namespace plumb::inline PLUMB_PRECISION
