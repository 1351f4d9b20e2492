// What `plumb bench` runs.
#pragma once

#include "app/lab/exit_code.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

// The geometry's queries, and the trees: tables, CSV files and a chart in a folder.
ExitCode bench_geometry(int rounds, const std::filesystem::path &out_dir,
                        const std::filesystem::path &shader_dir);

struct EngineBenchOptions {
    std::vector<std::string> only; // names; none: all
    std::optional<double> seconds; // of the world, at most
    double size = 1;               // of the scenes: about so many times as many bodies
    int threads = 2;               // of Plumb, beside 1
    std::filesystem::path out_dir;
};

// Steps through the same scenes with every engine, step by step in turns: cost and error.
ExitCode bench_dynamics(const EngineBenchOptions &options);

// The scenes that bench_dynamics steps through, as files in a folder.
ExitCode bench_scene_files(const EngineBenchOptions &options);

// Small problems whose answer is known: what each engine makes of it, beside the aim.
ExitCode bench_truth(const EngineBenchOptions &options);

} // namespace plumb
