#include "app/sandbox/sandbox.h"

#include "app/sandbox/draw/framing.h"
#include "app/sandbox/draw/joint_draw.h"
#include "app/sandbox/draw/probe_draw.h"
#include "app/sandbox/draw/world_draw.h"
#include "engine/dynamics/method_info.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

namespace plumb {

namespace {

// The first hit of the pointer's ray on the shapes of a picking probe.
std::optional<ProbePoint> point_at(const Session &session, const PickRay &ray) {
    for (const ProbeDesc &probe : session.probes()) {
        if (probe.question != ProbeQuestion::pick)
            continue;
        ProbeDesc asked;
        asked.shapes = probe.shapes;
        asked.ray = ProbeRayDesc{glm::dvec3(ray.origin), glm::dvec3(ray.direction), {}, {}};
        const ProbeAnswer found = answer(asked, session.simulation()->precision());
        if (found.value("hit") == 1)
            return ProbePoint{
                {found.value("x"), found.value("y"), found.value("z")},
                ProbeTone::axis,
                {found.value("normal_x"), found.value("normal_y"), found.value("normal_z")}};
    }
    return {};
}

} // namespace

Sandbox::Sandbox(Session session, std::vector<SceneEntry> scenes, std::filesystem::path out_dir)
    : session_(std::move(session)), scenes_(std::move(scenes)), out_dir_(std::move(out_dir)) {}

// Ask both to stop before the members' destructors wait for them.
Sandbox::~Sandbox() {
    chart_.stop();
    map_.stop();
}

bool Sandbox::open(const std::filesystem::path &path) {
    session_.messages().clear();
    if (!session_.open(path))
        return false;
    started(true);
    return true;
}

bool Sandbox::open(const SceneDesc &scene, const std::filesystem::path &path) {
    session_.messages().clear();
    if (!session_.open(scene, path))
        return false;
    started(true);
    return true;
}

bool Sandbox::open_recording(const std::filesystem::path &path) {
    session_.messages().clear();
    if (!session_.open_recording(path))
        return false;
    started(true);
    return true;
}

void Sandbox::started(bool another_scene) {
    tools_.let_go(session_);
    if (another_scene) {
        forget_studies();
        view_.selected.reset();
        view_.selected_particle.reset();
        view_.joints = is_about_joints(*session_.simulation());
        look_from(camera_of(session_.scene().camera));
    }
    view_.hovered.reset();
    view_.hovered_particle.reset();
    view_.hovered_handle.reset();
    view_.pointed_at.reset();
    if (another_scene)
        view_.aspect = aspect_needed(draw_list());
    clock_.give_up();
    pace_.clear();
    follow_simulation();
}

void Sandbox::forget_studies() {
    chart_.clear();
    map_.clear();
    view_.sweep_mistake.clear();
    view_.map_mistake.clear();
}

void Sandbox::follow_simulation() {
    const Simulation *simulation = session_.simulation();
    if (!simulation)
        return;
    clock_.set_dt(simulation->settings().dt);
    const auto gone = [&](const std::optional<std::size_t> &body) {
        return body && (*body >= simulation->body_count() || !simulation->body_info(*body).alive);
    };
    if (gone(view_.selected))
        view_.selected.reset();
    if (gone(view_.hovered))
        view_.hovered.reset();
    const std::size_t particles = simulation->soft_parts().particles.size();
    for (std::optional<std::size_t> *one : {&view_.selected_particle, &view_.hovered_particle})
        if (*one && **one >= particles)
            one->reset();
}

void Sandbox::perform(Action action) {
    switch (action) {
    case Action::pause:
        clock_.set_paused(!clock_.paused());
        break;
    case Action::step:
        take_steps(1);
        break;
    case Action::step_5:
        take_steps(5);
        break;
    case Action::step_back:
        take_steps_back(1);
        break;
    case Action::step_back_5:
        take_steps_back(5);
        break;
    case Action::restart:
        if (session_.restart())
            started(false);
        break;
    case Action::reload:
        reload();
        break;
    case Action::slower:
        clock_.set_speed(clock_.speed() / 2);
        break;
    case Action::faster:
        clock_.set_speed(clock_.speed() * 2);
        break;
    case Action::previous_scene:
        open_neighbour(-1);
        break;
    case Action::next_scene:
        open_neighbour(1);
        break;
    case Action::find_scene:
        view_.panels = true;
        view_.focus_search = true;
        break;
    case Action::previous_method:
        choose_neighbour_method(-1);
        break;
    case Action::next_method:
        choose_neighbour_method(1);
        break;
    case Action::toggle_contacts:
        view_.contacts = !view_.contacts;
        break;
    case Action::toggle_joints:
        view_.joints = !view_.joints;
        break;
    case Action::toggle_wireframe:
        view_.wireframe = !view_.wireframe;
        break;
    case Action::toggle_bounds:
        view_.bounds = !view_.bounds;
        break;
    case Action::toggle_velocities:
        view_.velocities = !view_.velocities;
        break;
    case Action::frame:
        frame_selection();
        break;
    case Action::home:
        if (session_.running())
            look_from(camera_of(session_.scene().camera));
        break;
    case Action::toggle_panels:
        view_.panels = !view_.panels;
        break;
    case Action::toggle_diagnostics:
        view_.diagnostics = !view_.diagnostics;
        break;
    case Action::toggle_lab:
        view_.lab = !view_.lab;
        break;
    case Action::toggle_ghost:
        toggle_ghost();
        break;
    case Action::toggle_help:
        view_.help = !view_.help;
        break;
    case Action::larger_panels:
        scale_panels(1.1f);
        break;
    case Action::smaller_panels:
        scale_panels(1 / 1.1f);
        break;
    case Action::dismiss:
        dismiss();
        break;
    case Action::screenshot:
        screenshot_ = true;
        break;
    case Action::save_scene:
        session_.save_scene(new_file(".toml"));
        break;
    case Action::quit:
        quit_ = true;
        break;
    }
}

void Sandbox::handle(const KeyEvent &event, bool in_text_field) {
    // A text field about to take the keyboard in the next frame counts as having it.
    const bool typing = in_text_field || view_.focus_search;
    if (typing && !event.chord.ctrl && event.chord.key != special_key::escape &&
        event.chord.key != special_key::f1)
        return;
    const ActionInfo *action = find_action(event.chord);
    if (!action || (event.repeat && !action->repeats))
        return;
    if (typing && action->action == Action::dismiss) {
        view_.search.clear();
        view_.focus_search = false;
        release_keyboard_ = true;
        return;
    }
    perform(action->action);
}

void Sandbox::handle(const PointerEvent &event, glm::vec2 viewport) {
    tools_.handle(event,
                  {session_, view_.camera, view_.selected, view_.selected_particle, viewport});
    // A user who pans or zooms wants to look at something else: stop following.
    if (tools_.drag() == Tools::Drag::pan ||
        (event.kind == PointerEvent::Kind::wheel && !event.over_panel)) {
        view_.follows = false;
        view_.followed = glm::vec3(0);
    }
    if (event.kind != PointerEvent::Kind::move)
        return;
    pointer_ = {event.position, viewport, event.over_panel};
    look_under_pointer();
}

void Sandbox::look_under_pointer() {
    view_.hovered.reset();
    view_.hovered_particle.reset();
    view_.pointed_at.reset();
    if (!pointer_)
        return;
    const auto &[position, viewport, over_panel] = *pointer_;
    if (tools_.drag() != Tools::Drag::probe)
        view_.hovered_handle = over_panel || tools_.drag() != Tools::Drag::none
                                   ? std::nullopt
                                   : handle_at(session_.probes(), view_.camera, position, viewport);
    if (over_panel)
        return;
    view_.pointed_at = point_at(session_, view_.camera.pick_ray(position, viewport));
    if (!view_.hovered_handle && tools_.drag() == Tools::Drag::none)
        if (const auto hit = pick(session_, view_.camera, position, viewport)) {
            view_.hovered = hit->body;
            view_.hovered_particle = hit->particle;
        }
}

void Sandbox::advance(std::int64_t nanoseconds) {
    session_.messages().grow_older(static_cast<double>(nanoseconds) * 1e-9);
    if (!session_.running() || !session_.simulation()->has_world())
        return;
    follow_simulation();
    if (clock_.paused() || session_.stopped()) {
        pace_.clear();
        session_.let_ghost_go_on();
    } else {
        const double dt = clock_.dt();
        const int taken = take_due_steps(nanoseconds);
        pace_.add(static_cast<double>(nanoseconds) * 1e-9, taken * dt);
    }
    keep_in_picture();
    look_under_pointer();
}

void Sandbox::keep_in_picture() {
    Camera &camera = view_.camera;
    camera.target -= view_.followed;
    view_.followed = glm::vec3(0);
    if (!view_.follows || !session_.running())
        return;
    const Simulation &simulation = *session_.simulation();
    std::vector<glm::vec3> moving;
    for (std::size_t body = 0; body < session_.present_bodies().size(); ++body)
        if (simulation.body_info(body).alive &&
            simulation.body_info(body).kind != BodyKind::static_body)
            moving.emplace_back(glm::mix(session_.previous_bodies()[body].position,
                                         session_.present_bodies()[body].position, clock_.alpha()));
    const std::vector<ParticleInfo> &particles = simulation.soft_parts().particles;
    const std::vector<ParticleState> shown =
        blend(session_.previous_particles(), session_.present().particles, clock_.alpha());
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (!particles[i].pinned)
            moving.emplace_back(shown[i].position);
    view_.followed = shift_to_see(camera, view_.aspect, moving);
    camera.target += view_.followed;
}

int Sandbox::take_due_steps(std::int64_t nanoseconds) {
    const int due = clock_.advance(nanoseconds);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < due; ++i) {
        if (!session_.step()) {
            clock_.set_paused(true);
            return i;
        }
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        if (taken.count() > step_budget && i + 1 < due) {
            clock_.give_up();
            return i + 1;
        }
    }
    return due;
}

void Sandbox::take_steps(int count) {
    if (session_.running() && !session_.simulation()->has_world()) {
        session_.messages().note("This scene has only probes: there is no world to step.");
        return;
    }
    clock_.set_paused(true);
    for (int i = 0; i < count; ++i)
        if (!session_.step())
            return;
}

void Sandbox::take_steps_back(int count) {
    clock_.set_paused(true);
    for (int i = 0; i < count; ++i)
        if (!session_.step_back())
            break;
    follow_simulation();
}

void Sandbox::reload() {
    // The selected body is found again by name.
    std::string name;
    if (view_.selected)
        name = session_.simulation()->body_info(*view_.selected).name;
    session_.messages().clear();
    if (!session_.reload())
        return;
    forget_studies(); // the file may have changed
    view_.selected = name.empty() ? std::nullopt : session_.simulation()->find_body(name);
    started(false);
}

void Sandbox::open_neighbour(int direction) {
    const auto count = static_cast<int>(scenes_.size());
    if (count == 0)
        return;
    int now = direction > 0 ? -1 : count; // no listed scene is open: start at the end
    for (int i = 0; i < count; ++i)
        if (scenes_[static_cast<std::size_t>(i)].path == session_.path())
            now = i;
    open(scenes_[static_cast<std::size_t>((now + direction + count) % count)].path);
}

void Sandbox::choose_neighbour_method(int direction) {
    if (!session_.running())
        return;
    std::vector<std::string_view> able;
    std::size_t now = 0;
    for (const MethodInfo &method : method_infos()) {
        if (!why_not(method, session_.scene()).empty())
            continue;
        if (method.name == session_.simulation()->method().name)
            now = able.size();
        able.push_back(method.name);
    }
    if (able.size() < 2) {
        session_.messages().note("No other method can run this scene.");
        return;
    }
    session_.set_method(
        able[direction > 0 ? (now + 1) % able.size() : (now + able.size() - 1) % able.size()]);
}

// Uses the method last chosen, else the next that can run the scene.
void Sandbox::toggle_ghost() {
    if (session_.ghost() || !session_.running()) {
        session_.set_ghost("");
        return;
    }
    const auto is_able = [&](const MethodInfo &method) {
        return why_not(method, session_.scene()).empty();
    };
    std::string method = view_.ghost_method;
    if (method.empty() || (method != reference_ghost && !is_able(*find_method_info(method)))) {
        const auto other = std::ranges::find_if(method_infos(), [&](const MethodInfo &info) {
            return info.name != session_.simulation()->method().name && is_able(info);
        });
        method = other == method_infos().end() ? std::string() : std::string(other->name);
    }
    if (method.empty())
        session_.messages().note("No other method can run this scene.");
    else if (session_.set_ghost(method))
        view_.ghost_method = method;
}

void Sandbox::go_on_with(const RunChoice &choice) {
    if (choice.scene) {
        if (!session_.open(*choice.scene, session_.path(), choice.text))
            return;
        chart_.clear(); // it showed the old scene
        started(false);
    }
    if (choice.method != session_.simulation()->method().name &&
        !session_.set_method(choice.method))
        return;
    if (session_.set_settings(choice.settings) && choice.failure)
        session_.note_outcome(*choice.failure);
}

void Sandbox::scale_panels(float factor) {
    // Whole steps, so that equally many up and down return exactly to the start.
    constexpr float steps = 8;
    const float now = std::round(std::log(view_.ui_scale * factor) / std::log(1.1f));
    view_.ui_scale = std::pow(1.1f, std::clamp(now, -steps, steps));
}

void Sandbox::look_from(Camera camera) {
    camera.centre = view_.camera.centre;
    camera.share = view_.camera.share;
    view_.camera = camera;
    view_.follows = true;
    view_.followed = glm::vec3(0);
}

void Sandbox::frame_selection() {
    if (!session_.running())
        return;
    Around sphere = session_.simulation()->has_world()
                        ? around(*session_.simulation(), view_.selected)
                        : around(session_.answers());
    if (view_.selected_particle) {
        sphere.centre = glm::vec3(session_.present().particles[*view_.selected_particle].position);
        sphere.radius =
            5 * static_cast<float>(
                    session_.simulation()->soft_parts().particles[*view_.selected_particle].radius);
    }
    // Leave a body's own width free on each side, so that one sees where it is.
    Camera camera = view_.camera;
    const bool is_one = view_.selected || view_.selected_particle;
    camera.frame(sphere.centre, sphere.radius, is_one ? 1.0f / 3 : 0.9f);
    look_from(camera);
}

void Sandbox::dismiss() {
    if (view_.help)
        view_.help = false;
    else if (!view_.search.empty())
        view_.search.clear();
    else if (!session_.messages().empty())
        session_.messages().clear();
    else if (!session_.let_go()) {
        view_.selected.reset();
        view_.selected_particle.reset();
    }
}

PanelContext Sandbox::panel_context(const Fonts &fonts, bool frozen) {
    follow_simulation();
    return PanelContext{session_, view_, clock_, pace_, scenes_, chart_, map_,  fonts,
                        frozen,   0,     {},     {},    {},      false,  false, {}};
}

void Sandbox::take(const PanelContext &context) {
    for (const Action action : context.actions)
        perform(action);
    if (context.speed)
        clock_.set_speed(*context.speed);
    if (context.restart_as_written && session_.restart_as_written())
        started(false);
    if (context.save_plots)
        session_.save_plots(new_file(".csv"));
    if (context.run)
        go_on_with(*context.run);
    if (context.open_scene)
        open(*context.open_scene);
    follow_simulation();
}

DrawList Sandbox::draw_list() const {
    if (!session_.running()) {
        DrawList empty;
        empty.camera = view_.camera;
        return empty;
    }
    WorldDrawOptions options;
    options.contacts = view_.contacts;
    options.joints = view_.joints;
    options.bounds = view_.bounds;
    options.velocities = view_.velocities;
    options.wireframe = view_.wireframe;
    options.selected = view_.selected;
    options.hovered = view_.hovered;
    options.selected_particle = view_.selected_particle;
    options.hovered_particle = view_.hovered_particle;
    options.grab = session_.held();
    options.impacts = session_.impacts();
    DrawList list = draw_world(
        *session_.simulation(), view_.camera, options,
        blend(session_.previous_bodies(), session_.present_bodies(), clock_.alpha()),
        blend(session_.previous_particles(), session_.present().particles, clock_.alpha()));
    if (const Ghost *ghost = session_.ghost(); ghost && ghost->failure().empty())
        add_ghost(list, ghost->simulation(),
                  blend(ghost->previous().bodies, ghost->present().bodies, clock_.alpha()),
                  blend(ghost->previous().particles, ghost->present().particles, clock_.alpha()));
    draw_probes(list, session_.probes(), session_.answers(), view_.hovered_handle,
                !session_.simulation()->has_world());
    if (session_.simulation()->has_world())
        if (const auto plane = plane_behind(session_.scene()))
            list.planes.push_back(*plane);
    if (view_.pointed_at)
        draw_point(list, *view_.pointed_at);
    return list;
}

std::string Sandbox::title() const {
    if (!session_.running())
        return "Plumb";
    if (!session_.simulation()->has_world())
        return session_.scene().name + " - probes - Plumb";
    return session_.scene().name + " - " +
           (session_.stopped() ? "stopped"
            : clock_.paused()  ? "paused"
                               : "running") +
           " - step " + std::to_string(session_.simulation()->step_count()) + " - Plumb";
}

std::filesystem::path Sandbox::new_file(const std::string &extension) const {
    std::string stem = "plumb";
    if (session_.running())
        stem = session_.scene().name + "-" + std::to_string(session_.simulation()->step_count());
    std::filesystem::path path = out_dir_ / (stem + extension);
    std::error_code error; // a failed check counts as absent: writing will report why
    for (int i = 2; std::filesystem::exists(path, error); ++i)
        path = out_dir_ / std::string(stem).append("-").append(std::to_string(i)).append(extension);
    return path;
}

bool Sandbox::take_screenshot_request() {
    return std::exchange(screenshot_, false);
}
bool Sandbox::take_keyboard_release() {
    return std::exchange(release_keyboard_, false);
}

} // namespace plumb
