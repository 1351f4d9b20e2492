// A picture of the sandbox with its panels, without a window.
#pragma once

#include "app/render/image.h"
#include "app/render/renderer.h"
#include "app/sandbox/panels/ui.h"
#include "app/sandbox/sandbox.h"

#include <filesystem>

#include <glm/vec2.hpp>

namespace plumb {

struct UiSnapshotOptions {
    glm::ivec2 size{1280, 800};
    int samples = 1; // multisampling
    float scale = 1; // of text and panels
};

// The sandbox's current state with its panels; this pauses it. Wall times and their graph are left
// out, so that the same state always gives the same picture. A GL context must be current.
// `panels`, if given, receives the panels and their rectangles.
[[nodiscard]] Image ui_snapshot(Sandbox &sandbox, Renderer &renderer,
                                const std::filesystem::path &shader_dir,
                                const UiSnapshotOptions &options,
                                std::vector<Ui::Panel> *panels = nullptr);

} // namespace plumb
