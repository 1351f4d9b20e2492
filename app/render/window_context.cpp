#include "app/render/context.h"

#include <glad/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace plumb {

namespace {

std::string last_error(const char *otherwise) {
    const char *text = nullptr;
    glfwGetError(&text);
    return text ? text : otherwise;
}

class WindowContext final : public GlContext, public Window {
  public:
    explicit WindowContext(const ContextRequest &request) {
        // Without a display glfwInit fails, which tells the caller to fall back.
        if (glfwInit() == GLFW_FALSE)
            throw ContextError(last_error("GLFW failed to start"));
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_VISIBLE,
                       request.visible && !request.off_screen ? GLFW_TRUE : GLFW_FALSE);
        // The window only shows a Framebuffer's contents.
        glfwWindowHint(GLFW_DEPTH_BITS, 0);
        glfwWindowHint(GLFW_STENCIL_BITS, 0);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        window_ = glfwCreateWindow(request.size.x, request.size.y, request.title.c_str(), nullptr,
                                   nullptr);
        if (!window_) {
            const std::string reason = last_error("no window with OpenGL 3.3");
            glfwTerminate();
            throw ContextError(reason);
        }
        glfwMakeContextCurrent(window_);
        if (gladLoadGL(reinterpret_cast<GLADloadfunc>(glfwGetProcAddress)) == 0) {
            close();
            throw ContextError("the window's OpenGL functions could not be loaded");
        }
        glfwSwapInterval(request.vsync ? 1 : 0);
        read_strings();
    }

    ~WindowContext() override { close(); }

    WindowContext(const WindowContext &) = delete;
    WindowContext &operator=(const WindowContext &) = delete;

    void make_current() override { glfwMakeContextCurrent(window_); }
    [[nodiscard]] Window *window() override { return this; }
    [[nodiscard]] const char *kind() const override { return "window"; }

    [[nodiscard]] GLFWwindow *handle() const override { return window_; }
    [[nodiscard]] glm::ivec2 size() const override {
        glm::ivec2 result{0};
        glfwGetWindowSize(window_, &result.x, &result.y);
        return result;
    }
    [[nodiscard]] glm::ivec2 framebuffer_size() const override {
        glm::ivec2 result{0};
        glfwGetFramebufferSize(window_, &result.x, &result.y);
        return result;
    }
    [[nodiscard]] float content_scale() const override {
        float x = 1;
        float y = 1;
        glfwGetWindowContentScale(window_, &x, &y);
        return x > 0 ? x : 1;
    }
    [[nodiscard]] bool should_close() const override { return glfwWindowShouldClose(window_) != 0; }
    void request_close(bool close) override {
        glfwSetWindowShouldClose(window_, close ? GLFW_TRUE : GLFW_FALSE);
    }
    void set_title(const std::string &title) override {
        glfwSetWindowTitle(window_, title.c_str());
    }
    void poll() override { glfwPollEvents(); }
    void wait(double seconds) override { glfwWaitEventsTimeout(seconds); }
    void swap() override { glfwSwapBuffers(window_); }

  private:
    void close() {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }

    GLFWwindow *window_ = nullptr;
};

} // namespace

std::unique_ptr<GlContext> create_window_context(const ContextRequest &request) {
    return std::make_unique<WindowContext>(request);
}

} // namespace plumb
