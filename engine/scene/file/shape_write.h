// Shapes as the text of a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/scene_desc.h"

#include <string>
#include <vector>

namespace plumb::scene_file {

// "key = value" for `shape` and each of its fields.
std::vector<std::string> shape_fields(const ShapeDesc &shape);

// The inline tables for one of a body's shapes, and for a probe's shape.
std::string collider_text(const ColliderDesc &collider);
std::string probe_shape_text(const ProbeShapeDesc &shape);

// "key = value" for each non-default field.
std::vector<std::string> filter_fields(const ColliderDesc &collider);

// A point; two numbers if it lies in the xy plane.
std::string place_text(const glm::dvec3 &v, bool is_flat);
std::string places_text(const std::vector<glm::dvec3> &points, bool is_flat);

} // namespace plumb::scene_file
