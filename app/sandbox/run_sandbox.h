// The interactive program: a window, and the loop that keeps it alive.
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
    std::vector<SceneEntry> scenes;      // to choose from
    std::filesystem::path initial_scene; // empty: the first of `scenes`
    std::filesystem::path recording;     // to be played instead
    GlChoice gl = GlChoice::automatic;
    glm::ivec2 size{1280, 800};
    std::filesystem::path shader_dir;
    std::filesystem::path out_dir = "out"; // screenshots and saved scenes
    RunOptions run;
    TaskPool *tasks = nullptr; // may be null
    bool paused = false;
    std::optional<int> samples;    // of multisampling; as the renderer can bear if empty
    std::optional<float> ui_scale; // of the panels; the monitor's if empty
    // For tests: ends after so many frames, and writes the last one to a file. Without a window
    // each frame lasts 1/60 s.
    std::optional<int> max_frames;
    std::filesystem::path screenshot;
    std::filesystem::path record; // the run that goes on at the end is recorded there
};

struct SandboxResult {
    int exit_code = 0; // an ExitCode: bad_input if the initial scene could not run in the frames
                       // asked; of a recording that was played, Session::replay_outcome
    // Not empty: nothing was run, because there is no window, for this reason.
    std::string why_no_window;
};

// Until the person has quit. Throws ContextError or std::runtime_error where a picture cannot be
// made at all.
SandboxResult run_sandbox(const SandboxOptions &options);

} // namespace plumb
