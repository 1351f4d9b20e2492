// What a picture of a scene has to hold, and what is behind it.
#pragma once

#include "app/render/draw_list.h"
#include "engine/scene/scene_desc.h"

#include <optional>
#include <span>

namespace plumb {

// The aspect (width over height) of a picture that is as high as the camera's field of view, has
// its target in the middle, and shows all of the list that lies in a picture of 16:9, with some
// air. At least 1, for what moves; floors and walls, much larger than the view, do not count.
[[nodiscard]] float aspect_needed(const DrawList &list);

// How far a camera has to move towards one of some places, in metres of the world and without
// turning, to have it in its picture of this aspect, not more than twice as far away as the target:
// the least that serves. Zero if one of them is there already, or if there is none.
[[nodiscard]] glm::vec3 shift_to_see(const Camera &camera, float aspect,
                                     std::span<const glm::vec3> places);

// What a world without a plane is seen against, so that it does not float in nothing: a floor near
// the lower border of the scene's own picture and under all that stands there; a wall behind it
// where bodies fall for ever. Nothing touches it. None for a world with a plane.
[[nodiscard]] std::optional<DrawPlane> plane_behind(const SceneDesc &scene);

} // namespace plumb
