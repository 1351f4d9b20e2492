// `plumb snapshot`: pictures of a scene at given steps, without a window.
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
    std::vector<std::uint64_t> at; // steps to show, ascending; 0 is the start
    glm::ivec2 size{1280, 720};
    std::filesystem::path out_dir = "out";
    std::filesystem::path shader_dir;
    bool panels = false;               // the sandbox's, too
    float ui_scale = 1;                // of the panels
    std::vector<SceneEntry> catalogue; // that the panels list
    int samples = 4;                   // of multisampling; 1 for pictures that are compared
    bool numbered = true;              // scene-00060.png; else scene.png, for one step alone
    GlChoice gl = GlChoice::automatic;
    TaskPool *tasks = nullptr;
};

// "1280x720". Throws std::invalid_argument that says what would be right.
glm::ivec2 parse_size(const std::string &text);

// Writes the pictures, each beside its place and then renamed, and prints their paths to `out`. A
// scene that diverges is shown as far as it went. Ctrl-C ends it after the picture at hand. Throws
// ContextError when there is no GL context.
ExitCode make_snapshots(const SnapshotCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
