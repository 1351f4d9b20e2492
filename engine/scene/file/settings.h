// A scene file that runs with another method or other settings: what tuning writes.
#pragma once

#include "engine/scene/simulation.h"

#include <string>
#include <string_view>

namespace plumb {

// The text of a scene file, changed so that the scene runs with that method, precision and settings
// (gravity aside, which stays) where nothing else is said; all the rest stays byte for byte.
// Values that are there are replaced and others added to [world]. With another method than before,
// what [world] says for the old one moves to a [methods.OLD], and the keys of [methods.NEW] go.
//
// `text` must parse without errors; `path` is as in parse_scene. Throws std::invalid_argument when
// the text is laid out so that it cannot be done, as in world = { dt = 0.1 }.
std::string with_run(std::string_view text, const std::string &path, const ResolvedRun &run);

} // namespace plumb
