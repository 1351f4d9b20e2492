// How deep the bodies of a scene are in each other where it begins.
#pragma once

#include "engine/scene/real/solid_shape.h"
#include "engine/scene/scene_desc.h"

#include <map>
#include <optional>

namespace plumb {

class StartOverlaps {
  public:
    // The depth of the deepest contact of any two shapes that collide with each other (m; 0
    // when they are apart, but by less than `margin`); empty if all are farther.
    // In single precision, about the bodies' own place. Meshes and height fields are not looked at.
    // Both must outlive this.
    std::optional<double> deepest(const BodyDesc &a, const BodyDesc &b, double margin);

  private:
    std::optional<f32::Shape> placed(const ColliderDesc &collider, const glm::dvec3 &position,
                                     const glm::dquat &orientation);

    std::map<const ColliderDesc *, f32::SolidShape> made_; // so far
};

} // namespace plumb
