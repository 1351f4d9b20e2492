// A shape of a scene as the world wants it.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"
#include "engine/scene/shape_desc.h"
#include "engine/space/triangle_surface.h"

#include <memory>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct SolidShape {
    std::optional<Shape> shape;           // in a frame of its own
    std::shared_ptr<const HullMesh> hull; // keeps the mesh of a ConvexHull
};

// Without a shape: of surfaces, and of points that have no solid hull.
SolidShape solid_shape(const ShapeDesc &desc);

// Null of what is solid.
std::shared_ptr<const TriangleSurface> triangle_surface(const ShapeDesc &desc);

} // namespace plumb::inline PLUMB_PRECISION
