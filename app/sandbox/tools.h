// The mouse over the scene: select, grab, shoot; orbit, pan, zoom.
#pragma once

#include "app/render/camera.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/view_state.h"

#include <optional>

#include <glm/vec2.hpp>

namespace plumb {

enum class PointerButton { left, right, middle };

// What happened to the mouse. Positions in pixels from the top left of the viewport.
struct PointerEvent {
    enum class Kind { press, release, move, wheel };
    Kind kind = Kind::move;
    PointerButton button = PointerButton::left; // press and release
    glm::vec2 position{0};
    float notches = 0; // wheel; positive away from the person
    bool ctrl = false;
    bool shift = false;
    bool over_panel = false; // a panel has it, if it is a press or the wheel
};

// What the tools may change.
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
    // The greatest force of a grab for each kilogram of the body (m/s^2), some twenty times its
    // weight on Earth: it lifts what hangs on the body or lies on it, and tears nothing.
    double grab_strength = 200;

    // A press over a panel belongs to the panel; releases and moves always arrive here, so that a
    // drag that ends over a panel ends.
    void handle(const PointerEvent &event, const ToolTargets &targets);

    // What the left button is at, or nothing.
    enum class Drag { none, maybe_click, orbit, pan, grab, probe };
    [[nodiscard]] Drag drag() const { return drag_; }
    // Forgets a drag whose body or scene is gone.
    void let_go(Session &session);

    // How far the pointer may wander between press and release of a click, in pixels.
    static constexpr float click_slack = 4;

  private:
    void press(const PointerEvent &event, const ToolTargets &targets);
    void move(const PointerEvent &event, const ToolTargets &targets);
    void release(const PointerEvent &event, const ToolTargets &targets);
    void begin_grab(const PointerEvent &event, const ToolTargets &targets);
    [[nodiscard]] bool begin_probe(const PointerEvent &event, const ToolTargets &targets);
    // Where the pointer's ray meets the plane of the drag, if it does in front of the eye.
    [[nodiscard]] std::optional<glm::dvec3> place_in_plane(const glm::vec2 &pixel,
                                                           const ToolTargets &targets) const;
    void shoot(const PointerEvent &event, const ToolTargets &targets) const;

    Drag drag_ = Drag::none;
    PointerButton button_ = PointerButton::left; // the one that began the drag
    glm::vec2 pressed_at_{0};
    glm::vec2 last_{0};
    glm::dvec3 grab_point_{0};  // the plane of the drag: through here
    glm::dvec3 grab_normal_{0}; // facing the camera
    ProbeHandle handle_;        // that is dragged
};

// The body or the particle under a pixel, whichever is nearer.
struct Picked {
    std::optional<std::size_t> body, particle;
    glm::dvec3 point{0}; // on the body's surface, or the particle's centre
};
[[nodiscard]] std::optional<Picked> pick(const Session &session, const Camera &camera,
                                         const glm::vec2 &pixel, const glm::vec2 &viewport);

} // namespace plumb
