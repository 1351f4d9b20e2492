// What a picture of a scene must contain, and its backdrop.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/scene_desc.h"

#include <optional>
#include <span>

namespace plumb {

// The aspect (width over height) of a picture as high as the camera's field of view, with its
// target in the middle, that shows everything in the list that a 16:9 picture would, with some
// margin. At least 1, to leave room for motion. Floors and walls, much larger than the view, do not
// count.
[[nodiscard]] float aspect_needed(const DrawList &list);

// The smallest shift (m, world axes, no turning) of the camera towards one of several places that
// brings it into the picture of this aspect and no farther away than twice the target's distance.
// Zero if one of them is there already, or if there are none.
[[nodiscard]] glm::vec3 shift_to_see(const Camera &camera, float aspect,
                                     std::span<const glm::vec3> places);

// A backdrop for a world without a plane, so that it does not float in a void: a floor near the
// lower border of the scene's own picture and below everything in it, or a wall behind it if its
// bodies fall forever. Nothing collides with it. None for a world with a plane.
[[nodiscard]] std::optional<DrawPlane> plane_behind(const SceneDesc &scene);

} // namespace plumb
