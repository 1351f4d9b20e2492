// A window's keyboard and mouse input as events. The only sandbox file that knows GLFW.
#pragma once

#include "app/render/context.h"
#include "app/sandbox/sandbox.h"

#include <filesystem>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

class WindowInput {
  public:
    // Construct before ImGui's GLFW back end, which then passes events on to it.
    explicit WindowInput(Window &window);
    ~WindowInput();
    WindowInput(const WindowInput &) = delete;
    WindowInput &operator=(const WindowInput &) = delete;

    struct Events {
        std::vector<KeyEvent> keys;
        std::vector<PointerEvent> pointer; // over_panel is not set here
        std::vector<std::filesystem::path> dropped;
        [[nodiscard]] bool empty() const {
            return keys.empty() && pointer.empty() && dropped.empty();
        }
    };
    // Events since the last call, in order.
    [[nodiscard]] Events take();

  private:
    struct Callbacks;
    GLFWwindow *window_ = nullptr;
    Events events_;
    glm::vec2 pointer_{0};
    bool repeat_ = false; // the last key event was a repeat
};

} // namespace plumb
