// The engines that scenes are compared on.
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
    // What it cannot run gives null. The scene outlives the engine.
    std::function<std::unique_ptr<Engine>(const EngineScene &)> create;
};

// All at their defaults, with sleeping off.
[[nodiscard]] std::unique_ptr<Engine> plumb_engine(const EngineScene &scene, TaskPool *tasks);

// Those that were built, Plumb with one thread first; with `tasks`, Plumb on those threads second.
[[nodiscard]] std::vector<EngineKind> engines(TaskPool *tasks);

} // namespace plumb
