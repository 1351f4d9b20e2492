// `plumb snapshot`: renders a scene at given steps, without a window.
#pragma once

#include "app/lab/exit_code.h"
#include "app/render/context.h"
#include "app/sandbox/session/scene_catalog.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

struct SnapshotCommand {
    std::vector<std::filesystem::path> scenes;
    RunOptions run;
    std::vector<std::uint64_t> at; // steps to render, ascending; 0 is the start
    glm::ivec2 size{1280, 720};
    std::filesystem::path out_dir = "out";
    std::filesystem::path shader_dir;
    bool panels = false;               // draw the sandbox's panels too
    float ui_scale = 1;                // of the panels
    std::vector<SceneEntry> catalogue; // scenes for the panels' list
    int samples = 4;                   // multisampling; use 1 for pictures that get compared
    bool numbered = true;              // scene-00060.png; else scene.png, for a single step
    GlChoice gl = GlChoice::automatic;
    TaskPool *tasks = nullptr;
};

// "1280x720". Throws std::invalid_argument that says what is allowed.
glm::ivec2 parse_size(const std::string &text);

// Writes each picture to a temporary file beside its destination, renames it, and prints its path
// to `out`. A scene that diverges is rendered as far as it got. Ctrl-C stops after the current
// picture. Throws ContextError if there is no GL context.
ExitCode make_snapshots(const SnapshotCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
