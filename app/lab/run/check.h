// `plumb check`: do scenes meet their own tolerances?
#pragma once

#include "app/lab/exit_code.h"
#include "app/lab/run/judged_run.h"

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

class TaskPool;

struct CheckOutcome {
    std::string scene;
    ResolvedRun resolved;
    std::string why_not;   // why the method cannot run the scene; empty when it can
    bool has_world = true; // false if the scene has only probes: nothing is run
    JudgedRun run;
};

// Throws std::invalid_argument as resolve_run does. `tasks` may be null. Probe expectations come
// after the scene's own; a scene without a world is not run.
[[nodiscard]] CheckOutcome check_scene(const SceneDesc &scene, const RunOptions &options,
                                       TaskPool *tasks, const JudgeOptions &judging = {});

[[nodiscard]] ExitCode exit_code(const CheckOutcome &outcome);

// One line per expectation.
void print(std::ostream &out, const CheckOutcome &outcome);

struct CheckCommand {
    std::vector<std::filesystem::path> scenes;
    RunOptions run;
    // Methods to check instead of run.method; those that cannot run a scene are skipped.
    std::vector<std::string> methods;
    TaskPool *tasks = nullptr;
};

// Checks and prints, continuing after a failing scene. At the end counts the runs that were within
// tolerance, outside it, without expectations, or skipped because the method cannot run the scene.
// Stops early on Ctrl-C, and says so.
[[nodiscard]] ExitCode check_scenes(const CheckCommand &command, std::ostream &out,
                                    std::ostream &err);

} // namespace plumb
