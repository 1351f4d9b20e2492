// Which shapes of a draw list can be seen, by an octree that is kept from frame to frame.
#pragma once

#include "app/render/draw_list.h"
#include "engine/geometry/frustum.h"
#include "engine/space/orthtree.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace plumb {

// Of the ball around its position that holds the shape.
float bounding_radius(const DrawShape &shape);

// Below this many shapes looking at each is as fast as any tree; above, parts of the world that are
// out of view are left out as a whole.
inline constexpr std::size_t least_shapes_to_cull = 256;

class Culling {
  public:
    // Takes over where the shapes are now. Those that stayed in their cells since the last call
    // cost one comparison. All positions and sizes must be finite.
    void update(std::span<const DrawShape> shapes);

    // One value for each shape: 0 when no point of it is in the frustum, up to roundings; else 1,
    // for all that are in view and some beside. Valid until the next call of either.
    std::span<const std::uint8_t> in_view(const Frustum &frustum);

  private:
    void rebuild(std::span<const DrawShape> shapes);

    std::optional<Octree> tree_;
    std::vector<Aabb> boxes_;
    std::vector<Octree::Item> items_;
    std::vector<std::uint8_t> in_view_;
};

} // namespace plumb
