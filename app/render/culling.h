// Frustum culling of a draw list, with an octree that is kept from frame to frame.
#pragma once

#include "app/render/draw_list.h"
#include "engine/geometry/frustum.h"
#include "engine/space/orthtree.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumb {

// Radius of the bounding sphere around the shape's position.
float bounding_radius(const DrawShape &shape);

// Below this many shapes testing each one is as fast as any tree; above, whole regions out of view
// are skipped.
inline constexpr std::size_t least_shapes_to_cull = 256;

class Culling {
  public:
    // Takes over the shapes' positions. A shape that has not moved since the last call costs one
    // comparison. All positions and sizes must be finite.
    void update(std::span<const DrawShape> shapes);

    // One value per shape: 0 if no point of it is in the frustum, up to rounding; else 1, for all
    // shapes in view and some others. Valid until the next call of either function.
    std::span<const std::uint8_t> in_view(const Frustum &frustum);

  private:
    void rebuild(std::span<const DrawShape> shapes);

    std::optional<Octree> tree_;
    std::vector<Aabb> boxes_;
    std::vector<Octree::Item> items_;
    std::vector<std::uint8_t> in_view_;
};

} // namespace plumb
