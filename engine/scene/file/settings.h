// Rewrites a scene file to run with another method or other settings, as tuning does.
#pragma once

#include "engine/scene/simulation.h"

#include <string>
#include <string_view>

namespace plumb {

// The scene file's text, changed so that the scene by default runs with that method, precision and
// settings (except gravity, which stays); everything else stays byte for byte. Existing values are
// replaced and others added to [world]. If the method changes, the old method's settings in [world]
// move to [methods.OLD], and the keys of [methods.NEW] are removed.
//
// `text` must parse without errors; `path` is as in parse_scene. Throws std::invalid_argument when
// the text's layout does not allow it, as in world = { dt = 0.1 }.
std::string with_run(std::string_view text, const std::string &path, const ResolvedRun &run);

} // namespace plumb
