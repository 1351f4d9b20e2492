// All panels in their own ImGui context, in a window or off screen.
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

struct PanelRow; // a row of the panel list

// Usage: Ui ui(scale); ImguiRenderer renderer(shader_dir); then each frame fill ImGui's input (from
// its GLFW back end or with fill_input), call begin_frame and `draw`, and pass the data to the
// renderer.
class Ui {
  public:
    explicit Ui(float scale = 1); // makes the context current
    ~Ui();
    Ui(const Ui &) = delete;
    Ui &operator=(const Ui &) = delete;

    // Rebuilds text and all sizes; the caller must upload the fonts again.
    void set_scale(float scale);

    // For off-screen use: a display of this many pixels, a frame of this many seconds, no mouse.
    void fill_input(glm::vec2 size, float seconds);

    // Begins a frame; from here on over_panel() refers to the current mouse position.
    void begin_frame();
    // Draws the panels and ends the frame. Leaves the user's requests in `context`, and points its
    // camera through the part the panels leave free.
    [[nodiscard]] const ImDrawData &draw(PanelContext &context);

    // Whether a panel has the mouse; whether a text field has the keyboard.
    [[nodiscard]] bool over_panel() const;
    [[nodiscard]] bool wants_text() const;
    // Takes the keyboard away from a text field.
    void release_keyboard();
    // Closes the list or popup opened last. False if none is open, or one of its fields is being
    // typed in.
    bool close_list();

    struct Panel {
        PanelId id;
        std::string name;
        Rect rect; // as laid out by ImGui
    };
    // From the last frame.
    [[nodiscard]] const std::vector<Panel> &panels() const { return panels_; }
    [[nodiscard]] const Fonts &fonts() const { return fonts_; }

  private:
    void panel(PanelContext &context, const PanelRow &row, const Rect &rect);

    ImGuiContext *imgui_ = nullptr;
    float scale_ = 1;
    Fonts fonts_;
    std::vector<Panel> panels_;
    PerPanel<float> heights_{}; // content heights, from the last frame in which each was shown
};

} // namespace plumb
