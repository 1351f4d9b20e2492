// The other engines that this build can chart a scene with.
#pragma once

#include "app/lab/engines/engine.h"
#include "engine/dynamics/method_info.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct OtherEngine {
    // As if it were a method: its name on the command line, its title, and how many iterations it
    // takes by default.
    MethodInfo info;
    Precision precision = Precision::f32;
    std::function<std::unique_ptr<Engine>(const EngineScene &)> create;
};

// Those that were built: none unless PLUMB_BENCH is on.
[[nodiscard]] std::span<const OtherEngine> other_engines();

// Each once. Throws std::invalid_argument that says which there are, or how to get any.
[[nodiscard]] std::vector<const OtherEngine *>
find_other_engines(const std::vector<std::string> &names);

// Of our methods or the other engines; null when there is none of that name.
[[nodiscard]] const MethodInfo *find_charted(std::string_view name);

// Why an engine cannot run a scene ("bullet cannot run this scene: the adapter does not support
// meshes"); empty when it can.
[[nodiscard]] std::string why_not(const OtherEngine &engine, const SceneDesc &scene);

// What it runs the scene with: the scene's own dt and gravity, one substep and the engine's own
// iterations, less what is given.
[[nodiscard]] ResolvedRun resolve_run(const OtherEngine &engine, const SceneDesc &scene,
                                      const GivenSettings &given);

} // namespace plumb
