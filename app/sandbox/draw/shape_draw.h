// Shapes of bodies and probes as the renderer has them.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/shape_desc.h"

namespace plumb {

struct ShapeStyle {
    glm::vec3 colour{0.7f};
    bool selected = false; // not shown of hulls, meshes and height fields
    bool highlighted = false;
    bool glass = false;
};

// Adds the shape where it is put. The triangles of hulls, meshes and height fields are made once
// for all shapes that share their points, and kept as long as those live.
void draw_shape(DrawList &list, const ShapeDesc &shape, const glm::dvec3 &position,
                const glm::dquat &orientation, const ShapeStyle &style);

// The radius of a sphere about the shape's own origin that holds it; 0 for a plane.
[[nodiscard]] double reach(const ShapeDesc &shape);

} // namespace plumb
