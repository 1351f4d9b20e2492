// The sandbox without a window: scene, view, tools, clock and panels, driven by events and time.
#pragma once

#include "app/render/draw_list.h"
#include "app/sandbox/keys.h"
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/session/clock.h"
#include "app/sandbox/session/pace.h"
#include "app/sandbox/session/scene_catalog.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/tools.h"
#include "app/sandbox/view_state.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

struct KeyEvent {
    Chord chord;
    bool repeat = false; // key repeat
};

class Sandbox {
  public:
    // `scenes` are listed in this order. Scenes are saved to `out_dir`.
    explicit Sandbox(Session session, std::vector<SceneEntry> scenes = {},
                     std::filesystem::path out_dir = "out");
    ~Sandbox();
    Sandbox(Sandbox &&) = default;
    Sandbox &operator=(Sandbox &&) = delete;
    Sandbox(const Sandbox &) = delete;
    Sandbox &operator=(const Sandbox &) = delete;

    // Opens with the scene's own camera and nothing selected. False, with messages, if the scene
    // cannot run.
    bool open(const std::filesystem::path &path);
    bool open(const SceneDesc &scene, const std::filesystem::path &path = {});
    bool open_recording(const std::filesystem::path &path);

    void perform(Action action);
    // `in_text_field`: plain keys go to the text field; only Ctrl chords, F1 and Esc act.
    void handle(const KeyEvent &event, bool in_text_field = false);
    void handle(const PointerEvent &event, glm::vec2 viewport);
    // Advances real time: takes the steps that are due, but for no longer than step_budget.
    void advance(std::int64_t nanoseconds);
    static constexpr double step_budget = 0.05; // s of real time per frame

    // Moves the camera along when all that moves would leave the picture, and back when it returns;
    // `advance` does so too.
    void keep_in_picture();

    [[nodiscard]] PanelContext panel_context(const Fonts &fonts, bool frozen = false);
    // Carries out what the user asked for in the panels.
    void take(const PanelContext &context);

    // The current frame.
    [[nodiscard]] DrawList draw_list() const;
    // "tower - paused - step 12 - Plumb"
    [[nodiscard]] std::string title() const;

    // A file of this type that does not exist yet: out_dir/scene-step.png
    [[nodiscard]] std::filesystem::path new_file(const std::string &extension) const;

    // Whether requested since the last call.
    [[nodiscard]] bool take_screenshot_request();
    [[nodiscard]] bool take_keyboard_release();
    [[nodiscard]] bool quit_requested() const { return quit_; }

    [[nodiscard]] Session &session() { return session_; }
    [[nodiscard]] const Session &session() const { return session_; }
    [[nodiscard]] ViewState &view() { return view_; }
    [[nodiscard]] const ViewState &view() const { return view_; }
    [[nodiscard]] StepClock &clock() { return clock_; }
    [[nodiscard]] const StepClock &clock() const { return clock_; }
    [[nodiscard]] const Tools &tools() const { return tools_; }

  private:
    void look_from(Camera camera); // through the part the panels leave free, and follow
    int take_due_steps(std::int64_t nanoseconds); // returns how many were taken
    void take_steps(int count);
    void take_steps_back(int count);
    void reload();
    void open_neighbour(int direction);
    void choose_neighbour_method(int direction);
    void toggle_ghost();
    void go_on_with(const RunChoice &choice);
    void scale_panels(float factor);
    void frame_selection();
    void dismiss();
    void started(bool another_scene);
    void forget_studies();     // of a scene that is gone
    void look_under_pointer(); // what it is over now: bodies move beneath it
    void follow_simulation();  // updates the clock's dt, and drops a selection that is gone

    Session session_;
    std::vector<SceneEntry> scenes_;
    std::filesystem::path out_dir_;
    ViewState view_;
    Tools tools_;
    StepClock clock_{1.0 / 60};
    Pace pace_; // while running
    struct Pointer {
        glm::vec2 position;
        glm::vec2 viewport;
        bool over_panel = false;
    };
    std::optional<Pointer> pointer_; // as it last moved
    ChartStudy chart_;
    MapStudy map_;
    bool quit_ = false;
    bool screenshot_ = false;
    bool release_keyboard_ = false;
};

} // namespace plumb
