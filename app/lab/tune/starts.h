// The same scene from several slightly different starts: a result that holds for only one is luck.
#pragma once

#include "app/lab/run/scene_text.h"
#include "engine/scene/scene_desc.h"

#include <vector>

namespace plumb {

// Largest shift of a body or particle along each axis, as a fraction of its largest coordinate or
// its smallest width, whichever is greater: a few float roundings, on which no expectation should
// depend.
inline constexpr double start_shift = 1e-6;

// First the scene as it stands, then `others` copies in which each dynamic body is shifted at
// random along its unlocked axes, as is each unpinned particle, including cloth particles. If the
// file has a [world], the copies also use another seed for everything it draws at random (scatter).
// `text` must be of a scene without errors; a seed that causes errors is not used.
[[nodiscard]] std::vector<SceneDesc> starts_of(const SceneText &text, int others);

} // namespace plumb
