#include "engine/geometry/hull_queries.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/closest.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Index = std::uint32_t;

// From world space to the mesh's frame and back. Without rotation only the position is applied, so
// that small integers stay exact.
class MeshFrame {
  public:
    explicit MeshFrame(const ConvexHull &hull)
        : position_(hull.position), rotation_(hull.rotation),
          is_turned_(hull.rotation.x != Real(0) || hull.rotation.y != Real(0) ||
                     hull.rotation.z != Real(0)) {}

    Vec3 local_vector(const Vec3 &v) const {
        return is_turned_ ? glm::conjugate(rotation_) * v : v;
    }
    Vec3 world_vector(const Vec3 &v) const { return is_turned_ ? rotation_ * v : v; }
    Vec3 local_point(const Vec3 &p) const { return local_vector(p - position_); }
    Vec3 world_point(const Vec3 &p) const { return position_ + world_vector(p); }

  private:
    Vec3 position_;
    Quat rotation_;
    bool is_turned_;
};

Real sum_of_magnitudes(const Vec3 &v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// See hull_queries.h.
Real doubt_at(const HullMesh &mesh, const Vec3 &local) {
    const Vec3 far = glm::max(glm::abs(mesh.box.min), glm::abs(mesh.box.max));
    return mesh.slack + Real(8) * epsilon * (sum_of_magnitudes(local) + sum_of_magnitudes(far));
}

Real height(const Plane &plane, const Vec3 &point) {
    return glm::dot(plane.normal, point) - plane.offset;
}

// Exact: whether the point is in front of the plane through the face's three corners.
bool is_in_front(const HullMesh &mesh, std::size_t face, const Vec3 &point) {
    const auto &[a, b, c] = mesh.face_corners[face];
    return orient3d(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], point) > 0;
}

bool contains_local(const HullMesh &mesh, const Vec3 &p) {
    if (!(p.x >= mesh.box.min.x && p.x <= mesh.box.max.x && p.y >= mesh.box.min.y &&
          p.y <= mesh.box.max.y && p.z >= mesh.box.min.z && p.z <= mesh.box.max.z))
        return false;
    // For points in the box the slack bounds the error of a height. Where the heights leave doubt,
    // the exact sign decides.
    bool is_doubtful = false;
    for (const Plane &plane : mesh.planes) {
        const Real above = height(plane, p);
        if (above > mesh.slack)
            return false;
        is_doubtful |= above >= -mesh.slack;
    }
    if (is_doubtful)
        for (std::size_t face = 0; face < mesh.planes.size(); ++face)
            if (height(mesh.planes[face], p) >= -mesh.slack && is_in_front(mesh, face, p))
                return false;
    return true;
}

// The closest point of a face to p, which is at height `above` over its plane.
struct FacePoint {
    Vec3 point{Real(0)};
    bool is_inner = true; // the projection of p, not a point on an edge
};

FacePoint closest_on_face(const HullMesh &mesh, std::size_t face, const Vec3 &p, Real above) {
    const HullMesh::Face &loop = mesh.faces[face];
    const Vec3 &normal = mesh.planes[face].normal;
    FacePoint best{p - above * normal};
    Real best_squared = infinity;
    Vec3 from = mesh.vertices[mesh.vertex_indices[loop.first + loop.count - 1]];
    for (Index i = loop.first; i < loop.first + loop.count; ++i) {
        const Vec3 to = mesh.vertices[mesh.vertex_indices[i]];
        const Vec3 along = to - from;
        // Beyond an edge. The closest point is on one of the edges that p is beyond.
        if (glm::dot(glm::cross(along, normal), p - from) > Real(0)) {
            const Vec3 candidate = from + closest_parameter(from, along, p) * along;
            const Vec3 d = p - candidate;
            const Real squared = glm::dot(d, d);
            if (squared < best_squared) {
                best_squared = squared;
                best = {candidate, false};
            }
        }
        from = to;
    }
    return best;
}

// For p outside: the closest point of the surface.
Vec3 closest_local(const HullMesh &mesh, const Vec3 &p) {
    std::size_t highest = 0;
    Real greatest = -infinity;
    for (std::size_t face = 0; face < mesh.planes.size(); ++face) {
        const Real above = height(mesh.planes[face], p);
        if (above > greatest) {
            greatest = above;
            highest = face;
        }
    }
    // No point of the solid is closer than the plane that p is highest above.
    const FacePoint first = closest_on_face(mesh, highest, p, greatest);
    if (first.is_inner)
        return first.point;
    // The closest point is on a face that p is in front of.
    const Real doubt = doubt_at(mesh, p);
    Vec3 best = first.point;
    Real best_squared = glm::dot(p - best, p - best);
    for (std::size_t face = 0; face < mesh.planes.size(); ++face) {
        const Real above = height(mesh.planes[face], p);
        if (above < -doubt)
            continue;
        const Vec3 candidate = closest_on_face(mesh, face, p, above).point;
        const Real squared = glm::dot(p - candidate, p - candidate);
        if (squared < best_squared) {
            best_squared = squared;
            best = candidate;
        }
    }
    return best;
}

// Whether a line hits the solid; exact for a mesh with flat faces. It does if it passes all edges
// of a face on the same side. A face that contains the line decides nothing, but a line that hits
// such a face also hits another face that does not contain it. `side_of` is the side on which the
// line passes the edge between two vertices.
template <typename SideOf> bool line_meets(const HullMesh &mesh, const SideOf &side_of) {
    for (const HullMesh::Face &loop : mesh.faces) {
        bool any_left = false;
        bool any_right = false;
        Index from = mesh.vertex_indices[loop.first + loop.count - 1];
        for (Index i = loop.first; i < loop.first + loop.count; ++i) {
            const Index to = mesh.vertex_indices[i];
            const int side = side_of(mesh.vertices[from], mesh.vertices[to]);
            any_left |= side > 0;
            any_right |= side < 0;
            from = to;
        }
        if (any_left != any_right)
            return true;
    }
    return false;
}

// Whether a ray that starts outside hits the solid; exact for a mesh with flat faces.
bool truly_meets(const HullMesh &mesh, const Vec3 &origin, const Vec3 &direction) {
    // In front of a face and not approaching its plane: a miss.
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const auto &[a, b, c] = mesh.face_corners[face];
        if (is_in_front(mesh, face, origin) &&
            triple_sign(direction, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]) >= 0)
            return false;
    }
    // Otherwise every face that the origin is in front of is ahead, so if the line hits the solid,
    // it hits ahead.
    return line_meets(mesh, [&](const Vec3 &from, const Vec3 &to) {
        return triple_sign(direction, origin, from, to);
    });
}

// The same for a segment with both ends outside. Uses the ends, because their difference is
// rounded.
bool segment_truly_meets(const HullMesh &mesh, const Vec3 &a, const Vec3 &b) {
    // If the line hits the solid beyond one end, both ends are in front of some face.
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (is_in_front(mesh, face, a) && is_in_front(mesh, face, b))
            return false;
    return line_meets(mesh,
                      [&](const Vec3 &from, const Vec3 &to) { return orient3d(a, from, to, b); });
}

// The ray against the half-spaces of the faces (Cyrus, Beck 1978, "Generalized two- and
// three-dimensional clipping"), each known only within the doubt: a ray that hits even with all
// planes moved in by the doubt hits, one that misses even with all moved out misses.
struct Clip {
    Real enter = -infinity;
    Real exit = infinity;
    Real late_enter = -infinity; // upper bound of `enter`; early_enter is the lower
    Real early_enter = -infinity;
    std::size_t face = 0; // the ray enters through
    bool is_missed = false;
    bool is_doubtful = false;
};

Clip clip(const HullMesh &mesh, const Vec3 &origin, const Vec3 &direction) {
    const Real doubt = doubt_at(mesh, origin);
    // If a height changes by less than the doubt all the way to the far side of the mesh, use the
    // origin's height.
    const Real way = sum_of_magnitudes(origin) + Real(2) * sum_of_magnitudes(mesh.box.max) +
                     Real(2) * sum_of_magnitudes(mesh.box.min);
    const Real flat_climb = doubt / way * sum_of_magnitudes(direction);
    Clip result;
    Real late_exit = infinity, early_exit = infinity;
    Real greatest = -infinity;
    std::size_t highest_face = 0;
    for (std::size_t face = 0; face < mesh.planes.size(); ++face) {
        const Real above = height(mesh.planes[face], origin);
        const Real climb = glm::dot(mesh.planes[face].normal, direction);
        if (above > greatest) {
            greatest = above;
            highest_face = face;
        }
        if (std::abs(climb) <= flat_climb) {
            if (above > Real(2) * doubt) {
                result.is_missed = true;
                return result;
            }
            result.is_doubtful |= above >= Real(-2) * doubt;
            continue;
        }
        const Real t = above / -climb;
        const Real late = doubt / std::abs(climb);
        if (climb < Real(0)) {
            if (t > result.enter) {
                result.enter = t;
                result.face = face;
            }
            result.late_enter = std::max(result.late_enter, t + late);
            result.early_enter = std::max(result.early_enter, t - late);
        } else {
            result.exit = std::min(result.exit, t);
            late_exit = std::min(late_exit, t + late);
            early_exit = std::min(early_exit, t - late);
        }
    }
    result.is_missed = result.early_enter > late_exit || late_exit < Real(0);
    result.is_doubtful |= !(result.late_enter <= early_exit && early_exit >= Real(0));
    // A ray that touches an edge or corner may seem to leave before it enters. Where all heights
    // are within the doubt, it is on the surface.
    if (result.enter > result.exit)
        result.enter = result.exit = Real(0.5) * (result.early_enter + late_exit);
    if (!(result.enter > Real(0)))
        result.face = highest_face;
    return result;
}

} // namespace

void check_valid(const ConvexHull &hull) {
    PLUMB_CHECK(hull.mesh != nullptr && !hull.mesh->vertices.empty(),
                "a hull needs a mesh with vertices, got "
                    << (hull.mesh == nullptr ? "none" : "an empty one"));
    PLUMB_CHECK(is_finite(hull.position),
                "hull position must be finite, got " << Printed{hull.position});
    PLUMB_CHECK(is_unit(glm::dot(hull.rotation, hull.rotation)),
                "hull rotation must have unit length, got (w, x, y, z) = ("
                    << hull.rotation.w << ", " << hull.rotation.x << ", " << hull.rotation.y << ", "
                    << hull.rotation.z << ')');
}

Index support_vertex(const HullMesh &mesh, const Vec3 &direction, Index start) {
    PLUMB_DEBUG_CHECK(is_finite(direction), "direction must be finite, got " << Printed{direction});
    PLUMB_DEBUG_CHECK(start < mesh.vertices.size(), "start must be one of " << mesh.vertices.size()
                                                                            << " vertices, got "
                                                                            << start);
    Index here = start;
    Real greatest = glm::dot(mesh.vertices[here], direction);
    for (;;) {
        Index best = here;
        for (Index i = mesh.first_neighbor[here]; i < mesh.first_neighbor[here + 1]; ++i) {
            const Real reach = glm::dot(mesh.vertices[mesh.neighbors[i]], direction);
            if (reach > greatest) {
                greatest = reach;
                best = mesh.neighbors[i];
            }
        }
        if (best == here)
            return here;
        here = best;
    }
}

Vec3 support(const ConvexHull &hull, const Vec3 &direction) {
    check_valid(hull);
    PLUMB_CHECK(is_finite(direction), "direction must be finite, got " << Printed{direction});
    const MeshFrame frame(hull);
    return frame.world_point(
        hull.mesh->vertices[support_vertex(*hull.mesh, frame.local_vector(direction))]);
}

bool contains(const ConvexHull &hull, const Vec3 &point) {
    check_valid(hull);
    check_point(point);
    return contains_local(*hull.mesh, MeshFrame(hull).local_point(point));
}

Vec3 closest_point(const ConvexHull &hull, const Vec3 &point) {
    check_valid(hull);
    check_point(point);
    const MeshFrame frame(hull);
    const HullMesh &mesh = *hull.mesh;
    const Vec3 p = frame.local_point(point);
    if (contains_local(mesh, p))
        return point;
    return frame.world_point(closest_local(mesh, p));
}

PlaneTest classify(const Plane &plane, const ConvexHull &hull) {
    check_valid(plane);
    check_valid(hull);
    const MeshFrame frame(hull);
    const Vec3 normal = frame.local_vector(plane.normal);
    const Real offset = plane.offset - glm::dot(plane.normal, hull.position);
    Real least = infinity, greatest = -infinity;
    for (const Vec3 &vertex : hull.mesh->vertices) {
        const Real above = glm::dot(normal, vertex) - offset;
        least = std::min(least, above);
        greatest = std::max(greatest, above);
    }
    if (greatest < Real(0))
        return {PlaneSide::behind, greatest};
    if (least > Real(0))
        return {PlaneSide::in_front, least};
    return {PlaneSide::across, Real(0)};
}

std::optional<RayInterval> ray_interval(const ConvexHull &hull, const Ray &ray) {
    check_valid(hull);
    check_ray(ray);
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    const MeshFrame frame(hull);
    const HullMesh &mesh = *hull.mesh;
    const Vec3 origin = frame.local_point(ray.origin);
    // Scaled by a power of two to a length near 1, which is exact.
    const Real largest =
        std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    const int exponent = std::ilogb(largest);
    const Vec3 direction = frame.local_vector({std::scalbn(ray.direction.x, -exponent),
                                               std::scalbn(ray.direction.y, -exponent),
                                               std::scalbn(ray.direction.z, -exponent)});

    const bool starts_inside = contains_local(mesh, origin);
    const Clip through = clip(mesh, origin, direction);
    RayInterval interval;
    const Real exit = std::scalbn(through.exit, -exponent);
    if (starts_inside) {
        interval.t_exit = through.is_missed ? Real(0) : std::clamp(exit, Real(0), ray.max_t);
        return interval;
    }
    if (through.is_missed ||
        (through.is_doubtful && mesh.has_flat_faces && !truly_meets(mesh, origin, direction)))
        return std::nullopt;
    interval.t_enter = std::max(std::scalbn(through.enter, -exponent), Real(0));
    if (!(interval.t_enter <= ray.max_t) || interval.t_enter == infinity)
        return std::nullopt;
    interval.t_exit = std::min(std::max(exit, interval.t_enter), ray.max_t);
    interval.enter_normal = frame.world_vector(mesh.planes[through.face].normal);
    return interval;
}

bool linetest(const ConvexHull &hull, const Vec3 &a, const Vec3 &b) {
    check_valid(hull);
    check_point(a);
    check_point(b);
    const MeshFrame frame(hull);
    const HullMesh &mesh = *hull.mesh;
    const Vec3 from = frame.local_point(a), to = frame.local_point(b);
    if (contains_local(mesh, from) || contains_local(mesh, to))
        return true;
    if (from == to)
        return false;
    // The rounded difference decides if it leaves no doubt.
    const Clip through = clip(mesh, from, to - from);
    if (through.is_missed || through.early_enter > Real(1))
        return false;
    if (!through.is_doubtful && through.late_enter <= Real(1))
        return true;
    return !mesh.has_flat_faces || segment_truly_meets(mesh, from, to);
}

} // namespace plumb::inline PLUMB_PRECISION
