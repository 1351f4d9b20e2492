// Contacts of boxes with round shapes and half-spaces.
#include "engine/geometry/box_parts.h"
#include "engine/geometry/closest.h"
#include "engine/geometry/manifold_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A contact point before it is transformed to the world.
struct FaceContact {
    Vec3 position; // midway, in the frame of the reference box
    Real separation;
    std::uint32_t feature;
};

// At most eight points; four are kept.
struct FaceContacts {
    std::array<FaceContact, 8> points;
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

Manifold in_world(const FaceContacts &local, const Vec3 &local_normal, const Box &frame,
                  bool is_flipped) {
    Manifold manifold;
    if (local.count == 0)
        return manifold;
    manifold.normal = glm::normalize(frame.rotation * local_normal);
    if (is_flipped)
        manifold.normal = -manifold.normal;
    for (int i = 0; i < local.count; ++i)
        add_point(manifold, frame.center + frame.rotation * local[i].position, local[i].separation,
                  local[i].feature);
    return manifold;
}

bool is_inner(Real parameter) {
    return parameter > Real(0) && parameter < Real(1);
}

// A separating axis of a box and a segment.
struct SegmentAxis {
    Real separation = -std::numeric_limits<Real>::infinity();
    Vec3 normal{Real(0)}; // unit, out of the box, in its frame
    int index = 0;
};

} // namespace

namespace unchecked {

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

// The other end of a segment that leans over the face nearest to the normal.
void add_other_end(FaceContacts &contacts, const Vec3 &half, const Vec3 &start, const Vec3 &end,
                   Real radius, const Vec3 &surface, const Vec3 &normal, Real margin) {
    const Vec3 steep = glm::abs(normal);
    const int axis = steep.x >= steep.y && steep.x >= steep.z ? 0 : (steep.y >= steep.z ? 1 : 2);
    const Real sign = normal[axis] < Real(0) ? Real(-1) : Real(1);
    Vec3 face_normal{Real(0)};
    face_normal[axis] = sign;
    Vec3 u{Real(0)}, v{Real(0)};
    u[(axis + 1) % 3] = half[(axis + 1) % 3];
    v[(axis + 2) % 3] = sign * half[(axis + 2) % 3];
    const Vec3 middle = half[axis] * face_normal;
    const std::array<Vec3, 4> face{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    const std::optional<OtherEnd> other = other_end(face, face_normal, start, end, surface, normal);
    if (!other || other->height - radius > margin)
        return;
    const Real separation = other->height - radius;
    contacts.add(other->foot + Real(0.5) * separation * normal, separation,
                 kind_closest | 4U << 16 | bits(face_number(axis, sign)) << 1 |
                     (other->is_last ? 1U : 0U));
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
    SegmentAxis face;
    for (int i = 0; i < 3; ++i) {
        for (const Real sign : {Real(1), Real(-1)}) {
            const Real separation = std::min(sign * start[i], sign * end[i]) - half[i];
            if (separation > face.separation) {
                Vec3 normal{Real(0)};
                normal[i] = sign;
                face = {separation, normal, i};
            }
        }
    }
    SegmentAxis edges;
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
            edges = {separation, sign * axis, i};
    }
    const SegmentAxis &best = edges.separation > face.separation ? edges : face;
    if (best.separation - b.radius > margin)
        return {};

    // On a face: both ends of the part of the segment above it.
    FaceContacts on_face;
    const Vec3 face_normal = face.normal;
    if (edges.separation <= face.separation + feature_tolerance) {
        const int axis = face.index;
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
        const int number = supporting_edge(edges.index, edges.normal);
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
    if (separation <= feature_tolerance)
        add_other_end(contacts, half, start, end, b.radius, surface, normal, margin);
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
