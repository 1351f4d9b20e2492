// Draws shapes of bodies and probes.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/shape_desc.h"

namespace plumb {

struct ShapeStyle {
    glm::vec3 colour{0.7f};
    bool selected = false; // ignored for hulls, meshes and height fields
    bool highlighted = false;
    bool glass = false;
};

// Adds the shape at a pose. The triangles of hulls, meshes and height fields are built once for all
// shapes that share the same data, and kept as long as that data lives.
void draw_shape(DrawList &list, const ShapeDesc &shape, const glm::dvec3 &position,
                const glm::dquat &orientation, const ShapeStyle &style);

// The radius of a bounding sphere about the shape's own origin; 0 for a plane.
[[nodiscard]] double reach(const ShapeDesc &shape);

} // namespace plumb
