#include "app/snapshot.h"

#include "app/lab/interrupt.h"
#include "app/lab/load_scenes.h"
#include "app/render/framebuffer.h"
#include "app/render/png.h"
#include "app/render/renderer.h"
#include "app/sandbox/sandbox.h"
#include "app/sandbox/ui_snapshot.h"
#include "app/sandbox/world_draw.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>

namespace plumb {

namespace {

std::filesystem::path picture_path(const SnapshotCommand &command, const std::string &scene,
                                   std::uint64_t step) {
    if (!command.numbered)
        return command.out_dir / (scene + ".png");
    std::string digits = std::to_string(step);
    digits.insert(0, 5 - std::min<std::size_t>(digits.size(), 5), '0');
    return command.out_dir / (scene + "-" + digits + ".png");
}

// One scene, stepped from picture to picture. The sandbox draws its panels around the same session
// that a person would have.
ExitCode shoot(const SnapshotCommand &command, const SceneDesc &scene, Renderer &renderer,
               std::ostream &out, std::ostream &err) {
    Sandbox sandbox(Session(command.run, command.tasks), command.catalogue, command.out_dir);
    // The panels mark the scene in their list.
    const auto listed = std::ranges::find(command.catalogue, scene.name, &SceneEntry::name);
    const std::filesystem::path scene_path =
        listed == command.catalogue.end() ? std::filesystem::path() : listed->path;
    if (!sandbox.open(scene, scene_path)) {
        for (const Message &message : sandbox.session().messages().all())
            err << scene.name << ": " << message.text << '\n';
        return ExitCode::bad_input;
    }
    const Simulation &simulation = *sandbox.session().simulation();
    const std::uint64_t start = simulation.step_count();
    for (const std::uint64_t step : command.at) {
        const bool steps = simulation.has_world();
        while (steps && simulation.step_count() - start < step && sandbox.session().step() &&
               !InterruptGuard::requested()) {
        }
        const bool arrived = !steps || simulation.step_count() - start == step;
        if (InterruptGuard::requested() && !arrived)
            return ExitCode::fine;
        const std::filesystem::path path =
            picture_path(command, scene.name, simulation.step_count() - start);
        // Labels of probes are drawn as panels are.
        sandbox.view().panels = command.panels;
        if (command.panels || !scene.probes.empty())
            write_png(path, ui_snapshot(sandbox, renderer, command.shader_dir, command.size,
                                        command.samples));
        else
            write_png(path, render_image(renderer, draw_world(simulation, camera_of(scene.camera)),
                                         command.size, command.samples));
        out << path.string() << std::endl;
        if (!steps)
            break; // every step looks the same
        if (!arrived || !simulation.report().finite) {
            err << scene.name << ": diverged at step " << simulation.step_count() - start << '\n';
            for (const Message &message : sandbox.session().messages().all())
                err << message.text << '\n';
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
                                "' is no picture size; WIDTHxHEIGHT in pixels, 16 to "
                                "8192 each, like 1280x720");
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
    std::error_code error;
    std::filesystem::create_directories(command.out_dir, error);
    if (error) {
        err << command.out_dir.string() << ": " << error.message() << '\n';
        return ExitCode::bad_input;
    }
    for (const SceneDesc &scene : loaded.scenes) {
        code = worse(code, shoot(command, scene, renderer, out, err));
        if (InterruptGuard::requested()) {
            err << "interrupted; the pictures so far are complete\n";
            break;
        }
    }
    return code;
}

} // namespace plumb
