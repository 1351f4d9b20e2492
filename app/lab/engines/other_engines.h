// The other engines that this build can chart.
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
    // The engine described as a method: its command-line name, its title and its default
    // iterations.
    MethodInfo info;
    Precision precision = Precision::f32;
    std::function<std::unique_ptr<Engine>(const EngineScene &)> create;
};

// The engines built in: none unless PLUMB_BENCH is on.
[[nodiscard]] std::span<const OtherEngine> other_engines();

// Each once. For an unknown name throws std::invalid_argument that lists the engines, or says how
// to get any.
[[nodiscard]] std::vector<const OtherEngine *>
find_other_engines(const std::vector<std::string> &names);

// Finds one of our methods or the other engines by name; null if there is none.
[[nodiscard]] const MethodInfo *find_charted(std::string_view name);

// Why an engine cannot run a scene ("bullet cannot run this scene: the adapter does not support
// meshes"); empty if it can.
[[nodiscard]] std::string why_not(const OtherEngine &engine, const SceneDesc &scene);

// The settings it runs the scene with: those given, else the scene's dt and gravity, one substep
// and the engine's default iterations.
[[nodiscard]] ResolvedRun resolve_run(const OtherEngine &engine, const SceneDesc &scene,
                                      const GivenSettings &given);

} // namespace plumb
