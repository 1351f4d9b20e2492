#include "engine/space/mesh_tree.h"

#include "engine/core/check.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

std::vector<Aabb> boxes_of(const TriangleMesh &mesh) {
    check_valid(mesh);
    std::vector<Aabb> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Triangle t = triangle(mesh, i);
        boxes[i] = {glm::min(glm::min(t.a, t.b), t.c), glm::max(glm::max(t.a, t.b), t.c)};
    }
    return boxes;
}

bool is_within_reach(const Vec3 &point) {
    return std::abs(point.x) <= mesh_reach && std::abs(point.y) <= mesh_reach &&
           std::abs(point.z) <= mesh_reach;
}

void check_point_of_mesh(const Vec3 &point) {
    PLUMB_CHECK(is_within_reach(point), "a mesh's query point must be finite and within "
                                            << mesh_reach << " m, got " << Printed{point});
}

// For double, where the scaled direction must not overflow or vanish; in float it cannot.
constexpr Real least_length =
    sizeof(Real) == sizeof(double) ? Real(1e-300) : std::numeric_limits<Real>::denorm_min();
constexpr Real most_length =
    sizeof(Real) == sizeof(double) ? Real(1e300) : std::numeric_limits<Real>::max();

void check_ray_of_mesh(const Ray &ray) {
    const Vec3 &o = ray.origin;
    const Vec3 &d = ray.direction;
    const Real length = std::max(std::max(std::abs(d.x), std::abs(d.y)), std::abs(d.z));
    const Real distance = std::max(std::max(std::abs(o.x), std::abs(o.y)), std::abs(o.z));
    // max may drop a NaN, a sum does not. A sum that overflows is checked in detail below.
    const Real sum = o.x + o.y + o.z + d.x + d.y + d.z;
    if (sum * Real(0) == Real(0) && distance <= mesh_reach && length >= least_length &&
        length <= most_length && !std::isnan(ray.max_t)) [[likely]]
        return;
    const auto is_short_enough = [](Real x) { return std::abs(x) <= most_length; };
    const bool has_direction = is_short_enough(d.x) && is_short_enough(d.y) &&
                               is_short_enough(d.z) && length >= least_length;
    PLUMB_CHECK(is_within_reach(ray.origin), "ray origin must be finite and within "
                                                 << mesh_reach << " m, got "
                                                 << Printed{ray.origin});
    PLUMB_CHECK(has_direction, "ray direction must have a length from " << least_length << " to "
                                                                        << most_length << ", got "
                                                                        << Printed{ray.direction});
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

Aabb grown(const Aabb &box, Real by) {
    return {box.min - by, box.max + by};
}

Real largest_part(const Vec3 &v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Whether a triangle overlaps a shape that lies in `box`, rounding included.
template <typename Shape>
bool overlaps_within(const MeshTree &mesh, const Aabb &box, const Shape &shape) {
    bool is_found = false;
    mesh.tree().query(box, [&](std::uint32_t item) {
        is_found = overlaps(triangle(mesh.mesh(), item), shape);
        return !is_found;
    });
    return is_found;
}

} // namespace

MeshTree::MeshTree(TriangleMesh mesh) : mesh_(std::move(mesh)), tree_(boxes_of(mesh_)) {
    pack();
}

void MeshTree::move_vertices(std::span<const Vec3> vertices) {
    PLUMB_CHECK(vertices.size() == mesh_.vertices.size(), "a mesh's vertex count must stay "
                                                              << mesh_.vertices.size() << ", got "
                                                              << vertices.size());
    TriangleMesh moved{{vertices.begin(), vertices.end()}, mesh_.triangles};
    tree_.refit(boxes_of(moved));
    mesh_ = std::move(moved);
    pack();
}

void MeshTree::pack() {
    blocks_.resize(tree_.leaf_count());
    for (std::size_t leaf = 0; leaf < blocks_.size(); ++leaf) {
        TriangleBlock &block = blocks_[leaf];
        const std::span<const std::uint32_t> items = tree_.items(leaf);
        for (std::size_t lane = 0; lane < Bvh::leaf_size; ++lane) {
            const bool is_used = lane < items.size();
            const std::uint32_t item = items[is_used ? lane : items.size() - 1];
            const Triangle t = triangle(mesh_, item);
            const Vec3 *const corners[3] = {&t.a, &t.b, &t.c};
            for (int corner = 0; corner < 3; ++corner)
                for (int axis = 0; axis < 3; ++axis)
                    block.corners[corner][axis][lane] = (*corners[corner])[axis];
            const Vec3 size = glm::max(glm::max(t.a, t.b), t.c) - glm::min(glm::min(t.a, t.b), t.c);
            block.sizes[lane] =
                is_used ? largest_part(size) : -std::numeric_limits<Real>::infinity();
            block.triangles[lane] = item;
        }
    }
}

namespace {

// The unit normal of a triangle's front, from the plain cross product if that is accurate enough.
Vec3 front_of(const Triangle &triangle) {
    const glm::dvec3 ab = glm::dvec3(triangle.b) - glm::dvec3(triangle.a);
    const glm::dvec3 ac = glm::dvec3(triangle.c) - glm::dvec3(triangle.a);
    const glm::dvec3 n = glm::cross(ab, ac);
    const double squared = glm::dot(n, n);
    // n is off by less than 8 2^-53 |ab| |ac|.
    constexpr double least = 16.0 * 0x1p-53 / double(epsilon);
    if (squared > least * least * glm::dot(ab, ab) * glm::dot(ac, ac)) [[likely]]
        return Vec3(n / std::sqrt(squared));
    return normal(triangle);
}

// The barycentric weights of a point that is on the triangle up to rounding.
glm::dvec3 weights_at(const Triangle &triangle, const Vec3 &point) {
    if (const std::optional<Vec3> found = barycentric(triangle, point)) {
        const glm::dvec3 weights = glm::max(glm::dvec3(*found), 0.0);
        return weights / (weights.x + weights.y + weights.z);
    }
    // Flat triangle: use the longest edge.
    const glm::dvec3 corners[3] = {glm::dvec3(triangle.a), glm::dvec3(triangle.b),
                                   glm::dvec3(triangle.c)};
    int first = 0;
    double longest = 0.0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
        if (glm::dot(edge, edge) > longest) {
            longest = glm::dot(edge, edge);
            first = i;
        }
    }
    const glm::dvec3 edge = corners[(first + 1) % 3] - corners[first];
    const double along = glm::dot(glm::dvec3(point) - corners[first], edge);
    const double part = longest > 0.0 ? std::clamp(along / longest, 0.0, 1.0) : 0.0;
    glm::dvec3 weights{0.0};
    weights[(first + 1) % 3] = part;
    weights[first] = 1.0 - part;
    return weights;
}

} // namespace

std::optional<MeshHit> raycast(const MeshTree &mesh, const Ray &ray) {
    check_ray_of_mesh(ray);
    const WideRay prepared = wide_ray(ray, mesh.tree().bounds());
    WideHit found;
    if (!first_hit(mesh.tree().nodes(), mesh.blocks().data(), prepared, found))
        return std::nullopt;
    const Triangle hit = found.block->at(found.lane);
    std::optional<MeshHit> result(std::in_place);
    result->t = static_cast<Real>(double(found.time) * prepared.time_scale);
    result->triangle = found.triangle();
    glm::dvec3 weights{found.edges[0], found.edges[1], found.edges[2]};
    const double total = weights.x + weights.y + weights.z;
    if (total != 0.0) [[likely]] {
        weights /= total;
        result->normal = total > 0.0 ? -front_of(hit) : front_of(hit);
    } else {
        weights = weights_at(hit, ray.origin + result->t * ray.direction);
        result->normal = orient3d(hit.a, hit.b, hit.c, ray.origin) < 0 ? -normal(hit) : normal(hit);
    }
    result->point = Vec3(weights.x * glm::dvec3(hit.a) + weights.y * glm::dvec3(hit.b) +
                         weights.z * glm::dvec3(hit.c));
    result->barycentric = Vec3(weights);
    return result;
}

bool is_met(const MeshTree &mesh, const Ray &ray) {
    check_ray_of_mesh(ray);
    return any_hit(mesh.tree().nodes(), mesh.blocks().data(), wide_ray(ray, mesh.tree().bounds()));
}

bool linetest(const MeshTree &mesh, const Vec3 &a, const Vec3 &b) {
    check_point_of_mesh(a);
    check_point_of_mesh(b);
    // Tests boxes against the segment's midpoint and half vector, with slack for rounding, on the
    // three axes across the segment and the three of the box (Ericson 2005, "Real-Time Collision
    // Detection", 5.3.3).
    const Vec3 middle = (a + b) / Real(2);
    const Vec3 half = (b - a) / Real(2);
    const Vec3 size = glm::abs(half);
    const Real reach = largest_part(middle) + largest_part(size);
    const Real slack = Real(8) * epsilon * reach;
    bool is_found = false;
    mesh.tree().query_where(
        [&](const Bvh::Node &node, std::size_t child) {
            Vec3 center;
            Vec3 extent;
            for (int axis = 0; axis < 3; ++axis) {
                const Real low = node.bounds[axis][0][child];
                const Real high = node.bounds[axis][1][child];
                if (low > std::max(a[axis], b[axis]) || high < std::min(a[axis], b[axis]))
                    return false;
                center[axis] = (low + high) / Real(2) - middle[axis];
                extent[axis] = (high - low) / Real(2) + slack + Real(8) * epsilon * std::abs(low);
            }
            for (int axis = 0; axis < 3; ++axis) {
                const int i = (axis + 1) % 3;
                const int j = (axis + 2) % 3;
                const Real apart = std::abs(center[i] * half[j] - center[j] * half[i]);
                const Real together = extent[i] * size[j] + extent[j] * size[i];
                const Real error = Real(4) * epsilon *
                                   (std::abs(center[i]) * size[j] + std::abs(center[j]) * size[i]);
                if (apart > together * (Real(1) + Real(4) * epsilon) + error)
                    return false;
            }
            return true;
        },
        [&](std::uint32_t item) {
            is_found = linetest(triangle(mesh.mesh(), item), a, b);
            return !is_found;
        });
    return is_found;
}

bool overlaps(const MeshTree &mesh, const Sphere &sphere) {
    check_valid(sphere);
    const Real slack = Real(8) * epsilon * (largest_part(sphere.center) + sphere.radius);
    return overlaps_within(mesh, grown(bounds(sphere), slack), sphere);
}

bool overlaps(const MeshTree &mesh, const Aabb &box) {
    bool is_found = false;
    visit_triangles(mesh, box, [&](std::uint32_t) {
        is_found = true;
        return false;
    });
    return is_found;
}

bool overlaps(const MeshTree &mesh, const Box &box) {
    check_valid(box);
    // A rotation may be off unit length by 16 epsilon, and with it the reach, a sum of three parts.
    const Real slack = Real(256) * epsilon * largest_part(box.half_extents) +
                       Real(8) * epsilon * largest_part(box.center);
    return overlaps_within(mesh, grown(bounds(box), slack), box);
}

bool overlaps(const MeshTree &mesh, const Plane &plane) {
    check_valid(plane);
    bool is_found = false;
    mesh.tree().query_where(
        [&plane](const Bvh::Node &node, std::size_t child) {
            if (node.children[child] == Bvh::no_child)
                return false;
            Real lowest = -plane.offset;
            Real highest = -plane.offset;
            Real size = std::abs(plane.offset);
            for (int axis = 0; axis < 3; ++axis) {
                const Real one = plane.normal[axis] * node.bounds[axis][0][child];
                const Real other = plane.normal[axis] * node.bounds[axis][1][child];
                lowest += std::min(one, other);
                highest += std::max(one, other);
                size += std::max(std::abs(one), std::abs(other));
            }
            const Real slack = Real(4) * epsilon * size;
            return lowest <= slack && highest >= -slack;
        },
        [&](std::uint32_t item) {
            is_found = overlaps(triangle(mesh.mesh(), item), plane);
            return !is_found;
        });
    return is_found;
}

bool overlaps(const MeshTree &mesh, const Triangle &triangle) {
    return overlaps_within(mesh, bounds(triangle), triangle);
}

Vec3 closest_point(const MeshTree &mesh, const Vec3 &point) {
    check_point_of_mesh(point);
    PLUMB_CHECK(mesh.tree().size() > 0,
                "a mesh with " << mesh.tree().size() << " triangles has no closest point");
    Vec3 best{Real(0)};
    Real best_squared = std::numeric_limits<Real>::infinity();
    std::uint32_t best_item = std::numeric_limits<std::uint32_t>::max();
    mesh.tree().nearest(point, best_squared, [&](std::uint32_t item) {
        const Vec3 here = closest_point(triangle(mesh.mesh(), item), point);
        const Vec3 away = here - point;
        const Real squared = glm::dot(away, away);
        if (squared < best_squared || (squared == best_squared && item < best_item)) {
            best = here;
            best_squared = squared;
            best_item = item;
        }
        return best_squared;
    });
    return best;
}

namespace {

// Seen from +x: whether the point, nudged infinitesimally towards +z and even less towards +y, is
// inside the outline. So exactly one of the triangles that share an edge or corner contains it.
bool is_over(const Vec2 (&corners)[3], const Vec2 &point) {
    bool is_in = false;
    for (std::size_t i = 0; i < 3; ++i) {
        Vec2 low = corners[i];
        Vec2 high = corners[(i + 1) % 3];
        if (low.x > high.x)
            std::swap(low, high);
        // The half-line from the point towards +z crosses the edge.
        if (low.x <= point.x && point.x < high.x && orient2d(low, high, point) < 0)
            is_in = !is_in;
    }
    return is_in;
}

} // namespace

bool contains(const MeshTree &mesh, const Vec3 &point) {
    PLUMB_CHECK(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z),
                "point must be finite, got " << Printed{point});
    const Vec2 seen{point.y, point.z};
    bool is_inside = false;
    bool is_on = false;
    const Aabb along{point, {std::numeric_limits<Real>::max(), point.y, point.z}};
    mesh.tree().query(along, [&](std::uint32_t item) {
        const Triangle t = triangle(mesh.mesh(), item);
        if (point.x > std::max({t.a.x, t.b.x, t.c.x}))
            return true;
        if (contains(t, point)) {
            is_on = true;
            return false;
        }
        const Vec2 corners[3] = {{t.a.y, t.a.z}, {t.b.y, t.b.z}, {t.c.y, t.c.z}};
        // Going along +x the plane is crossed if the point is behind a front that faces +x, or in
        // front of one that faces -x.
        if (is_over(corners, seen) &&
            orient3d(t.a, t.b, t.c, point) == -orient2d(corners[0], corners[1], corners[2]))
            is_inside = !is_inside;
        return true;
    });
    return is_on || is_inside;
}

} // namespace plumb::inline PLUMB_PRECISION
