#include "app/sandbox/ui_snapshot.h"

#include "app/render/framebuffer.h"
#include "app/render/imgui_renderer.h"
#include "app/sandbox/panels/layout.h"

namespace plumb {

Image ui_snapshot(Sandbox &sandbox, Renderer &renderer, const std::filesystem::path &shader_dir,
                  const UiSnapshotOptions &options, std::vector<Ui::Panel> *panels) {
    sandbox.clock().set_paused(true); // the exact state, not a blend of two steps
    sandbox.keep_in_picture();
    Ui ui(scale_that_fits(options.scale, glm::vec2(options.size)));
    ImguiRenderer ui_renderer(shader_dir);
    const ImDrawData *data = nullptr;
    // Panel heights come from the previous frame's contents, and ImGui lays out tables and scroll
    // bars by what it last showed.
    constexpr int frames_to_settle = 4;
    for (int frame = 0; frame < frames_to_settle; ++frame) {
        ui.fill_input(glm::vec2(options.size), 1.0f / 60);
        ui.begin_frame();
        PanelContext context = sandbox.panel_context(ui.fonts(), true);
        data = &ui.draw(context);
    }
    Framebuffer target(options.size, options.samples);
    renderer.draw(sandbox.draw_list(), target);
    ui_renderer.draw(*data, target);
    if (panels)
        *panels = ui.panels();
    return target.read();
}

} // namespace plumb
