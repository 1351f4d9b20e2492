#include "app/sandbox/window_input.h"

#include "app/sandbox/panels/layout.h"

#include <optional>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace plumb {

namespace {

std::optional<char32_t> special(int key) {
    switch (key) {
    case GLFW_KEY_ESCAPE:
        return special_key::escape;
    case GLFW_KEY_TAB:
        return special_key::tab;
    case GLFW_KEY_BACKSPACE:
        return special_key::backspace;
    case GLFW_KEY_LEFT:
        return special_key::left;
    case GLFW_KEY_RIGHT:
        return special_key::right;
    case GLFW_KEY_HOME:
        return special_key::home;
    case GLFW_KEY_F1:
        return special_key::f1;
    default:
        return {};
    }
}

char32_t lower(char32_t c) {
    return c >= U'A' && c <= U'Z' ? c - U'A' + U'a' : c;
}

} // namespace

// GLFW's callbacks find the object through the window's user pointer.
struct WindowInput::Callbacks {
    static WindowInput &self(GLFWwindow *window) {
        return *static_cast<WindowInput *>(glfwGetWindowUserPointer(window));
    }

    static bool held(GLFWwindow *window, int left, int right) {
        return glfwGetKey(window, left) == GLFW_PRESS || glfwGetKey(window, right) == GLFW_PRESS;
    }

    static void key(GLFWwindow *window, int key, int scancode, int action, int mods) {
        WindowInput &input = self(window);
        if (action == GLFW_RELEASE)
            return;
        input.repeat_ = action == GLFW_REPEAT;
        if ((mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0)
            return;
        const bool ctrl = (mods & GLFW_MOD_CONTROL) != 0;
        if (const auto which = special(key)) {
            const bool shift = (mods & GLFW_MOD_SHIFT) != 0;
            input.events_.keys.push_back({{*which, ctrl, shift}, input.repeat_});
            return;
        }
        // Keys that type a character arrive in `character`, after the keyboard layout. With Ctrl
        // they type nothing, so look the layout up here.
        if (!ctrl)
            return;
        const char *name = glfwGetKeyName(key, scancode);
        if (name && name[0] != '\0' && name[1] == '\0')
            input.events_.keys.push_back(
                {{lower(static_cast<unsigned char>(name[0])), true, false}, input.repeat_});
    }

    static void character(GLFWwindow *window, unsigned code) {
        WindowInput &input = self(window);
        input.events_.keys.push_back(
            {{lower(static_cast<char32_t>(code)), false, false}, input.repeat_});
    }

    // The position after the preceding move events. glfwGetCursorPos would give the pointer's
    // position now, which after a slow frame is not where the button was pressed.
    static PointerEvent here(GLFWwindow *window, PointerEvent::Kind kind) {
        PointerEvent event;
        event.kind = kind;
        event.position = self(window).pointer_;
        event.ctrl = held(window, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
        event.shift = held(window, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
        return event;
    }

    static void button(GLFWwindow *window, int button, int action, int mods) {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE)
            return;
        PointerEvent event = here(window, action == GLFW_PRESS ? PointerEvent::Kind::press
                                                               : PointerEvent::Kind::release);
        event.button = button == GLFW_MOUSE_BUTTON_LEFT    ? PointerButton::left
                       : button == GLFW_MOUSE_BUTTON_RIGHT ? PointerButton::right
                                                           : PointerButton::middle;
        event.ctrl = (mods & GLFW_MOD_CONTROL) != 0;
        event.shift = (mods & GLFW_MOD_SHIFT) != 0;
        self(window).events_.pointer.push_back(event);
    }

    static void move(GLFWwindow *window, double x, double y) {
        self(window).pointer_ = {static_cast<float>(x), static_cast<float>(y)};
        self(window).events_.pointer.push_back(here(window, PointerEvent::Kind::move));
    }

    static void wheel(GLFWwindow *window, double, double y) {
        PointerEvent event = here(window, PointerEvent::Kind::wheel);
        event.notches = static_cast<float>(y);
        self(window).events_.pointer.push_back(event);
    }

    static void drop(GLFWwindow *window, int count, const char **paths) {
        for (int i = 0; i < count; ++i)
            self(window).events_.dropped.emplace_back(paths[i]);
    }
};

WindowInput::WindowInput(Window &window) : window_(window.handle()) {
    glfwSetWindowSizeLimits(window_, static_cast<int>(smallest_window.x),
                            static_cast<int>(smallest_window.y), GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    double x = 0;
    double y = 0;
    glfwGetCursorPos(window_, &x, &y);
    pointer_ = {static_cast<float>(x), static_cast<float>(y)};
    glfwSetKeyCallback(window_, Callbacks::key);
    glfwSetCharCallback(window_, Callbacks::character);
    glfwSetMouseButtonCallback(window_, Callbacks::button);
    glfwSetCursorPosCallback(window_, Callbacks::move);
    glfwSetScrollCallback(window_, Callbacks::wheel);
    glfwSetDropCallback(window_, Callbacks::drop);
}

WindowInput::~WindowInput() {
    glfwSetKeyCallback(window_, nullptr);
    glfwSetCharCallback(window_, nullptr);
    glfwSetMouseButtonCallback(window_, nullptr);
    glfwSetCursorPosCallback(window_, nullptr);
    glfwSetScrollCallback(window_, nullptr);
    glfwSetDropCallback(window_, nullptr);
    glfwSetWindowUserPointer(window_, nullptr);
}

WindowInput::Events WindowInput::take() {
    return std::exchange(events_, {});
}

} // namespace plumb
