// Converts a scene's body to a BodyDef for the world.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/scene/scene_desc.h"

namespace plumb::inline PLUMB_PRECISION {

// The material with that name; the default one if the scene does not have it.
const MaterialDesc &material_of(const SceneDesc &scene, const std::string &name);

// Throws std::invalid_argument for points without a solid hull.
BodyDef body_def(const SceneDesc &scene, const BodyDesc &desc);

} // namespace plumb::inline PLUMB_PRECISION
