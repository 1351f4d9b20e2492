// The interactive program: a window and its main loop.
#pragma once

#include "app/render/context.h"
#include "app/sandbox/session/scene_catalog.h"
#include "engine/core/task_pool.h"
#include "engine/scene/simulation.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

struct SandboxOptions {
    std::vector<SceneEntry> scenes;      // scenes to choose from
    std::filesystem::path initial_scene; // empty: the first of `scenes`
    std::filesystem::path recording;     // played instead of a scene
    GlChoice gl = GlChoice::automatic;
    glm::ivec2 size{1280, 800};
    std::filesystem::path shader_dir;
    std::filesystem::path out_dir = "out"; // for screenshots and saved scenes
    RunOptions run;
    TaskPool *tasks = nullptr; // may be null
    bool paused = false;
    std::optional<int> samples;    // multisampling; if empty, what the renderer can afford
    std::optional<float> ui_scale; // panel scale; if empty, the monitor's
    // For tests: stop after this many frames and write the last one to a file. Without a window
    // each frame lasts 1/60 s.
    std::optional<int> max_frames;
    std::filesystem::path screenshot;
    std::filesystem::path record; // the run in progress at the end is recorded here
};

struct SandboxResult {
    int exit_code = 0; // an ExitCode: bad_input if the initial scene could not run in the frames
                       // requested; for a played recording, Session::replay_outcome
    // If not empty, nothing was run for lack of a window; this is why there is none.
    std::string why_no_window;
};

// Runs until the user quits. Throws ContextError or std::runtime_error if nothing can be rendered
// at all.
SandboxResult run_sandbox(const SandboxOptions &options);

} // namespace plumb
