// `plumb replay` without a window: a recorded run again, held to what it was.
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

// A line to `out` as `plumb hash` has it when every state is as recorded; else to `err` the first
// step that differs, and outside_tolerance. Ctrl-C ends it after the step at hand.
[[nodiscard]] ExitCode replay(const ReplayCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
