// The same scene begun several times, a hair apart: what holds for one start only is luck.
#pragma once

#include "app/lab/run/scene_text.h"
#include "engine/scene/scene_desc.h"

#include <vector>

namespace plumb {

// How far a body or particle is shifted at most along each axis, as a share of the largest of its
// coordinates and its least width: some roundings of a float, which nothing that is expected of a
// scene should hang on.
inline constexpr double start_shift = 1e-6;

// The scene as it stands first, then `others` with each dynamic body shifted at random along the
// axes that it is free to move along, and each particle, those of cloth among them, that is not
// pinned. In these all that the file draws at random (scatter) is drawn
// from another seed too, where it has a [world]. `text` must be of a scene without errors; an
// other seed under which it has some is passed over.
[[nodiscard]] std::vector<SceneDesc> starts_of(const SceneText &text, int others);

} // namespace plumb
