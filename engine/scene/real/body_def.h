// A body of a scene as the world wants it.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/scene/scene_desc.h"

namespace plumb::inline PLUMB_PRECISION {

// The material of that name; the default one when the scene has none.
const MaterialDesc &material_of(const SceneDesc &scene, const std::string &name);

// Throws std::invalid_argument for points that have no solid hull.
BodyDef body_def(const SceneDesc &scene, const BodyDesc &desc);

} // namespace plumb::inline PLUMB_PRECISION
