// The benchmarks of `plumb bench`.
#pragma once

#include "app/lab/exit_code.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumb {

// Geometry queries and trees: writes tables, CSV files and a chart to a folder.
ExitCode bench_geometry(int rounds, const std::filesystem::path &out_dir,
                        const std::filesystem::path &shader_dir);

struct EngineBenchOptions {
    std::vector<std::string> only; // by name; empty: all
    std::optional<double> seconds; // simulated time, at most
    double size = 1;               // scene size: multiplies the body count, roughly
    int threads = 2;               // for Plumb, in addition to its run with 1
    std::filesystem::path out_dir;
};

// Runs the same scenes in every engine, taking each step in turn: cost and error.
ExitCode bench_dynamics(const EngineBenchOptions &options);

// Writes the scenes of bench_dynamics to files in a folder.
ExitCode bench_scene_files(const EngineBenchOptions &options);

// Small problems with a known answer: each engine's error beside the aim.
ExitCode bench_truth(const EngineBenchOptions &options);

// Writes the scenes of bench_truth to files in a folder.
ExitCode bench_problem_files(const EngineBenchOptions &options);

} // namespace plumb
