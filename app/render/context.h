// OpenGL 3.3 core contexts: a window (GLFW), or a buffer in memory (OSMesa).
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <glm/vec2.hpp>

struct GLFWwindow;

namespace plumb {

enum class GlChoice { automatic, window, osmesa };

// "auto", "window", "osmesa". Otherwise throws std::invalid_argument listing them.
[[nodiscard]] GlChoice gl_choice_from_name(const std::string &name);

// What the interactive loop needs from a window. Created by create_context; closed by its
// destructor.
class Window {
  public:
    virtual ~Window() = default;
    // For ImGui's GLFW back end, and for input.
    [[nodiscard]] virtual GLFWwindow *handle() const = 0;
    [[nodiscard]] virtual glm::ivec2 size() const = 0;             // screen coordinates
    [[nodiscard]] virtual glm::ivec2 framebuffer_size() const = 0; // pixels; 0 when minimised
    [[nodiscard]] virtual float content_scale() const = 0;         // 1 on an ordinary monitor
    [[nodiscard]] virtual bool should_close() const = 0;
    virtual void request_close(bool close) = 0;
    virtual void set_title(const std::string &title) = 0;
    virtual void poll() = 0;               // handles pending events
    virtual void wait(double seconds) = 0; // the same, but sleeps until an event arrives
    virtual void swap() = 0;
};

// A context, current on the thread that made it. GL objects must be destroyed before it.
class GlContext {
  public:
    virtual ~GlContext() = default;
    virtual void make_current() = 0;
    [[nodiscard]] virtual Window *window() = 0;         // null off screen
    [[nodiscard]] virtual const char *kind() const = 0; // "window" or "osmesa"

    // GL_RENDERER and GL_VERSION.
    [[nodiscard]] const std::string &renderer() const { return renderer_; }
    [[nodiscard]] const std::string &version() const { return version_; }
    // Whether the CPU draws, judging by the renderer's name.
    [[nodiscard]] bool is_software() const;

  protected:
    void read_strings(); // call once the context is current and loaded

  private:
    std::string renderer_;
    std::string version_;
};

struct ContextRequest {
    GlChoice choice = GlChoice::automatic;
    // Off screen (snapshots): `automatic` then means OSMesa whether or not there is a display, so
    // that pictures do not depend on it; `window` gives a hidden window.
    bool off_screen = false;
    glm::ivec2 size{1280, 720}; // of the window, screen coordinates
    std::string title = "Plumb";
    bool visible = true;
    bool vsync = true;
};

struct ContextResult {
    std::unique_ptr<GlContext> context; // never null
    // Why there is no window although `automatic` wanted one; empty otherwise.
    std::string why_no_window;
};

// No context could be made; lists each attempt and why it failed.
class ContextError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

[[nodiscard]] ContextResult create_context(const ContextRequest &request);

// The two factories; each throws ContextError, and only its own file knows its library.
[[nodiscard]] std::unique_ptr<GlContext> create_window_context(const ContextRequest &request);
[[nodiscard]] std::unique_ptr<GlContext> create_osmesa_context();

} // namespace plumb
