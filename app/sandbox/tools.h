// The mouse over the scene: select, grab, shoot; orbit, pan, zoom.
#pragma once

#include "app/render/camera.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/view_state.h"

#include <optional>

#include <glm/vec2.hpp>

namespace plumb {

enum class PointerButton { left, right, middle };

// A mouse event. Positions are pixels from the viewport's top left.
struct PointerEvent {
    enum class Kind { press, release, move, wheel };
    Kind kind = Kind::move;
    PointerButton button = PointerButton::left; // press and release
    glm::vec2 position{0};
    float notches = 0; // wheel; positive away from the user
    bool ctrl = false;
    bool shift = false;
    bool over_panel = false; // a press or wheel event here belongs to a panel
};

// State the tools may change.
struct ToolTargets {
    Session &session;
    Camera &camera;
    std::optional<std::size_t> &selected;
    std::optional<std::size_t> &selected_particle;
    glm::vec2 viewport{1}; // pixels
};

class Tools {
  public:
    double shot_speed = 15; // m/s
    // Maximum grab force per kilogram of the body (m/s^2), some twenty times its weight on Earth:
    // enough to lift whatever hangs on the body or lies on it, without tearing anything.
    double grab_strength = 200;

    // A press over a panel belongs to the panel. Releases and moves always arrive here, so that a
    // drag can end over a panel.
    void handle(const PointerEvent &event, const ToolTargets &targets);

    // What the current drag does.
    enum class Drag { none, maybe_click, orbit, pan, grab, probe };
    [[nodiscard]] Drag drag() const { return drag_; }
    // Drops a drag whose body or scene is gone.
    void let_go(Session &session);

    // How far the pointer may move between press and release and still click, in pixels.
    static constexpr float click_slack = 4;

  private:
    void press(const PointerEvent &event, const ToolTargets &targets);
    void move(const PointerEvent &event, const ToolTargets &targets);
    void release(const PointerEvent &event, const ToolTargets &targets);
    void begin_grab(const PointerEvent &event, const ToolTargets &targets);
    [[nodiscard]] bool begin_probe(const PointerEvent &event, const ToolTargets &targets);
    // Where the pointer's ray hits the drag plane, if in front of the eye.
    [[nodiscard]] std::optional<glm::dvec3> place_in_plane(const glm::vec2 &pixel,
                                                           const ToolTargets &targets) const;
    void shoot(const PointerEvent &event, const ToolTargets &targets) const;

    Drag drag_ = Drag::none;
    PointerButton button_ = PointerButton::left; // the button that started the drag
    glm::vec2 pressed_at_{0};
    glm::vec2 last_{0};
    glm::dvec3 grab_point_{0};  // a point of the drag plane
    glm::dvec3 grab_normal_{0}; // its normal, facing the camera
    ProbeHandle handle_;        // being dragged
};

// The body or particle under a pixel, whichever is nearer.
struct Picked {
    std::optional<std::size_t> body, particle;
    glm::dvec3 point{0}; // on the body's surface, or the particle's centre
};
[[nodiscard]] std::optional<Picked> pick(const Session &session, const Camera &camera,
                                         const glm::vec2 &pixel, const glm::vec2 &viewport);

} // namespace plumb
