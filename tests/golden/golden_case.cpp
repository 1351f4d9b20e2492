#include "tests/golden/golden_case.h"

#include "app/render/context.h"
#include "app/render/framebuffer.h"
#include "app/render/renderer.h"
#include "app/sandbox/sandbox.h"
#include "app/sandbox/ui_snapshot.h"
#include "engine/scene/scene_file.h"

#include <filesystem>
#include <ostream>
#include <stdexcept>

namespace plumb::golden {

namespace {

namespace fs = std::filesystem;

fs::path scene_path(const std::string &scene) {
    return fs::path(PLUMB_SOURCE_DIR) / "scenes" / (scene + ".toml");
}

std::string cpu_instruction_sets() {
    std::string names;
    const auto add = [&](const char *name, bool has) {
        if (has)
            names += (names.empty() ? "" : " ") + std::string(name);
    };
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    add("sse4.1", __builtin_cpu_supports("sse4.1"));
    add("avx", __builtin_cpu_supports("avx"));
    add("fma", __builtin_cpu_supports("fma"));
    add("avx2", __builtin_cpu_supports("avx2"));
    add("avx512f", __builtin_cpu_supports("avx512f"));
#elif defined(__aarch64__)
    add("neon", true);
#endif
    return names;
}

// The sandbox a user would see after that many steps.
Sandbox sandbox_of(const Case &golden) {
    // A list of its own, so that adding a scene does not change a picture.
    std::vector<SceneEntry> list;
    for (const char *name : {"joints/heavy_chain", "joints/newtons_cradle", "joints/pendulum",
                             "stacking/pyramid", "stacking/ten_box_stack"}) {
        const fs::path path = scene_path(name);
        list.push_back({path, path.parent_path().filename().string(), path.stem().string(),
                        path.stem().string()});
    }
    Sandbox sandbox(Session(), list);
    if (!sandbox.open(scene_path(golden.scene)))
        throw std::runtime_error(golden.scene + ": " +
                                 sandbox.session().messages().all().front().text);
    for (std::uint64_t step = 0; step < golden.step; ++step)
        if (!sandbox.session().step())
            throw std::runtime_error(golden.scene + ": failed at step " + std::to_string(step));
    sandbox.view().contacts = golden.debug.contacts;
    sandbox.view().joints = golden.debug.joints;
    sandbox.view().bounds = golden.debug.bounds;
    sandbox.view().velocities = golden.debug.velocities;
    sandbox.view().wireframe = golden.debug.wireframe;
    sandbox.clock().set_paused(true); // the state itself, not a blend of two steps
    return sandbox;
}

} // namespace

const std::vector<Case> &cases() {
    static const std::vector<Case> all = [] {
        WorldDrawOptions contacts;
        contacts.contacts = contacts.bounds = true;
        WorldDrawOptions joints;
        joints.joints = joints.velocities = true;
        return std::vector<Case>{
            {"pyramid", "stacking/pyramid", 20, {}},
            {"wrecking_ball", "showcase/wrecking_ball", 40, {}},
            {"domino_run", "stacking/domino_run", 60, {}},
            {"spinning_book", "free/spinning_book", 40, {}},
            {"kepler_orbit", "free/kepler_orbit", 150, {}},
            {"bounce", "contact/bounce_half", 30, {}},
            {"slope", "contact/slope_slides", 30, {}},
            {"stack_contacts_bounds", "stacking/ten_box_stack", 10, contacts},
            {"cradle_joints_velocities", "joints/newtons_cradle", 15, joints},
            {"chain", "joints/heavy_chain", 20, {}},
            {"torn_cloth", "cloth/torn_cloth", 60, {}},
            {"tablecloth", "cloth/tablecloth", 90, {}},
            {"raycasts", "geometry/raycasts", 0, {}},
            {"manifolds", "geometry/manifolds", 0, {}},
            {"gjk_epa", "geometry/gjk_epa", 0, {}},
            {"panels", "joints/pendulum", 30, joints, true, {1000, 640}},
        };
    }();
    return all;
}

std::ostream &operator<<(std::ostream &out, const Case &golden) {
    return out << golden.name;
}

Rendering render(const Case &golden, std::optional<std::size_t> without) {
    const fs::path shaders = fs::path(PLUMB_SOURCE_DIR) / "shaders";
    const std::unique_ptr<GlContext> context = create_osmesa_context();
    Renderer renderer(shaders);
    Sandbox sandbox = sandbox_of(golden);

    Rendering result;
    result.state_hash = sandbox.session().simulation()->hash();
    result.rasterizer = {context->renderer(), context->version(), cpu_instruction_sets()};
    DrawList list = sandbox.draw_list();
    if (golden.panels) {
        result.picture = ui_snapshot(sandbox, renderer, shaders, {golden.size});
    } else {
        if (without)
            list.shapes.erase(list.shapes.begin() + static_cast<std::ptrdiff_t>(*without));
        result.picture = render_image(renderer, list, golden.size, 1);
    }
    list.shapes.clear();
    list.meshes.clear();
    list.lines.clear();
    list.points.clear();
    result.background = render_image(renderer, list, golden.size, 1);
    return result;
}

std::size_t shape_count(const Case &golden) {
    const Sandbox sandbox = sandbox_of(golden);
    const Simulation &simulation = *sandbox.session().simulation();
    if (!simulation.has_world()) // probe shapes
        return sandbox.draw_list().shapes.size();
    std::size_t count = 0; // bodies come first among the shapes
    for (std::size_t body = 0; body < simulation.body_count(); ++body)
        if (!std::holds_alternative<PlaneDesc>(simulation.body_info(body).colliders.front().shape))
            ++count;
    return count;
}

} // namespace plumb::golden
