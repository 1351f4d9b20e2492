// The engines compared on the bench scenes.
#pragma once

#include "app/lab/engines/engine.h"
#include "engine/core/task_pool.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb {

struct EngineKind {
    std::string name;
    int threads = 1;
    // Null if the engine cannot run the scene. The scene outlives the engine.
    std::function<std::unique_ptr<Engine>(const EngineScene &)> create;
};

// Plumb at its defaults, with sleeping off.
[[nodiscard]] std::unique_ptr<Engine> plumb_engine(const EngineScene &scene, TaskPool *tasks);

// The engines in this build: Plumb with one thread first; with `tasks`, Plumb on those threads
// second.
[[nodiscard]] std::vector<EngineKind> engines(TaskPool *tasks);

} // namespace plumb
