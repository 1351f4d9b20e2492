#include "engine/dynamics/contacts/hollow_contact.h"

#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/contacts/triangle_face.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

struct Face : TriangleFace {
    std::uint32_t index = 0;
};

std::optional<Face> face_of(const TriangleSurface &surface,
                            const std::optional<std::uint32_t> &index) {
    if (!index)
        return std::nullopt;
    const std::optional<TriangleFace> face = face_of(surface.triangle(*index));
    return face ? std::optional(Face{*face, *index}) : std::nullopt;
}

// The edge that a point is farthest beyond, if any.
std::optional<int> edge_passed(const Face &face, const Vec3 &point) {
    std::optional<int> passed;
    Real farthest = Real(1e-4) * face.size; // rounding
    for (int edge = 0; edge < 3; ++edge)
        if (const Real beyond = face.beyond(point, static_cast<std::size_t>(edge));
            beyond > farthest) {
            farthest = beyond;
            passed = edge;
        }
    return passed;
}

// The face that the core point is over, from a face near it; none beyond a ridge or border.
std::optional<Face> face_under(const TriangleSurface &surface, Face face, const Vec3 &core,
                               Real rounding) {
    constexpr int most_crossed = 64;
    std::uint32_t before = face.index;
    for (int crossed = 0; crossed < most_crossed; ++crossed) {
        const std::optional<int> passed = edge_passed(face, core - rounding * face.normal);
        if (!passed)
            return face;
        if (surface.is_outer_edge(face.index, *passed))
            return std::nullopt;
        const auto next = face_of(surface, surface.triangle_beyond(face.index, *passed));
        if (!next)
            return std::nullopt;
        if (crossed > 0 && next->index == before) // over both, but for rounding
            return face;
        before = face.index;
        face = *next;
    }
    return std::nullopt;
}

// The neighbour that the core point is deeper under: a round solid reaches it before its lowest
// point does.
Face deepest_beside(const TriangleSurface &surface, const Face &face, const Vec3 &core) {
    Face deepest = face;
    for (int edge = 0; edge < 3; ++edge) {
        if (!surface.is_hollow_edge(face.index, edge))
            continue;
        const auto other = face_of(surface, surface.triangle_beyond(face.index, edge));
        const Real rounding = Real(1e-7) * face.size;
        if (other && other->height(core) < deepest.height(core) - rounding)
            deepest = *other;
    }
    return deepest;
}

} // namespace

std::optional<HollowPath> path_in_hollow(const TriangleSurface &surface, std::uint32_t index,
                                         const Vec3 &core, Real rounding, const Vec3 &way) {
    constexpr Real least_cosine = Real(0.8); // of what the surface turns: no hollow, but a corner
    constexpr Real straight = Real(1e-5);    // (rad)
    constexpr Real wide = Real(30);          // as good as straight, and far to its middle (m)
    const std::optional<Face> first = face_of(surface, index);
    if (!first)
        return std::nullopt;
    const Vec3 to = core + way;
    const std::optional<Face> under = face_under(surface, *first, to, rounding);
    if (!under)
        return std::nullopt;
    const Face last = deepest_beside(surface, *under, to);
    if (last.index == first->index || glm::dot(last.normal, first->normal) < least_cosine)
        return std::nullopt;
    const Vec3 begin = core - (first->height(core) - rounding) * first->normal;
    const Vec3 end = to - (last.height(to) - rounding) * last.normal;
    const Real length = glm::distance(begin, end);
    if (!(length > Real(1e-4) * rounding) || !(length > Real(0)))
        return std::nullopt;
    const Vec3 along = (end - begin) / length;
    // How far the chord rises from the first face, and the last face from the chord (sines).
    const Real begins = glm::dot(along, first->normal);
    const Real ends = -glm::dot(along, last.normal);
    if (!(begins > straight) || !(ends > -straight))
        return std::nullopt;
    const Vec3 sum = first->normal + last.normal;
    const Vec3 middle = glm::normalize(sum - glm::dot(sum, along) * along);
    const Real sine = std::max(std::min(begins, ends), Real(0));
    if (length > Real(2) * wide * sine)
        return HollowPath{middle, Real(0)};
    const Real cosine = std::sqrt(Real(1) - sine * sine);
    return HollowPath{cosine * middle + sine * along, Real(0.5) * length / sine};
}

bool leaves_to_next_face(const TriangleSurface &surface, std::uint32_t index, const Vec3 &core,
                         Real rounding, Real way) {
    constexpr Real most_bend = Real(0.05); // over others the faces take turns, and things tumble
    constexpr Real soon = Real(16);        // steps, before it is no longer under both
    const std::optional<Face> face = face_of(surface, index);
    if (!face)
        return false;
    const Face deepest = deepest_beside(surface, *face, core);
    if (deepest.index == face->index)
        return false;
    const Real bend = glm::length(glm::cross(face->normal, deepest.normal));
    const Real depth = rounding - face->height(core);
    return bend < most_bend && soon * way * bend > depth;
}

void World::follow_hollow(const Candidate &candidate, std::uint32_t triangle,
                          FoundManifold &found) const {
    Manifold &manifold = found.manifold;
    const bool solid_first = !model_->colliders[candidate.collider_a].surface;
    const std::uint32_t solid_body = solid_first ? candidate.key.a : candidate.key.b;
    const std::uint32_t surface_body = solid_first ? candidate.key.b : candidate.key.a;
    const std::uint32_t solid = solid_first ? candidate.collider_a : candidate.collider_b;
    const Collider &surface =
        model_->colliders[solid_first ? candidate.collider_b : candidate.collider_a];
    // What is solid on both sides has ridges only.
    if (manifold.count == 0 || model_->bodies[solid_body].kind != BodyKind::dynamic ||
        model_->colliders[solid].sensor || surface.sensor ||
        surface.surface->sides() == Sides::both)
        return;
    const auto dt = static_cast<Real>(settings_.dt);
    const Motion &motion = expected_motion(solid_body);
    const Motion &then = solid_first ? found.a : found.b;
    const Vec3 out = solid_first ? -manifold.normal : manifold.normal;
    const Real rounding = rounding_along(model_->colliders[solid], then.rotation, out);
    const auto points = static_cast<std::size_t>(manifold.count);
    std::array<Vec3, 4> cores{}; // from the solid's middle
    Vec3 middle{Real(0)};
    for (std::size_t k = 0; k < points; ++k) {
        const ManifoldPoint &point = manifold.points[k];
        const Vec3 core = point.position + (rounding + Real(0.5) * point.separation) * out;
        cores[k] = motion.rotation * (glm::conjugate(then.rotation) * (core - then.position));
        middle += cores[k] / static_cast<Real>(points);
    }
    const Motion &beneath = expected_motion(surface_body);
    const Vec3 pull = scratch_.reach[solid].pull;
    const Vec3 velocity =
        motion.velocity - beneath.velocity_at(motion.position + middle - beneath.position);
    const Vec3 way = dt * velocity + Real(0.5) * dt * dt * (pull - glm::dot(pull, out) * out) +
                     (turned(identity_rotation, motion.angular_velocity, dt) * middle - middle);
    // It hits rather than slides, or a face slides on a face, and its ends go different ways.
    if (!(glm::dot(way, out) > Real(-0.5) * glm::length(way)))
        return;
    for (std::size_t k = 0; k < points; ++k)
        if (std::abs(glm::dot(cores[k] - middle, way)) > Real(0.5) * glm::dot(way, way))
            return;
    const Transform pose = surface_pose(surface, state_.motions[surface_body]);
    const Vec3 local_out = to_local_vector(pose, out);
    const Triangle face = surface.surface->triangle(triangle);
    const Vec3 cross = glm::cross(face.b - face.a, face.c - face.a);
    if (glm::dot(local_out, cross) < (Real(1) - Real(1e-5)) * glm::length(cross))
        return; // on a ridge
    const auto height = [&](const Vec3 &core) {
        return glm::dot(local_out, to_local_point(pose, motion.position + core) - face.a) -
               rounding;
    };
    if (height(middle) > dt * dt * glm::length(pull))
        return;
    const Vec3 core = to_local_point(pose, motion.position + middle);
    if (rounding > Real(0) &&
        leaves_to_next_face(*surface.surface, triangle, core, rounding, glm::length(way))) {
        manifold.count = 0;
        return;
    }
    const std::optional<HollowPath> path =
        path_in_hollow(*surface.surface, triangle, core, rounding, to_local_vector(pose, way));
    if (!path)
        return;
    const Vec3 normal = to_world_vector(pose, path->normal);
    const Real lean = glm::dot(normal, out);
    for (std::size_t k = 0; k < points; ++k) {
        ManifoldPoint &point = manifold.points[k];
        point.separation = lean * height(cores[k]);
        point.position =
            motion.position + cores[k] - (rounding + Real(0.5) * point.separation) * normal;
    }
    manifold.normal = solid_first ? -normal : normal;
    found.a = state_.motions[candidate.key.a];
    found.b = state_.motions[candidate.key.b];
    found.found_at = FoundAt::start;
    found.hollow = path->radius;
}

} // namespace plumb::inline PLUMB_PRECISION
