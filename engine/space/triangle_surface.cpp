#include "engine/space/triangle_surface.h"

#include "engine/core/hash.h"
#include "engine/geometry/triangle.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Faces whose normals differ by less than this (rad) count as coplanar: a ridge that flat lifts a
// one-metre body by less than the contact feature margin.
constexpr Real flat_angle = Real(1e-3);
// The same for hollows, which lift nothing: what rounding may leave between flat faces.
constexpr Real level_angle = Real(1e-5);

Vec3 normal_or_zero(const Triangle &t) {
    const Vec3 normal = glm::cross(t.b - t.a, t.c - t.a);
    const Real length = glm::length(normal);
    return length > Real(0) ? normal / length : Vec3{Real(0)};
}

const Vec3 &corner(const Triangle &t, int index) {
    return index == 0 ? t.a : index == 1 ? t.b : t.c;
}

struct EdgeUse {
    std::uint32_t from = 0, to = 0; // lesser, greater vertex
    std::uint32_t triangle = 0;
    std::uint32_t edge = 0;
};

void add_vector(StateHash &hash, const Vec3 &v) {
    hash.add(v.x);
    hash.add(v.y);
    hash.add(v.z);
}

} // namespace

TriangleSurface::TriangleSurface(TriangleMesh mesh, Sides sides)
    : source_(MeshTree(std::move(mesh))), sides_(sides) {
    const TriangleMesh &kept = std::get<MeshTree>(source_).mesh();
    bounds_ = plumb::bounds(kept);
    // Triangles that repeat a corner's coordinates are neighbours, too.
    const std::vector<std::uint32_t> place = same_places(kept.vertices);
    std::vector<std::array<std::uint32_t, 3>> corners;
    corners.reserve(kept.triangles.size());
    for (const std::array<std::uint32_t, 3> &t : kept.triangles)
        corners.push_back({place[t[0]], place[t[1]], place[t[2]]});
    link(corners);
}

TriangleSurface::TriangleSurface(HeightField field, Sides sides)
    : source_(std::move(field)), sides_(sides) {
    const auto &kept = std::get<HeightField>(source_);
    check_valid(kept);
    bounds_ = plumb::bounds(kept);
    if (sides_ == Sides::solid)
        bounds_.min.y -= std::max(bounds_.max.x - bounds_.min.x, bounds_.max.z - bounds_.min.z);
    std::vector<std::array<std::uint32_t, 3>> corners;
    const auto sample = [&](const Vec3 &p) {
        const auto column =
            static_cast<std::uint32_t>(std::lround((p.x - kept.origin.x) / kept.spacing));
        const auto row =
            static_cast<std::uint32_t>(std::lround((p.z - kept.origin.z) / kept.spacing));
        return row * static_cast<std::uint32_t>(kept.columns) + column;
    };
    const std::uint32_t count = plumb::triangle_count(kept);
    corners.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Triangle t = plumb::triangle(kept, i);
        corners.push_back({sample(t.a), sample(t.b), sample(t.c)});
    }
    link(corners);
}

Triangle TriangleSurface::triangle(std::uint32_t index) const {
    if (const auto *field = std::get_if<HeightField>(&source_))
        return plumb::triangle(*field, index);
    return plumb::triangle(std::get<MeshTree>(source_).mesh(), index);
}

bool TriangleSurface::encloses(const Vec3 &point) const {
    if (sides_ != Sides::solid)
        return false;
    if (const auto *field = std::get_if<HeightField>(&source_)) {
        const std::optional<Real> height = height_at(*field, point.x, point.z);
        return height && point.y < *height && point.y > bounds_.min.y;
    }
    return contains(std::get<MeshTree>(source_), point);
}

Vec3 TriangleSurface::closest_point(const Vec3 &point) const {
    return std::visit([&](const auto &source) { return plumb::closest_point(source, point); },
                      source_);
}

Vec3 TriangleSurface::normal_beyond(std::uint32_t index, int edge) const {
    const std::uint32_t other = neighbors_[index][static_cast<std::size_t>(edge)];
    return normal_or_zero(triangle(other == none ? index : other));
}

// An edge that two triangles use in opposite directions joins them; one used by more than two, or
// by two in the same direction, is a border of each.
void TriangleSurface::link(const std::vector<std::array<std::uint32_t, 3>> &corners) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * corners.size());
    StateHash hash;
    hash.add(static_cast<std::uint64_t>(sides_));
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        const Triangle t = triangle(i);
        for (const Vec3 &point : {t.a, t.b, t.c})
            add_vector(hash, point);
        for (std::uint32_t edge = 0; edge < 3; ++edge) {
            const std::uint32_t from = corners[i][edge], to = corners[i][(edge + 1) % 3];
            uses.push_back({std::min(from, to), std::max(from, to), i, edge});
        }
    }
    content_hash_ = hash.value();
    std::ranges::sort(uses, {}, [](const EdgeUse &use) {
        return std::tuple(use.from, use.to, use.triangle, use.edge);
    });
    edge_bits_.assign(corners.size(), 7);
    neighbors_.assign(corners.size(), {none, none, none});
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i + 1;
        while (end < uses.size() && uses[end].from == uses[i].from && uses[end].to == uses[i].to)
            ++end;
        if (end - i == 2) {
            const EdgeUse &p = uses[i];
            const EdgeUse &q = uses[i + 1];
            if (corners[p.triangle][p.edge] != corners[q.triangle][q.edge]) {
                neighbors_[p.triangle][p.edge] = q.triangle;
                neighbors_[q.triangle][q.edge] = p.triangle;
                const Triangle t = triangle(p.triangle), u = triangle(q.triangle);
                const Vec3 n = normal_or_zero(t), m = normal_or_zero(u);
                // At a ridge, the neighbour's far corner is below the face's plane.
                const Vec3 &far = corner(u, static_cast<int>((q.edge + 2) % 3));
                const bool is_below = glm::dot(n, far - corner(t, static_cast<int>(p.edge))) < 0;
                const Real bend = glm::length(glm::cross(n, m));
                const bool is_bent = bend > flat_angle || glm::dot(n, m) < Real(0);
                if (!is_below && (is_bent || bend > level_angle)) {
                    edge_bits_[p.triangle] |= static_cast<std::uint8_t>(8U << p.edge);
                    edge_bits_[q.triangle] |= static_cast<std::uint8_t>(8U << q.edge);
                }
                const bool is_ridge = is_below && is_bent;
                // A surface that is solid on both sides has ridges on both.
                if (!(is_ridge || (sides_ == Sides::both && is_bent))) {
                    edge_bits_[p.triangle] &= static_cast<std::uint8_t>(~(1U << p.edge));
                    edge_bits_[q.triangle] &= static_cast<std::uint8_t>(~(1U << q.edge));
                }
            }
        }
        i = end;
    }
}

std::optional<RayHit> raycast(const TriangleSurface &surface, const Ray &ray) {
    if (const auto *field = std::get_if<HeightField>(&surface.source()))
        return raycast(*field, ray);
    const std::optional<MeshHit> hit = raycast(std::get<MeshTree>(surface.source()), ray);
    if (!hit)
        return std::nullopt;
    return RayHit{hit->t, hit->point, hit->normal, false};
}

} // namespace plumb::inline PLUMB_PRECISION
