// Converts a scene's shapes to the world's.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"
#include "engine/scene/shape_desc.h"
#include "engine/space/triangle_surface.h"

#include <memory>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct SolidShape {
    std::optional<Shape> shape;           // in its own frame
    std::shared_ptr<const HullMesh> hull; // keeps the mesh of a ConvexHull
};

// Has no shape for surfaces and for points without a solid hull.
SolidShape solid_shape(const ShapeDesc &desc);

// Whether a mesh can be solid: it has no border, and its fronts face out.
bool encloses_space(const MeshData &data);

// Null for solids.
std::shared_ptr<const TriangleSurface> triangle_surface(const ShapeDesc &desc);

} // namespace plumb::inline PLUMB_PRECISION
