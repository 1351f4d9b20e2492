// Penetration depth of a scene's bodies at the start.
#pragma once

#include "engine/scene/real/solid_shape.h"
#include "engine/scene/scene_desc.h"

#include <map>
#include <optional>

namespace plumb {

class StartOverlaps {
  public:
    // The deepest penetration of any two shapes that collide with each other (m; 0 when separated
    // by less than `margin`); empty if all are farther apart. In single precision, relative to the
    // bodies' own position. Meshes and height fields are skipped. Both bodies must outlive this.
    std::optional<double> deepest(const BodyDesc &a, const BodyDesc &b, double margin);

  private:
    std::optional<f32::Shape> placed(const ColliderDesc &collider, const glm::dvec3 &position,
                                     const glm::dquat &orientation);

    std::map<const ColliderDesc *, f32::SolidShape> made_; // so far
};

} // namespace plumb
