// Triangle ground and walls for collision: a mesh or a height field whose triangles know their
// neighbours.
#pragma once

#include "engine/geometry/height_field.h"
#include "engine/space/mesh_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// front: solids touch the fronts of the triangles, and pass from behind. both: they touch both
// sides of what is a thin sheet. solid: a closed mesh whose fronts face out, or the ground below a
// height field, as deep as the field is long; they touch its outside, and what is inside is pushed
// out.
enum class Sides { front, both, solid };

class TriangleSurface {
  public:
    // An invalid mesh or field fails a check.
    TriangleSurface(TriangleMesh mesh, Sides sides);
    TriangleSurface(HeightField field, Sides sides);

    Sides sides() const { return sides_; }
    const std::variant<MeshTree, HeightField> &source() const { return source_; }
    const Aabb &bounds() const { return bounds_; }
    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(edge_bits_.size()); }
    Triangle triangle(std::uint32_t index) const;
    // Whether the point is inside; false unless the surface is solid.
    bool encloses(const Vec3 &point) const;
    Vec3 closest_point(const Vec3 &point) const;

    // Whether the surface turns away beyond the edge from corner `edge` to the next: a border or a
    // ridge. At other edges, flat or concave, nothing can rest on the edge alone: a shape that
    // touches the edge touches a face at the same time.
    bool is_outer_edge(std::uint32_t triangle, int edge) const {
        return (edge_bits_[triangle] >> edge & 1U) != 0;
    }
    // Whether the surface turns up beyond the edge, if only a little.
    bool is_hollow_edge(std::uint32_t triangle, int edge) const {
        return (edge_bits_[triangle] >> (3 + edge) & 1U) != 0;
    }
    // The unit normal of the triangle beyond an edge; the triangle's own at a border.
    Vec3 normal_beyond(std::uint32_t index, int edge) const;
    // The triangle beyond an edge; none at a border.
    std::optional<std::uint32_t> triangle_beyond(std::uint32_t triangle, int edge) const {
        const std::uint32_t other = neighbors_[triangle][static_cast<std::size_t>(edge)];
        return other == none ? std::nullopt : std::optional(other);
    }

    // Calls visit(index) for every triangle whose bounds touch the box, in ascending order.
    template <typename Visit>
    void each_touching(const Aabb &box, std::vector<std::uint32_t> &scratch, Visit &&visit) const {
        if (const auto *field = std::get_if<HeightField>(&source_)) {
            triangles_touching(*field, box, [&](std::uint32_t index, const Triangle &) {
                visit(index);
                return true;
            });
            return;
        }
        scratch.clear();
        std::get<MeshTree>(source_).tree().query(box, [&](std::uint32_t index) {
            scratch.push_back(index);
            return true;
        });
        std::sort(scratch.begin(), scratch.end());
        for (const std::uint32_t index : scratch)
            visit(index);
    }

    // Covers everything a body can feel; for the hash of a world's state.
    std::uint64_t content_hash() const { return content_hash_; }

  private:
    void link(const std::vector<std::array<std::uint32_t, 3>> &corners);

    std::variant<MeshTree, HeightField> source_;
    Sides sides_;
    Aabb bounds_;
    // Per triangle three bits for outer edges, then three for hollow ones.
    std::vector<std::uint8_t> edge_bits_;
    static constexpr std::uint32_t none = UINT32_MAX;
    std::vector<std::array<std::uint32_t, 3>> neighbors_; // the triangle beyond each edge, or none
    std::uint64_t content_hash_ = 0;
};

std::optional<RayHit> raycast(const TriangleSurface &surface, const Ray &ray);

} // namespace plumb::inline PLUMB_PRECISION
