// `plumb replay` without a window: runs a recording again and compares each state with it.
#pragma once

#include "app/lab/exit_code.h"
#include "engine/core/task_pool.h"

#include <filesystem>
#include <iosfwd>

namespace plumb {

struct ReplayCommand {
    std::filesystem::path recording;
    TaskPool *tasks = nullptr;
};

// If every state matches, writes the line `plumb hash` would print to `out`. Otherwise reports the
// first step that differs to `err` and returns outside_tolerance. Ctrl-C stops it after the current
// step.
[[nodiscard]] ExitCode replay(const ReplayCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
