// Builds and draws a probe's shapes in one precision.
#pragma once

#include "engine/geometry/height_field.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/shapes.h"
#include "engine/geometry/shapes_2d.h"
#include "engine/scene/probe.h"
#include "engine/space/mesh_tree.h"

#include <memory>
#include <variant>

namespace plumb::inline PLUMB_PRECISION {

using AskedShape =
    std::variant<Sphere, Box, Aabb, Capsule, Cylinder, Plane, Segment, Triangle, ConvexHull,
                 MeshTree, HeightField, Circle, Rectangle, OrientedRectangle, Segment2, Compound2>;

struct MadeShape {
    AskedShape shape;
    std::unique_ptr<HullMesh> hull; // borrowed by the shape; null for other kinds
};

// Points without a solid hull fail a check.
MadeShape make_shape(const ProbeShapeDesc &desc);

// Draws the shape. `number` tells plain ones apart.
void draw_shape(ProbeAnswer &answer, const ProbeShapeDesc &desc, const MadeShape &made,
                ProbeTone tone, std::size_t number);

inline glm::dvec3 wide(const Vec3 &v) {
    return glm::dvec3{v};
}
inline glm::dvec3 wide(const Vec2 &v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), 0};
}
inline Vec2 flattened(const glm::dvec3 &v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y)};
}

// The twelve edges of a box.
void draw_edges(ProbeAnswer &answer, const Aabb &box, ProbeTone tone);

} // namespace plumb::inline PLUMB_PRECISION
