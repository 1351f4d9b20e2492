#include "app/snapshot.h"

#include "app/files/output_file.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/run/load_scenes.h"
#include "app/render/framebuffer.h"
#include "app/render/png.h"
#include "app/render/renderer.h"
#include "app/sandbox/sandbox.h"
#include "app/sandbox/ui_snapshot.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>

namespace plumb {

namespace {

void print(std::ostream &err, const Messages &messages) {
    for (const Message &message : messages.all())
        err << message.text << '\n';
}

std::filesystem::path picture_path(const SnapshotCommand &command, const std::string &scene,
                                   std::uint64_t step) {
    if (!command.numbered)
        return command.out_dir / (scene + ".png");
    std::string digits = std::to_string(step);
    digits.insert(0, 5 - std::min<std::size_t>(digits.size(), 5), '0');
    return command.out_dir / (scene + "-" + digits + ".png");
}

Image plain_picture(const SnapshotCommand &command, Sandbox &sandbox, Renderer &renderer) {
    sandbox.clock().set_paused(true); // the exact state, not a blend of two steps
    sandbox.keep_in_picture();
    const glm::vec2 size(command.size);
    sandbox.view().camera.look_through(size, {0, 0}, size, sandbox.view().aspect);
    return render_image(renderer, sandbox.draw_list(), command.size, command.samples);
}

// Steps one scene from picture to picture, with the same session and panels a user would have.
ExitCode shoot(const SnapshotCommand &command, const SceneDesc &scene, Renderer &renderer,
               ProgressLine &line, std::ostream &out, std::ostream &err) {
    line.show(0, scene.name);
    Sandbox sandbox(Session(command.run, command.tasks), command.catalogue, command.out_dir);
    // So that the panels can highlight the scene in their list.
    const auto listed = std::ranges::find(command.catalogue, scene.name, &SceneEntry::name);
    const std::filesystem::path scene_path =
        listed == command.catalogue.end() ? std::filesystem::path() : listed->path;
    if (!sandbox.open(scene, scene_path)) {
        line.clear();
        print(err, sandbox.session().messages());
        return sandbox.session().memory_ran_out() ? ExitCode::no_room : ExitCode::bad_input;
    }
    const Simulation &simulation = *sandbox.session().simulation();
    const std::uint64_t start = simulation.step_count();
    const double last = std::max(1.0, static_cast<double>(command.at.back()));
    for (const std::uint64_t step : command.at) {
        const bool steps = simulation.has_world();
        const auto done = [&] { return simulation.step_count() - start; };
        while (steps && done() < step && !InterruptGuard::requested() && sandbox.session().step())
            line.show(static_cast<double>(done()) / last, scene.name);
        if (InterruptGuard::requested())
            return ExitCode::fine;
        const bool arrived = !steps || done() == step;
        const std::filesystem::path path = picture_path(command, scene.name, steps ? done() : step);
        // Probe labels are drawn by the panel code.
        sandbox.view().panels = command.panels;
        if (command.panels || !scene.probes.empty())
            write_png(path, ui_snapshot(sandbox, renderer, command.shader_dir,
                                        {command.size, command.samples, command.ui_scale}));
        else
            write_png(path, plain_picture(command, sandbox, renderer));
        line.clear();
        out << path.string() << std::endl;
        line.show(static_cast<double>(done()) / last, scene.name);
        if (!arrived || !simulation.report().finite) {
            line.clear();
            err << scene.name << ": diverged at step " << done() << '\n';
            print(err, sandbox.session().messages());
            return ExitCode::diverged;
        }
    }
    return ExitCode::fine;
}

} // namespace

glm::ivec2 parse_size(const std::string &text) {
    glm::ivec2 size{0};
    const char *end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.x);
    if (width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x') {
        const auto height = std::from_chars(width.ptr + 1, end, size.y);
        if (height.ec == std::errc{} && height.ptr == end && size.x >= 16 && size.y >= 16 &&
            size.x <= 8192 && size.y <= 8192)
            return size;
    }
    throw std::invalid_argument("'" + text +
                                "' must be WIDTHxHEIGHT in pixels, 16 to 8192 each, as in "
                                "1280x720");
}

ExitCode make_snapshots(const SnapshotCommand &command, std::ostream &out, std::ostream &err) {
    LoadedScenes loaded = load_scenes(command.scenes, err);
    ExitCode code = loaded.all_fine ? ExitCode::fine : ExitCode::bad_input;
    if (loaded.scenes.empty())
        return code;
    std::set<std::string> names;
    for (const SceneDesc &scene : loaded.scenes)
        if (!names.insert(scene.name).second) {
            err << "two scenes are called " << scene.name << "; draw them into two folders\n";
            return ExitCode::bad_input;
        }
    const InterruptGuard interrupt;
    ContextRequest request;
    request.choice = command.gl;
    request.off_screen = true;
    request.size = command.size;
    request.visible = false;
    const ContextResult made = create_context(request);
    made.context->make_current();
    Renderer renderer(command.shader_dir);
    create_folder(command.out_dir);
    ProgressLine line(err);
    for (const SceneDesc &scene : loaded.scenes) {
        code = worse(code, shoot(command, scene, renderer, line, out, err));
        line.clear();
        if (InterruptGuard::requested()) {
            err << "interrupted; the pictures so far are complete\n";
            break;
        }
    }
    return code;
}

} // namespace plumb
