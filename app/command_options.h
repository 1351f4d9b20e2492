// Command line options shared by several commands, and their parsing.
#pragma once

#include "app/sandbox/session/scene_catalog.h"
#include "engine/scene/simulation.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

// Values of the shared options.
struct CommonOptions {
    std::filesystem::path data = find_data_dir();
    std::vector<SceneEntry> catalogue = find_scenes(data / "scenes");
    std::vector<std::string> scenes;
    std::string method, precision, gl = "auto", size;
    GivenSettings settings;
    int threads = 1;
    std::filesystem::path out;

    std::vector<std::filesystem::path> scene_paths() const {
        std::vector<std::filesystem::path> paths;
        for (const std::string &name : scenes)
            paths.push_back(resolve_scene(name, catalogue));
        return paths;
    }
    RunOptions run() const {
        RunOptions options;
        options.method = method;
        options.settings = settings;
        if (!precision.empty())
            options.precision = precision == "double" ? Precision::f64 : Precision::f32;
        return options;
    }
    std::filesystem::path shader_dir() const { return data / "shaders"; }
};

// "soft_step, tgs_soft, ...", for the help text.
std::string method_names();

// Validators: a number above 0; a step count.
CLI::Validator positive();
CLI::Range step_range();

// Splits a list option; throws std::invalid_argument if an item is empty.
std::vector<std::string> parse_list(const std::string &text);
// "0,60,240"; throws the same way.
std::vector<std::uint64_t> parse_steps(const std::string &text);

void add_scenes(CLI::App &command, CommonOptions &common);
void add_threads(CLI::App &command, CommonOptions &common);
// A chart gets no method, as it runs several, and no threads, as it is timed on one.
void add_run_options(CLI::App &command, CommonOptions &common, bool chart = false);
void add_gl(CLI::App &command, CommonOptions &common);
void add_out(CLI::App &command, CommonOptions &common, const std::string &by_default);

template <typename T>
void add_ui_scale(CLI::App &command, T &scale, const std::string &by_default) {
    command
        .add_option("--ui-scale", scale, "Scale of text and panels, 0.5 to 4 (" + by_default + ")")
        ->check(CLI::Range(0.5, 4.0));
}

} // namespace plumb
