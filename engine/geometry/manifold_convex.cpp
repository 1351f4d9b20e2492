// Contacts of cylinders, convex hulls and triangles with every solid.
#include "engine/geometry/edge_gap.h"
#include "engine/geometry/epa.h"
#include "engine/geometry/kept_points.h"
#include "engine/geometry/manifold_pairs.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr int corner_limit = 16;

// Point names, in the lowest bits of a feature id: corners by number, then the crossings of 16 + 16
// sides with 16 planes, then these.
constexpr std::uint32_t name_other_end = 1020; // and the next
constexpr std::uint32_t name_support = 1022;
constexpr std::uint32_t name_closest = 1023;

constexpr std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

// The part of a shape that faces the other: one corner, the two ends of a side, or the corners of a
// face, counter-clockwise around its normal.
struct Feature {
    std::array<Vec3, index(corner_limit)> corners;
    int count = 0;
    Vec3 normal{Real(0)}; // of a face, unit, outward
    std::uint32_t number = 0;

    void add(const Vec3 &corner) { corners[index(count++)] = corner; }
    bool is_face() const { return count > 2; }
};

Feature feature_of(const PointCore &point, const Vec3 & /*direction*/) {
    Feature result;
    result.add(point.point);
    return result;
}

Feature feature_of(const SegmentCore &segment, const Vec3 & /*direction*/) {
    Feature result;
    result.add(segment.a);
    if (segment.b != segment.a)
        result.add(segment.b);
    return result;
}

Feature feature_of(const TriangleCore &triangle, const Vec3 &direction) {
    Feature result;
    const Vec3 normal =
        triangle_normal(triangle.b - triangle.a, triangle.c - triangle.a, triangle.c - triangle.b);
    const Real length = glm::length(normal);
    const bool is_back = glm::dot(normal, direction) < Real(0);
    result.add(triangle.a);
    result.add(is_back ? triangle.c : triangle.b);
    result.add(is_back ? triangle.b : triangle.c);
    result.number = is_back ? 1 : 0;
    if (length >= std::sqrt(std::numeric_limits<Real>::min())) {
        result.normal = normal / (is_back ? -length : length);
        return result;
    }
    // A needle: use its longest edge.
    const std::array<Vec3, 3> corners = {triangle.a, triangle.b, triangle.c};
    Real longest = Real(-1);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &next = corners[(i + 1) % 3];
        if (glm::distance(corners[i], next) > longest) {
            longest = glm::distance(corners[i], next);
            result.corners[0] = corners[i];
            result.corners[1] = next;
        }
    }
    result.count = longest > Real(0) ? 2 : 1;
    return result;
}

Feature feature_of(const BoxCore &box, const Vec3 &direction) {
    int axis = 0;
    Real steepest = Real(-1);
    Vec3 lengths{Real(0)};
    for (int i = 0; i < 3; ++i) {
        lengths[i] = glm::length(box.half_edges[i]);
        // In a flat box a face normal may have no half edge of its own, so take the cross product
        // of the other two.
        const Vec3 normal = glm::cross(box.half_edges[(i + 1) % 3], box.half_edges[(i + 2) % 3]);
        const Real length = glm::length(normal);
        const Real slope =
            length > Real(0) ? std::abs(glm::dot(normal, direction)) / length : Real(-1);
        // Only if clearly steeper: with two faces at 45 degrees the choice must not flicker.
        if (slope > steepest + Real(1e-3)) {
            steepest = slope;
            axis = i;
        }
    }
    Feature result;
    const Vec3 u = box.half_edges[(axis + 1) % 3];
    const Vec3 v = box.half_edges[(axis + 2) % 3];
    const Vec3 up = glm::cross(u, v);
    const Real length = glm::length(up);
    if (!(length > Real(0))) { // two extents are zero
        const int longest = lengths.x >= lengths.y && lengths.x >= lengths.z ? 0
                            : lengths.y >= lengths.z                         ? 1
                                                                             : 2;
        result.add(box.center - box.half_edges[longest]);
        if (lengths[longest] > Real(0))
            result.add(box.center + box.half_edges[longest]);
        return result;
    }
    const Real sign = glm::dot(up, direction) < Real(0) ? Real(-1) : Real(1);
    result.normal = sign * up / length;
    result.number = static_cast<std::uint32_t>(2 * axis + (sign > Real(0) ? 1 : 0));
    const Vec3 middle = box.center + result.normal * lengths[axis];
    const Vec3 w = sign * v; // reverses the winding on the opposite side
    result.add(middle - u - w);
    result.add(middle + u - w);
    result.add(middle + u + w);
    result.add(middle - u + w);
    return result;
}

Feature feature_of(const CylinderCore &cylinder, const Vec3 &direction) {
    Feature result;
    const Real along = glm::dot(cylinder.axis, direction);
    const Vec3 outward = direction - along * cylinder.axis;
    const Real across = glm::length(outward);
    if (std::abs(along) < Real(0.7) && across > Real(0)) {
        // The line on the side surface farthest along the direction.
        const Vec3 off = outward * (cylinder.side / across);
        result.add(cylinder.a + off);
        result.add(cylinder.b + off);
        return result;
    }
    const bool is_end = along > Real(0);
    result.normal = is_end ? cylinder.axis : -cylinder.axis;
    result.number = is_end ? 2 : 1;
    if (!(cylinder.side > Real(0))) {
        result.add(is_end ? cylinder.b : cylinder.a);
        return result;
    }
    const TangentBasis basis = tangent_basis(result.normal);
    const Real diagonal = cylinder.side * std::sqrt(Real(0.5));
    const Vec3 &middle = is_end ? cylinder.b : cylinder.a;
    const Vec3 u = basis.t1 * cylinder.side;
    const Vec3 v = basis.t2 * cylinder.side;
    const Vec3 s = (basis.t1 + basis.t2) * diagonal;
    const Vec3 t = (basis.t2 - basis.t1) * diagonal;
    for (const Vec3 &off : {u, s, v, t, -u, -s, -v, -t})
        result.add(middle + off);
    return result;
}

Feature feature_of(const HullCore &hull, const Vec3 &direction) {
    Feature result;
    const HullMesh &mesh = *hull.mesh;
    result.number = supporting_face(mesh, direction * hull.rotation);
    const HullMesh::Face &face = mesh.faces[result.number];
    result.normal = glm::normalize(hull.rotation * mesh.planes[result.number].normal);
    const auto taken = std::min<std::uint32_t>(face.count, corner_limit);
    for (std::uint32_t i = 0; i < taken; ++i) {
        const std::uint32_t vertex = mesh.vertex_indices[face.first + i * face.count / taken];
        result.add(hull.position + hull.rotation * mesh.vertices[vertex]);
    }
    return result;
}

// The same for a load at `load`: with those corners of a round or many-cornered face that are
// nearest to the load along its outline. Their names go by their place from the load, so that their
// impulses stay with them as it moves.
template <typename Core>
Feature feature_under(const Core &core, const Vec3 &direction, const Vec3 & /*load*/) {
    return feature_of(core, direction);
}

Feature feature_under(const CylinderCore &cylinder, const Vec3 &direction, const Vec3 &load) {
    // Of 8 degrees: the chord between the two points is within 1 % of the rim, and wide enough to
    // stand on.
    constexpr Real sine = Real(0.1391731);
    constexpr Real cosine = Real(0.9902681);
    constexpr Real central = Real(0.1); // of the radius
    const Feature octagon = feature_of(cylinder, direction);
    if (!octagon.is_face())
        return octagon;
    const Vec3 &middle = octagon.number == 2 ? cylinder.b : cylinder.a;
    const Vec3 off = load - middle;
    const Vec3 across = off - glm::dot(off, octagon.normal) * octagon.normal;
    const Real distance = glm::length(across);
    const Real side = cylinder.side;
    if (!(distance > central * side))
        return octagon;
    const Vec3 u = across / distance;
    const Vec3 v = glm::cross(octagon.normal, u);
    const auto corner = [&](int i) { return octagon.corners[index(i % octagon.count)] - middle; };
    Feature result;
    result.normal = octagon.normal;
    result.number = octagon.number + 2;
    result.add(middle + side * (cosine * u - sine * v));
    result.add(middle + side * (cosine * u + sine * v));
    // The octagon's corners from there on, but for one between the two.
    const auto is_after = [&](int i) {
        return glm::dot(corner(i), cosine * v - sine * u) > Real(0);
    };
    int first = 0;
    while (!is_after(first) || is_after(first + octagon.count - 1))
        ++first;
    for (int i = first; i < first + octagon.count; ++i)
        if (glm::dot(corner(i), u) < cosine * side)
            result.add(middle + corner(i));
    return result;
}

Feature feature_under(const HullCore &hull, const Vec3 &direction, const Vec3 &load) {
    Feature result = feature_of(hull, direction);
    const HullMesh &mesh = *hull.mesh;
    const HullMesh::Face &face = mesh.faces[result.number];
    if (face.count <= corner_limit)
        return result;
    const auto corner = [&](std::uint32_t i) {
        const std::uint32_t vertex = mesh.vertex_indices[face.first + i % face.count];
        return hull.position + hull.rotation * mesh.vertices[vertex];
    };
    Vec3 middle{Real(0)};
    for (int i = 0; i < result.count; ++i)
        middle += result.corners[index(i)] / static_cast<Real>(result.count);
    // The side over which the way from the middle to the load leaves the face.
    std::uint32_t first = 0;
    Real most = Real(0);
    for (std::uint32_t i = 0; i < face.count; ++i) {
        const Vec3 at = corner(i);
        const Vec3 outward = glm::cross(corner(i + 1) - at, result.normal);
        const Real reach = glm::dot(at - middle, outward);
        const Real way = glm::dot(load - middle, outward);
        if (reach > Real(0) && way > most * reach) {
            most = way / reach;
            first = i;
        }
    }
    constexpr std::uint32_t others = corner_limit - 2;
    result.number |= 0x200U;
    result.count = 0;
    result.add(corner(first));
    result.add(corner(first + 1));
    for (std::uint32_t i = 0; i < others; ++i)
        result.add(corner(first + 2 + i * (face.count - 2) / others));
    return result;
}

// A corner of the polygon being clipped: `name` as above, `side` labels the side from here to the
// next corner: a side of the incident face, or 16 + the clip plane that made it.
struct ClipCorner {
    Vec3 position;
    std::uint32_t name;
    std::uint32_t side;
};
struct Polygon {
    std::array<ClipCorner, index(2 * corner_limit)> corners;
    int count = 0;

    void add(const ClipCorner &corner) {
        if (count < 2 * corner_limit)
            corners[index(count++)] = corner;
    }
};

// One plane of Sutherland and Hodgman 1974, "Reentrant polygon clipping". Corners within
// feature_tolerance of the plane count as on it and keep their names. Two corners are a segment,
// not a polygon with two sides.
Polygon clipped(const Polygon &in, std::uint32_t plane, const Vec3 &at, const Vec3 &outward) {
    const auto beyond = [&](const ClipCorner &corner) {
        const Real distance = glm::dot(corner.position - at, outward);
        return std::abs(distance) <= feature_tolerance ? Real(0) : distance;
    };
    Polygon out;
    for (int i = 0; i < in.count; ++i) {
        const ClipCorner &here = in.corners[index(i)];
        const ClipCorner &next = in.corners[index((i + 1) % in.count)];
        const Real d0 = beyond(here);
        const Real d1 = beyond(next);
        if (d0 <= Real(0)) {
            ClipCorner kept = here;
            if (d0 == Real(0) && d1 > Real(0))
                kept.side = corner_limit + plane; // the polygon continues along the plane
            out.add(kept);
        }
        const bool is_way_back = in.count == 2 && i == 1;
        if (!is_way_back && ((d0 < Real(0) && d1 > Real(0)) || (d0 > Real(0) && d1 < Real(0)))) {
            const Real s = d0 / (d0 - d1);
            out.add({here.position + s * (next.position - here.position),
                     corner_limit + corner_limit * here.side + plane,
                     d0 < Real(0) ? corner_limit + plane : here.side});
        }
    }
    return out;
}

// `load`: where one shape presses on the other, or null.
void add_best(Manifold &manifold, const CandidatePoints &all, const Vec3 &origin,
              const Vec3 *load) {
    const KeptPoints kept =
        load == nullptr ? best_four(all, manifold.normal) : best_under(all, manifold.normal, *load);
    for (int i = 0; i < kept.count; ++i) {
        const CandidatePoint &point = all.points[index(kept.points[index(i)])];
        add_point(manifold, origin + point.position, point.separation, point.feature);
    }
}

std::uint32_t pair_name(const Feature &reference, const Feature &incident, bool is_b) {
    return (is_b ? 1U << 31 : 0U) | (reference.number & 0x3ffU) << 20 |
           (incident.number & 0x3ffU) << 10;
}

// Contact points of the incident feature (rounded by `radius`) over the reference face.
CandidatePoints over_face(const Feature &reference, const Feature &incident, Real radius,
                          Real margin, std::uint32_t feature) {
    Polygon polygon;
    for (int i = 0; i < incident.count; ++i)
        polygon.add({incident.corners[index(i)], static_cast<std::uint32_t>(i),
                     static_cast<std::uint32_t>(i)});
    for (int i = 0; i < reference.count && polygon.count > 0; ++i) {
        const Vec3 &at = reference.corners[index(i)];
        const Vec3 side = reference.corners[index((i + 1) % reference.count)] - at;
        const Vec3 outward = glm::cross(side, reference.normal);
        const Real length = glm::length(outward);
        if (length > Real(0))
            polygon = clipped(polygon, static_cast<std::uint32_t>(i), at, outward / length);
    }
    CandidatePoints result;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipCorner &corner = polygon.corners[index(i)];
        const Real height = glm::dot(corner.position - reference.corners[0], reference.normal);
        if (height - radius <= margin)
            result.add(corner.position - reference.normal * (Real(0.5) * (height + radius)),
                       height - radius, feature | corner.name);
    }
    return result;
}

// The radius of curvature across a side; see along_sides.
template <typename Core> Real roundness(const Core &core) {
    if constexpr (std::same_as<Core, CylinderCore>)
        return core.side;
    else
        return core.radius;
}

// Two parallel sides: the ends of their overlap. `thinner` is the smaller of their roundnesses: if
// the lines are offset sideways by e, a point midway is off a surface by (e / 2)^2 / (2 thinner).
CandidatePoints along_sides(const Feature &a, Real radius_a, const Feature &b, Real radius_b,
                            const Vec3 &normal, Real thinner, Real margin, std::uint32_t feature) {
    // As for capsules (manifold_round.cpp): at this sine, sides one metre long are 2 cm apart at
    // the far end.
    constexpr Real parallel_sine = Real(0.02);
    CandidatePoints result;
    const Vec3 along_a = a.corners[1] - a.corners[0];
    const Vec3 along_b = b.corners[1] - b.corners[0];
    const Real squared_a = glm::dot(along_a, along_a);
    const Vec3 cross = glm::cross(along_a, along_b);
    if (!(glm::dot(cross, cross) <=
          parallel_sine * parallel_sine * squared_a * glm::dot(along_b, along_b)))
        return result;
    const Vec3 offset = b.corners[0] - a.corners[0];
    const Real start = glm::dot(offset, along_a) / squared_a;
    const Real step = glm::dot(along_b, along_a) / squared_a;
    const Real low = std::max(Real(0), std::min(start, start + step));
    const Real high = std::min(Real(1), std::max(start, start + step));
    if (!(high > low) || step == Real(0))
        return result;
    for (const Real s : {low, high}) {
        const Vec3 on_a = s * along_a;
        const Vec3 on_b = offset + ((s - start) / step) * along_b;
        const Vec3 sideways = on_b - on_a - glm::dot(on_b - on_a, normal) * normal;
        if (glm::dot(sideways, sideways) > Real(8) * thinner * feature_tolerance)
            return {};
        const Real separation = glm::dot(on_b - on_a, normal) - radius_a - radius_b;
        const Vec3 middle = Real(0.5) * ((on_a + radius_a * normal) + (on_b - radius_b * normal));
        if (separation <= margin)
            result.add(a.corners[0] + middle, separation, feature | (s == low ? 0U : 1U));
    }
    return result;
}

// Adds the other end of a side that leans over a face.
void add_other_end(CandidatePoints &contacts, const Feature &face, const Feature &side, Real radius,
                   const Vec3 &closest, const Vec3 &out, Real margin, std::uint32_t feature) {
    if (!face.is_face() || side.count != 2)
        return;
    const std::optional<OtherEnd> other =
        other_end(std::span(face.corners).first(index(face.count)), face.normal, side.corners[0],
                  side.corners[1], closest, out);
    if (!other || other->height - radius > margin)
        return;
    const Real separation = other->height - radius;
    contacts.add(other->foot + Real(0.5) * separation * out, separation,
                 feature | (name_other_end + (other->is_last ? 1 : 0)));
}

// Whether a point is over a face, within the tolerance.
bool is_over(const Feature &face, const Vec3 &point) {
    for (int i = 0; i < face.count; ++i) {
        const Vec3 &at = face.corners[index(i)];
        const Vec3 side = face.corners[index((i + 1) % face.count)] - at;
        const Vec3 outward = glm::cross(side, face.normal);
        if (glm::dot(point - at, outward) > feature_tolerance * glm::length(outward))
            return false;
    }
    return true;
}

// `guess`: an approximate normal; zero: unknown. Then the direction between the middles selects the
// face to try, but the search starts without a guess.
template <typename A, typename B>
Proximity proximity_near(const A &a, const B &b, Real margin, const Vec3 &guess) {
    if constexpr (HaveFaceGap<A, B>) {
        const Vec3 towards = guess == Vec3{Real(0)} ? b.middle() - a.middle() : guess;
        if (towards != Vec3{Real(0)})
            if (const std::optional<Proximity> known = feature_gap(a, b, towards, margin))
                return *known;
    }
    return proximity(CorePair(a, b), margin, guess);
}

// `load`: where one presses on the other, or null.
template <typename A, typename B>
Manifold collide_convex(const A &shape_a, const B &shape_b, Real margin,
                        const Vec3 &guess = Vec3{Real(0)}, const Vec3 *load = nullptr) {
    const Vec3 origin = place_of(shape_a);
    const auto a = core_of(shape_a, origin);
    const auto b = core_of(shape_b, origin);
    const Proximity found = proximity_near(a, b, margin, guess);
    Manifold manifold;
    if (found.is_beyond || found.separation > margin)
        return manifold;

    const Vec3 place = load == nullptr ? Vec3{Real(0)} : *load - origin;
    const auto feature_at = [&](const auto &core, const Vec3 &direction) {
        return load == nullptr ? feature_of(core, direction)
                               : feature_under(core, direction, place);
    };
    const Feature on_a = feature_at(a, found.normal);
    const Feature on_b = feature_at(b, -found.normal);
    const auto accept = [&](const CandidatePoints &contacts, const Vec3 &normal) {
        manifold.normal = normal;
        add_best(manifold, contacts, origin, load == nullptr ? nullptr : &place);
        return manifold;
    };

    // How far the other shape is above the plane of each face. If that is as good as the best
    // separation, use the face's normal.
    constexpr Real none = -std::numeric_limits<Real>::infinity();
    const Real above_a =
        on_a.is_face() ? glm::dot(b.support(-on_a.normal) - on_a.corners[0], on_a.normal) - b.radius
                       : none;
    const Real above_b =
        on_b.is_face() ? glm::dot(a.support(-on_b.normal) - on_b.corners[0], on_b.normal) - a.radius
                       : none;
    const auto with_face = [&](const Feature &reference, const auto &incident_core, bool is_b) {
        const Feature incident = feature_at(incident_core, -reference.normal);
        const std::uint32_t feature = pair_name(reference, incident, is_b);
        CandidatePoints contacts =
            over_face(reference, incident, incident_core.radius, margin, feature);
        // The deepest point of a rim may be between the corners.
        if (contacts.deepest() > found.separation + Real(0.1) * feature_tolerance) {
            const Vec3 support = incident_core.support(-reference.normal);
            const Real height = glm::dot(support - reference.corners[0], reference.normal);
            if (is_over(reference, support) && height - incident_core.radius <= margin)
                contacts.add(support -
                                 reference.normal * (Real(0.5) * (height + incident_core.radius)),
                             height - incident_core.radius, feature | name_support);
        }
        return contacts;
    };
    // Reject a face that the closest or deepest point is not over, however good its plane.
    const auto is_there = [&](const CandidatePoints &contacts) {
        return contacts.deepest() <= found.separation + Real(2) * feature_tolerance;
    };
    const bool use_a = above_a >= found.separation - feature_tolerance;
    const bool use_b = above_b >= found.separation - feature_tolerance;
    const bool b_first = use_b && (!use_a || above_b > above_a + feature_tolerance);
    for (const bool is_b : {b_first, !b_first}) {
        if (!(is_b ? use_b : use_a))
            continue;
        const CandidatePoints contacts =
            is_b ? with_face(on_b, a, true) : with_face(on_a, b, false);
        if (is_there(contacts))
            return accept(contacts, is_b ? -on_b.normal : on_a.normal);
    }

    const std::uint32_t feature = pair_name(on_a, on_b, false);
    if (on_a.count == 2 && on_b.count == 2) {
        const CandidatePoints sides =
            along_sides(on_a, a.radius, on_b, b.radius, found.normal,
                        std::min(roundness(a), roundness(b)), margin, feature);
        if (sides.count == 2 && sides.deepest() <= found.separation + feature_tolerance)
            return accept(sides, found.normal);
    }
    CandidatePoints one;
    one.add(Real(0.5) * (found.on_a + found.on_b), found.separation, feature | name_closest);
    if (found.separation <= feature_tolerance) {
        add_other_end(one, on_b, on_a, a.radius, found.on_b, -found.normal, margin, feature);
        add_other_end(one, on_a, on_b, b.radius, found.on_a, found.normal, margin, feature);
    }
    return accept(one, found.normal);
}

// The half-space's plane acts as a face without sides. `load`: as above.
template <typename A>
Manifold collide_half_space(const A &shape, const HalfSpace &half_space, Real margin,
                            const Vec3 *load = nullptr) {
    const Vec3 origin = place_of(shape);
    const auto core = core_of(shape, origin);
    const Real offset = half_space.offset - glm::dot(half_space.normal, origin);
    const auto height = [&](const Vec3 &p) { return glm::dot(half_space.normal, p) - offset; };
    CandidatePoints contacts;
    const auto add = [&](const Vec3 &p, std::uint32_t feature) {
        const Real separation = height(p);
        if (separation <= margin)
            contacts.add(p - half_space.normal * (Real(0.5) * separation), separation, feature);
    };
    const Vec3 place = load == nullptr ? Vec3{Real(0)} : *load - origin;
    const Feature lowest = load == nullptr ? feature_of(core, -half_space.normal)
                                           : feature_under(core, -half_space.normal, place);
    for (int i = 0; i < lowest.count; ++i)
        add(lowest.corners[index(i)],
            pair_name(lowest, Feature{}, false) | static_cast<std::uint32_t>(i));
    const Vec3 support = core.support(-half_space.normal);
    if (contacts.deepest() > height(support) + Real(0.1) * feature_tolerance)
        add(support, pair_name(lowest, Feature{}, false) | name_support);
    Manifold manifold;
    if (contacts.count == 0)
        return manifold;
    manifold.normal = -half_space.normal;
    add_best(manifold, contacts, origin, load == nullptr ? nullptr : &place);
    return manifold;
}

} // namespace

std::optional<OtherEnd> other_end(std::span<const Vec3> face, const Vec3 &face_normal,
                                  const Vec3 &start, const Vec3 &end, const Vec3 &closest,
                                  const Vec3 &out) {
    const Real cosine = glm::dot(face_normal, out);
    if (cosine < leaning_cosine)
        return std::nullopt;
    const auto height_of = [&](const Vec3 &point) {
        return glm::dot(point - face[0], face_normal) / cosine;
    };
    // The side's shadow on the face, along the contact normal, clipped to it.
    const Vec3 first = start - height_of(start) * out;
    const Vec3 way = (end - height_of(end) * out) - first;
    Real low = Real(0);
    Real high = Real(1);
    for (std::size_t i = 0; i < face.size(); ++i) {
        const Vec3 outward = glm::cross(face[(i + 1) % face.size()] - face[i], face_normal);
        const Real left = glm::dot(face[i] - first, outward); // up to the border
        const Real slope = glm::dot(way, outward);
        if (slope > Real(0))
            high = std::min(high, left / slope);
        else if (slope < Real(0))
            low = std::max(low, left / slope);
        else if (left < Real(0))
            return std::nullopt;
    }
    if (!(high > low))
        return std::nullopt;
    const auto distance_at = [&](Real s) { return glm::distance(first + s * way, closest); };
    const bool is_last = distance_at(high) > distance_at(low);
    const Real s = is_last ? high : low;
    if (!(distance_at(s) > Real(100) * feature_tolerance))
        return std::nullopt;
    return OtherEnd{first + s * way, height_of(start + s * (end - start)), is_last};
}

namespace unchecked {

Manifold collide(const Sphere &a, const Cylinder &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Sphere &a, const ConvexHull &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Sphere &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Box &a, const Cylinder &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Box &a, const ConvexHull &b, Real margin, const Vec3 &guess) {
    return collide_convex(a, b, margin, guess);
}
Manifold collide(const Box &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Capsule &a, const Cylinder &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Capsule &a, const ConvexHull &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Capsule &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Cylinder &a, const Cylinder &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Cylinder &a, const ConvexHull &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Cylinder &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const ConvexHull &a, const ConvexHull &b, Real margin, const Vec3 &guess) {
    return collide_convex(a, b, margin, guess);
}
Manifold collide(const ConvexHull &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Triangle &a, const Triangle &b, Real margin) {
    return collide_convex(a, b, margin);
}
Manifold collide(const Cylinder &a, const HalfSpace &b, Real margin) {
    return collide_half_space(a, b, margin);
}
Manifold collide(const ConvexHull &a, const HalfSpace &b, Real margin) {
    return collide_half_space(a, b, margin);
}
Manifold collide(const Triangle &a, const HalfSpace &b, Real margin) {
    return collide_half_space(a, b, margin);
}

template <typename A, typename B>
Manifold collide_under(const A &a, const B &b, Real margin, const Vec3 &guess, const Vec3 &load) {
    if constexpr (std::same_as<B, HalfSpace>)
        return collide_half_space(a, b, margin, &load);
    else
        return collide_convex(a, b, margin, guess, &load);
}
template Manifold collide_under(const Box &, const Cylinder &, Real, const Vec3 &, const Vec3 &);
template Manifold collide_under(const Box &, const ConvexHull &, Real, const Vec3 &, const Vec3 &);
template Manifold collide_under(const Cylinder &, const Cylinder &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const Cylinder &, const ConvexHull &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const Cylinder &, const Triangle &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const Cylinder &, const HalfSpace &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const ConvexHull &, const ConvexHull &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const ConvexHull &, const Triangle &, Real, const Vec3 &,
                                const Vec3 &);
template Manifold collide_under(const ConvexHull &, const HalfSpace &, Real, const Vec3 &,
                                const Vec3 &);

} // namespace unchecked

} // namespace plumb::inline PLUMB_PRECISION
