// `plumb list`: scenes, methods, keys and settings.
#pragma once

#include "app/sandbox/session/scene_catalog.h"

#include <ostream>
#include <vector>

namespace plumb {

enum class Listed { scenes, methods, keys, settings };

// As text for people, or as one JSON array.
void list(Listed what, bool json, const std::vector<SceneEntry> &catalogue, std::ostream &out);

} // namespace plumb
