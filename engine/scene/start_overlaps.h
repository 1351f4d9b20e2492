// How deep the bodies of a scene are in each other where it begins.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/scene/scene_desc.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace plumb {

class StartOverlaps {
  public:
    // The depth of the deepest contact of any two shapes that collide with each other (m; 0
    // when they are apart, but by less than `margin`); empty if all are farther.
    // In single precision, about the bodies' own place. Meshes and height fields are not looked at.
    std::optional<double> deepest(const BodyDesc &a, const BodyDesc &b, double margin);

    // By their points; null where single precision has no solid hull.
    using Hulls = std::map<const std::vector<glm::dvec3> *, std::unique_ptr<const f32::HullMesh>>;

  private:
    Hulls hulls_; // made so far
};

} // namespace plumb
