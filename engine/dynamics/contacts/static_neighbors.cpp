// Static neighbours that lie flush with a static body in contact.
#include "engine/dynamics/contacts/inner_edges.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/overlap.h"

#include <algorithm>
#include <span>

#include <glm/common.hpp>

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
            std::vector<StaticPiece> &out) {
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

void World::drop_inner_edges(const Candidate &candidate, std::uint32_t triangle,
                             FoundManifold &found) const {
    const bool a_is_static = model_->bodies[candidate.key.a].kind == BodyKind::static_body;
    const bool b_is_static = model_->bodies[candidate.key.b].kind == BodyKind::static_body;
    if (found.manifold.count == 0 || (!a_is_static && !b_is_static))
        return;
    const std::uint32_t other = a_is_static ? candidate.collider_b : candidate.collider_a;
    const std::uint32_t of_static = a_is_static ? candidate.collider_a : candidate.collider_b;
    const auto first = std::ranges::lower_bound(scratch_.beside_static, std::uint64_t{other} << 32);
    const auto last =
        std::ranges::lower_bound(scratch_.beside_static, std::uint64_t{other + 1} << 32);
    if (last - first < 2)
        return;

    const Collider &own = model_->colliders[of_static];
    const Collider &mover = model_->colliders[other];
    if (own.is_half_space() || mover.surface)
        return;
    const Real flush = Real(1e-3) * std::min(own.half_width, mover.half_width);
    const Aabb box = around_points(found.manifold, (near_reach + Real(8)) * flush);
    std::vector<StaticPiece> neighbors;
    for (const std::uint64_t pair : std::span(first, last)) {
        const auto neighbor = static_cast<std::uint32_t>(pair & 0xFFFFFFFFU);
        const Collider &collider = model_->colliders[neighbor];
        if (neighbor != of_static)
            gather(collider, scratch_.placed[neighbor], state_.motions[collider.body], box,
                   neighbors);
    }
    if (neighbors.empty())
        return;

    const Motion &at = a_is_static ? found.b : found.a;
    const Shape solid = placed(mover.shape, Transform{at.position, at.rotation});
    const StaticPiece piece = own.surface
                                  ? StaticPiece{placed(own.surface->triangle(triangle),
                                                       surface_pose(own, state_.motions[own.body]))}
                                  : StaticPiece{scratch_.placed[of_static]};
    Manifold &manifold = found.manifold;
    if (a_is_static)
        manifold.normal = -manifold.normal;
    manifold = without_inner_edges(manifold, solid, piece, neighbors, candidate.margin, flush);
    if (a_is_static)
        manifold.normal = -manifold.normal;
}

} // namespace plumb::inline PLUMB_PRECISION
