// `plumb hash`: hashes the state of scenes after a given number of steps.
#pragma once

#include "app/lab/exit_code.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <vector>

namespace plumb {

struct HashCommand {
    std::vector<std::filesystem::path> scenes;
    RunOptions run;
    std::uint64_t steps = 0;
    TaskPool *tasks = nullptr;
};

// Writes one line per scene to `out`. Ctrl-C stops it after the current step.
[[nodiscard]] ExitCode hash_scenes(const HashCommand &command, std::ostream &out,
                                   std::ostream &err);

} // namespace plumb
