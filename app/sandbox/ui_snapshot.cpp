#include "app/sandbox/ui_snapshot.h"

#include "app/render/framebuffer.h"
#include "app/render/imgui_renderer.h"

namespace plumb {

Image ui_snapshot(Sandbox &sandbox, Renderer &renderer, const std::filesystem::path &shader_dir,
                  glm::ivec2 size, int samples, std::vector<Ui::Panel> *panels) {
    sandbox.clock().set_paused(true); // the state itself, not what lies between two steps
    Framebuffer target(size, samples);
    renderer.draw(sandbox.draw_list(), target);
    Ui ui;
    ImguiRenderer ui_renderer(shader_dir);
    const ImDrawData *data = nullptr;
    // ImGui lays out tables and scroll bars by what the frame before has shown.
    constexpr int frames_to_settle = 3;
    for (int frame = 0; frame < frames_to_settle; ++frame) {
        ui.fill_input(glm::vec2(size), 1.0f / 60);
        ui.begin_frame();
        PanelContext context = sandbox.panel_context(ui.fonts(), true);
        data = &ui.draw(context);
    }
    ui_renderer.draw(*data, target);
    if (panels)
        *panels = ui.panels();
    return target.read();
}

} // namespace plumb
