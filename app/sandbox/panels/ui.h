// All panels together, in an ImGui context of their own: in a window, or off screen.
#pragma once

#include "app/sandbox/panels/layout.h"
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/theme.h"

#include <string>
#include <vector>

#include <glm/vec2.hpp>

struct ImDrawData;
struct ImGuiContext;

namespace plumb {

struct PanelRow; // what there is to know of a panel

// Use: Ui ui(scale); ImguiRenderer renderer(shader_dir); then each frame, after ImGui's input is
// filled in (by its GLFW back end, or by fill_input), `draw`, and hand the data to the renderer.
class Ui {
  public:
    explicit Ui(float scale = 1); // makes the context current
    ~Ui();
    Ui(const Ui &) = delete;
    Ui &operator=(const Ui &) = delete;

    // Text and all sizes anew; whoever draws the panels must upload the fonts again.
    void set_scale(float scale);

    // Off screen: a display of this many pixels and a frame of this many seconds, with no mouse.
    void fill_input(glm::vec2 size, float seconds);

    // Begins a frame, after which over_panel() speaks of the present mouse position.
    void begin_frame();
    // Draws the panels, and ends the frame. What the person asked for is left in `context`, and its
    // camera looks through what the panels leave free.
    [[nodiscard]] const ImDrawData &draw(PanelContext &context);

    // A panel has the mouse; the keyboard goes into a text field.
    [[nodiscard]] bool over_panel() const;
    [[nodiscard]] bool wants_text() const;
    // Takes the keyboard out of a text field.
    void release_keyboard();
    // The list or popup that was opened last; false if none is open, or one of its fields is typed
    // in.
    bool close_list();

    struct Panel {
        PanelId id;
        std::string name;
        Rect rect; // as ImGui has it
    };
    // Of the last frame.
    [[nodiscard]] const std::vector<Panel> &panels() const { return panels_; }
    [[nodiscard]] const Fonts &fonts() const { return fonts_; }

  private:
    void panel(PanelContext &context, const PanelRow &row, const Rect &rect);

    ImGuiContext *imgui_ = nullptr;
    float scale_ = 1;
    Fonts fonts_;
    std::vector<Panel> panels_;
    PerPanel<float> heights_{}; // of their contents, in the last frame that had them
};

} // namespace plumb
