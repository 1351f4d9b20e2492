// Fits the shadow map to the scene and the camera.
#pragma once

#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

#include "app/render/draw_list.h"

namespace plumb {

struct ShadowFit {
    // Maps positions relative to `origin` to the map's texture coordinates and depth, in [0, 1].
    glm::mat4 texture_from_relative{1};
    float texel = 0; // metres
};

// The square of the light's view that contains every shape that can cast or show a shadow near what
// the camera sees. It moves in whole texels and grows in steps, so that shadow edges do not crawl.
// None if no shape is near the view.
[[nodiscard]] std::optional<ShadowFit> fit_shadow(std::span<const DrawShape> shapes,
                                                  const Camera &camera, float aspect,
                                                  const glm::vec3 &light_direction,
                                                  const glm::vec3 &origin, int map_size);

// Half a shape's extent along a unit direction, metres.
[[nodiscard]] float half_extent_along(const DrawShape &shape, const glm::vec3 &direction);

} // namespace plumb
