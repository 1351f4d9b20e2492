#include "app/sandbox/run_sandbox.h"

#include "app/files/output_file.h"
#include "app/lab/exit_code.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/render/framebuffer.h"
#include "app/render/imgui_renderer.h"
#include "app/render/png.h"
#include "app/render/renderer.h"
#include "app/sandbox/panels/layout.h"
#include "app/sandbox/panels/ui.h"
#include "app/sandbox/sandbox.h"
#include "app/sandbox/window_input.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/imgui.h>

namespace plumb {

namespace {

using Clock = std::chrono::steady_clock;

// A paused world is redrawn at full rate for this long after the last event, then only now and
// then.
constexpr double awake = 0.5;          // s
constexpr double drowsy = 0.2;         // s between frames
constexpr double title_interval = 0.2; // s between title updates while running

// Owns ImGui's GLFW back end. Construct after WindowInput, destroy before it.
// ImGui samples key state once per frame, so a key pressed and released within one slow frame would
// be lost. Releases are therefore held back until ImGui has seen the key.
class GlfwBackEnd {
  public:
    explicit GlfwBackEnd(Window &window) : window_(window.handle()) {
        ImGui_ImplGlfw_InitForOpenGL(window_, true);
        ImGui::GetIO().BackendLanguageUserData = this;
        glfwSetKeyCallback(window_, on_key);
    }
    ~GlfwBackEnd() { ImGui_ImplGlfw_Shutdown(); } // also removes the callback
    GlfwBackEnd(const GlfwBackEnd &) = delete;
    GlfwBackEnd &operator=(const GlfwBackEnd &) = delete;

    // Call after drawing: ImGui has now seen this frame's keys.
    void end_frame() {
        for (const Key &key : std::exchange(released_, {}))
            ImGui_ImplGlfw_KeyCallback(window_, key.key, key.scancode, GLFW_RELEASE, key.mods);
    }

  private:
    struct Key {
        int key, scancode, mods;
    };

    static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods) {
        auto *self = static_cast<GlfwBackEnd *>(ImGui::GetIO().BackendLanguageUserData);
        if (action == GLFW_RELEASE)
            self->released_.push_back({key, scancode, mods});
        else
            ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, mods);
    }

    GLFWwindow *window_;
    std::vector<Key> released_;
};

// Everything both loops draw with.
struct Stage {
    Stage(const SandboxOptions &options, bool in_software, float ui_scale, glm::ivec2 pixels)
        : ui(ui_scale), scale(ui_scale),
          renderer(options.shader_dir,
                   in_software ? Renderer::Quality::plain : Renderer::Quality::full),
          ui_renderer(options.shader_dir),
          target(pixels, options.samples.value_or(in_software ? 1 : 4)) {}

    // Takes effect when the next frame begins.
    void set_scale(float ui_scale) {
        if (ui_scale == scale)
            return;
        scale = ui_scale;
        ui.set_scale(scale);
        ui_renderer.upload_fonts();
    }

    // Panels first: the camera looks through the part they leave free.
    void draw(Sandbox &sandbox) {
        PanelContext context = sandbox.panel_context(ui.fonts());
        const ImDrawData &data = ui.draw(context);
        renderer.draw(sandbox.draw_list(), target, panels(data.FramebufferScale.x));
        ui_renderer.draw(data, target);
        sandbox.take(context);
    }

    // In pixels, `density` to a unit of panel coordinates; without the rounded corners.
    std::vector<PixelRect> panels(float density) const {
        constexpr float corner = 3;
        std::vector<PixelRect> rects;
        for (const Ui::Panel &panel : ui.panels()) {
            const glm::ivec2 low(glm::ceil(density * (panel.rect.min + corner * scale)));
            const glm::ivec2 high(glm::floor(density * (panel.rect.max() - corner * scale)));
            rects.push_back({low, high - low});
        }
        return rects;
    }

    Ui ui;
    float scale = 1; // the scale `ui` has
    Renderer renderer;
    ImguiRenderer ui_renderer;
    Framebuffer target;
};

Sandbox make_sandbox(const SandboxOptions &options) {
    Sandbox sandbox(Session(options.run, options.tasks), options.scenes, options.out_dir);
    if (!options.record.empty())
        sandbox.session().record();
    sandbox.clock().set_paused(options.paused);
    ProgressLine line(std::cerr); // no window shows the progress yet
    line.show(0, "opening the scene");
    if (!options.recording.empty())
        sandbox.open_recording(options.recording);
    else if (!options.initial_scene.empty())
        sandbox.open(options.initial_scene);
    else if (!options.scenes.empty())
        sandbox.open(options.scenes.front().path);
    return sandbox;
}

void write_screenshot(Sandbox &sandbox, const Framebuffer &target) {
    const std::filesystem::path path = sandbox.new_file(".png");
    try {
        if (path.has_parent_path())
            create_folder(path.parent_path());
        write_png(path, target.read());
        sandbox.session().messages().note("Wrote " + path.string());
    } catch (const std::exception &failure) {
        sandbox.session().messages().error(std::string("No screenshot: ") + failure.what());
    }
}

int finish(const SandboxOptions &options, const Sandbox &sandbox, const Stage &stage) {
    if (!options.screenshot.empty())
        write_png(options.screenshot, stage.target.read());
    const ExitCode replayed = sandbox.session().replay_outcome();
    const bool could_not_run = options.max_frames && !sandbox.session().running();
    if (could_not_run || replayed != ExitCode::fine)
        for (const Message &message : sandbox.session().messages().all())
            std::cerr << message.text << '\n';
    if (could_not_run) {
        return static_cast<int>(sandbox.session().memory_ran_out() ? ExitCode::no_room
                                                                   : ExitCode::bad_input);
    }
    return static_cast<int>(replayed);
}

// Runs the loop, then writes the recording, however the loop ended. Opens the file first, so that
// an unwritable path fails before the run.
template <typename Loop>
void with_recording(const SandboxOptions &options, const Sandbox &sandbox, const Loop &loop) {
    if (options.record.empty()) {
        loop();
        return;
    }
    OutputFile file(options.record);
    try {
        loop();
    } catch (...) {
        sandbox.session().write_recording(file);
        throw;
    }
    if (sandbox.session().running())
        sandbox.session().write_recording(file);
}

void draw_frames(const SandboxOptions &options, Sandbox &sandbox, Stage &stage) {
    ProgressLine line(std::cerr);
    for (int frame = 0;
         frame < *options.max_frames && !sandbox.quit_requested() && !InterruptGuard::requested();
         ++frame) {
        line.show(static_cast<double>(frame) / *options.max_frames, "drawing frames");
        sandbox.advance(1'000'000'000 / 60);
        stage.ui.fill_input(glm::vec2(options.size), 1.0f / 60);
        stage.ui.begin_frame();
        stage.draw(sandbox);
    }
    line.clear();
}

int run_off_screen(const SandboxOptions &options, bool in_software) {
    Sandbox sandbox = make_sandbox(options);
    Stage stage(options, in_software,
                scale_that_fits(options.ui_scale.value_or(1.0f), glm::vec2(options.size)),
                options.size);
    const InterruptGuard interrupt;
    with_recording(options, sandbox, [&] { draw_frames(options, sandbox, stage); });
    return finish(options, sandbox, stage);
}

void handle_events(Sandbox &sandbox, Ui &ui, const Window &window,
                   const WindowInput::Events &events) {
    for (const KeyEvent &key : events.keys)
        if (key.chord.key != special_key::escape || !ui.close_list())
            sandbox.handle(key, ui.wants_text());
    if (sandbox.take_keyboard_release())
        ui.release_keyboard();
    for (PointerEvent event : events.pointer) {
        event.over_panel = ui.over_panel();
        sandbox.handle(event, glm::vec2(window.size()));
    }
    if (!events.dropped.empty())
        sandbox.open(events.dropped.front());
}

// The scale of text and panels. The back end handles display pixels per window unit.
float ui_scale(const SandboxOptions &options, const Window &window, const Sandbox &sandbox) {
    const float dense = static_cast<float>(window.framebuffer_size().x) /
                        static_cast<float>(std::max(window.size().x, 1));
    const float monitor = window.content_scale() / (dense > 0 ? dense : 1);
    return scale_that_fits(options.ui_scale.value_or(monitor) * sandbox.view().ui_scale,
                           glm::vec2(window.size()));
}

void show_frames(const SandboxOptions &options, Window &window, WindowInput &input,
                 GlfwBackEnd &back_end, Sandbox &sandbox, Stage &stage) {
    std::string title;
    Clock::time_point last = Clock::now();
    Clock::time_point last_event = last;
    Clock::time_point last_title = last - std::chrono::hours(1);
    const auto since = [](Clock::time_point then, Clock::time_point now) {
        return std::chrono::duration<double>(now - then).count();
    };

    for (int frame = 0;
         !window.should_close() && !sandbox.quit_requested() && !InterruptGuard::requested();
         ++frame) {
        if (options.max_frames && frame >= *options.max_frames)
            break;
        const bool asleep = sandbox.clock().paused() && since(last_event, last) > awake;
        if (asleep && !options.max_frames)
            window.wait(drowsy);
        else
            window.poll();
        const Clock::time_point now = Clock::now();
        const std::int64_t passed =
            std::chrono::duration_cast<std::chrono::nanoseconds>(now - last).count();
        last = now;
        const glm::ivec2 pixels = window.framebuffer_size();
        if (pixels.x <= 0 || pixels.y <= 0) { // minimised: the world is on hold
            window.wait(drowsy);
            last = Clock::now();
            continue;
        }
        const WindowInput::Events events = input.take();
        if (!events.empty())
            last_event = now;

        stage.set_scale(ui_scale(options, window, sandbox));
        ImGui_ImplGlfw_NewFrame();
        stage.ui.begin_frame();
        handle_events(sandbox, stage.ui, window, events);
        sandbox.advance(passed);
        stage.target.resize(pixels);
        stage.draw(sandbox);
        back_end.end_frame();
        if (sandbox.take_screenshot_request())
            write_screenshot(sandbox, stage.target);
        stage.target.blit_to_window(pixels);
        window.swap();

        if (sandbox.title() != title &&
            (sandbox.clock().paused() || since(last_title, now) > title_interval)) {
            title = sandbox.title();
            window.set_title(title);
            last_title = now;
        }
    }
}

int run_in_window(const SandboxOptions &options, Window &window, bool in_software) {
    WindowInput input(window);
    Sandbox sandbox = make_sandbox(options);
    Stage stage(options, in_software, ui_scale(options, window, sandbox),
                glm::max(window.framebuffer_size(), 1));
    GlfwBackEnd back_end(window);
    const InterruptGuard interrupt;
    with_recording(options, sandbox,
                   [&] { show_frames(options, window, input, back_end, sandbox, stage); });
    return finish(options, sandbox, stage);
}

} // namespace

SandboxResult run_sandbox(const SandboxOptions &options) {
    ContextRequest request;
    request.choice = options.gl;
    request.size = options.size;
    const ContextResult made = create_context(request);
    if (Window *window = made.context->window())
        return {run_in_window(options, *window, made.context->is_software()), {}};
    if (options.max_frames)
        return {run_off_screen(options, made.context->is_software()), {}};
    return {0, made.why_no_window.empty() ? "osmesa was requested" : made.why_no_window};
}

} // namespace plumb
