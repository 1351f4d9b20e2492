// The sandbox as a picture, panels and all, without a window.
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
    int samples = 1; // of multisampling
    float scale = 1; // of text and panels
};

// The present state of the sandbox, which is paused, with its panels; wall times and their graph
// are left out, so that the same state gives the same picture. A GL context must be current. If
// `panels` is given, it gets the panels with their places.
[[nodiscard]] Image ui_snapshot(Sandbox &sandbox, Renderer &renderer,
                                const std::filesystem::path &shader_dir,
                                const UiSnapshotOptions &options,
                                std::vector<Ui::Panel> *panels = nullptr);

} // namespace plumb
