// Neighbours that lie flush with a static or kinematic body in contact, and move along with it.
#include "engine/dynamics/contacts/inner_edges.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/overlap.h"

#include <algorithm>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Aabb around_points(const Manifold &manifold, Real reach) {
    Aabb box;
    for (int k = 0; k < manifold.count; ++k) {
        const ManifoldPoint &point = manifold.points[static_cast<std::size_t>(k)];
        const Vec3 half = glm::abs(Real(0.5) * point.separation * manifold.normal) + reach;
        box.min = glm::min(box.min, point.position - half);
        box.max = glm::max(box.max, point.position + half);
    }
    return box;
}

// Collects the collider's pieces that the box touches.
void gather(const Collider &collider, const Shape &solid, const Motion &motion, const Aabb &box,
            std::vector<FloorPiece> &out) {
    if (!collider.surface) {
        if (collider.is_half_space() || overlaps(bounds(solid), box))
            out.emplace_back(solid);
        return;
    }
    const Transform pose = surface_pose(collider, motion);
    const Box around{Real(0.5) * (box.min + box.max), identity_rotation,
                     Real(0.5) * (box.max - box.min)};
    std::vector<std::uint32_t> triangles;
    collider.surface->each_touching(
        bounds(placed(around, inverse(pose))), triangles, [&](std::uint32_t index) {
            out.emplace_back(placed(collider.surface->triangle(index), pose));
        });
}

} // namespace

// Whether two bodies that forces do not move go on as one rigid body.
bool World::moves_as_one(std::uint32_t one, std::uint32_t other, Real apart) const {
    if (one == other)
        return true;
    const Motion &a = state_.motions[one];
    const Motion &b = state_.motions[other];
    const auto dt = static_cast<Real>(settings_.dt);
    return model_->bodies[other].kind != BodyKind::dynamic &&
           a.angular_velocity == b.angular_velocity &&
           glm::distance(a.velocity_at(b.position - a.position), b.velocity) * dt <= apart;
}

void World::drop_inner_edges(const Candidate &candidate, std::uint32_t triangle,
                             FoundManifold &found) const {
    const bool a_is_floor = model_->bodies[candidate.key.a].kind != BodyKind::dynamic;
    const bool b_is_floor = model_->bodies[candidate.key.b].kind != BodyKind::dynamic;
    if (found.manifold.count == 0 || (!a_is_floor && !b_is_floor))
        return;
    const std::uint32_t other = a_is_floor ? candidate.collider_b : candidate.collider_a;
    const std::uint32_t of_floor = a_is_floor ? candidate.collider_a : candidate.collider_b;
    const auto first = std::ranges::lower_bound(scratch_.floors, std::uint64_t{other} << 32);
    const auto last = std::ranges::lower_bound(scratch_.floors, std::uint64_t{other + 1} << 32);
    if (last - first < 2)
        return;

    const Collider &own = model_->colliders[of_floor];
    const Collider &mover = model_->colliders[other];
    if (own.is_half_space() || mover.surface)
        return;
    const Real flush = Real(1e-3) * std::min(own.half_width, mover.half_width);
    // Where a collider that moves along with the floor is when the manifold is found.
    const Motion &floor = state_.motions[own.body];
    const Motion &floor_then = a_is_floor ? found.a : found.b;
    const Quat turn = floor_then.rotation * glm::conjugate(floor.rotation);
    const bool is_still = model_->bodies[own.body].kind == BodyKind::static_body;
    const auto then = [&](std::uint32_t body) {
        Motion motion = state_.motions[body];
        if (!is_still) {
            motion.position = floor_then.position + turn * (motion.position - floor.position);
            motion.rotation = turn * motion.rotation;
        }
        return motion;
    };
    const auto shape_then = [&](std::uint32_t collider, const Motion &motion) {
        return is_still ? scratch_.placed[collider]
                        : placed(model_->colliders[collider].shape, mass_pose(motion));
    };
    const Aabb box = around_points(found.manifold, (near_reach + Real(8)) * flush);
    std::vector<FloorPiece> neighbors;
    for (const std::uint64_t pair : std::span(first, last)) {
        const auto neighbor = static_cast<std::uint32_t>(pair & 0xFFFFFFFFU);
        const Collider &collider = model_->colliders[neighbor];
        if (neighbor == of_floor || !moves_as_one(own.body, collider.body, flush))
            continue;
        const Motion motion = then(collider.body);
        gather(collider, shape_then(neighbor, motion), motion, box, neighbors);
    }
    if (neighbors.empty())
        return;

    const Motion &at = a_is_floor ? found.b : found.a;
    const Shape solid = placed(mover.shape, Transform{at.position, at.rotation});
    const Motion own_then = then(own.body);
    const FloorPiece piece =
        own.surface
            ? FloorPiece{placed(own.surface->triangle(triangle), surface_pose(own, own_then))}
            : FloorPiece{shape_then(of_floor, own_then)};
    Manifold &manifold = found.manifold;
    if (a_is_floor)
        manifold.normal = -manifold.normal;
    manifold = without_inner_edges(manifold, solid, piece, neighbors, candidate.margin, flush);
    if (a_is_floor)
        manifold.normal = -manifold.normal;
}

} // namespace plumb::inline PLUMB_PRECISION
