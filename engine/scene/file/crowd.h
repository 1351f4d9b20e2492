// Detects scenes too crowded to run. Not for users of the engine.
#pragma once

#include "engine/scene/file/warnings.h"

#include <optional>

namespace plumb {

// For a scene without other errors: an error at the body that takes the planes over
// max_scene_planes (scene_limits.h), or the pairs of nearby bodies in the first step over
// max_scene_pairs.
std::optional<SceneMessage> too_crowded(const SceneDesc &scene, const ScenePositions &positions);

} // namespace plumb
