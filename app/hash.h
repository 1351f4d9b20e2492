// `plumb hash`: a hash of the state of scenes after so many steps.
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

// A line to `out` for each scene. Ctrl-C ends it after the step at hand.
[[nodiscard]] ExitCode hash_scenes(const HashCommand &command, std::ostream &out,
                                   std::ostream &err);

} // namespace plumb
