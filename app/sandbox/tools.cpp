#include "app/sandbox/tools.h"

#include "app/sandbox/draw/probe_draw.h"
#include "app/sandbox/draw/soft_draw.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb {

std::optional<Picked> pick(const Session &session, const Camera &camera, const glm::vec2 &pixel,
                           const glm::vec2 &viewport) {
    if (!session.running())
        return {};
    const PickRay ray = camera.pick_ray(pixel, viewport);
    const glm::dvec3 origin(ray.origin);
    const glm::dvec3 direction(ray.direction);
    const std::optional<Pick> body = session.simulation()->pick(origin, direction);
    std::optional<ParticlePick> particle;
    if (const Frame &frame = session.present(); !frame.particles.empty()) {
        const double a_pixel = 2.0 * static_cast<double>(camera.half_height() / viewport.y);
        particle = pick_particle(
            {session.simulation()->soft_parts(), frame.bodies, frame.particles, frame.torn}, origin,
            glm::normalize(direction), Tools::click_slack * a_pixel);
    }
    const double to_body = body ? body->t * glm::length(direction) : 0;
    if (particle && (!body || particle->t < to_body))
        return Picked{std::nullopt, particle->particle, particle->point};
    if (body)
        return Picked{body->body, std::nullopt, body->point};
    return std::nullopt;
}

void Tools::handle(const PointerEvent &event, const ToolTargets &targets) {
    switch (event.kind) {
    case PointerEvent::Kind::press:
        if (!event.over_panel && drag_ == Drag::none)
            press(event, targets);
        return;
    case PointerEvent::Kind::move:
        move(event, targets);
        return;
    case PointerEvent::Kind::release:
        if (drag_ != Drag::none && event.button == button_)
            release(event, targets);
        return;
    case PointerEvent::Kind::wheel:
        if (!event.over_panel)
            targets.camera.zoom(event.notches);
        return;
    }
}

void Tools::let_go(Session &session) {
    session.grab({});
    drag_ = Drag::none;
}

void Tools::press(const PointerEvent &event, const ToolTargets &targets) {
    button_ = event.button;
    pressed_at_ = last_ = event.position;
    if (event.button != PointerButton::left)
        drag_ = Drag::pan;
    else if (event.ctrl)
        begin_grab(event, targets);
    else if (event.shift)
        shoot(event, targets);
    else if (!begin_probe(event, targets))
        drag_ = Drag::maybe_click;
}

std::optional<glm::dvec3> Tools::place_in_plane(const glm::vec2 &pixel,
                                                const ToolTargets &targets) const {
    const PickRay ray = targets.camera.pick_ray(pixel, targets.viewport);
    const glm::dvec3 origin(ray.origin);
    const glm::dvec3 direction(ray.direction);
    const double facing = glm::dot(direction, grab_normal_);
    // The plane faces the camera, so the ray meets it in front unless the view is extreme.
    if (std::abs(facing) <= 1e-3)
        return {};
    const double t = glm::dot(grab_point_ - origin, grab_normal_) / facing;
    return t > 0 ? std::optional(origin + direction * t) : std::nullopt;
}

bool Tools::begin_probe(const PointerEvent &event, const ToolTargets &targets) {
    const std::vector<ProbeDesc> &probes = targets.session.probes();
    const std::optional<ProbeHandle> handle =
        handle_at(probes, targets.camera, event.position, targets.viewport);
    if (!handle)
        return false;
    const ProbeDesc &probe = probes[handle->probe];
    handle_ = *handle;
    grab_point_ = probe_handles(probe)[handle->handle];
    grab_normal_ = is_flat(probe) ? glm::dvec3(0, 0, 1) : -glm::dvec3(targets.camera.forward());
    drag_ = Drag::probe;
    return true;
}

void Tools::move(const PointerEvent &event, const ToolTargets &targets) {
    const glm::vec2 delta = event.position - last_;
    switch (drag_) {
    case Drag::none:
        break;
    case Drag::maybe_click:
        // The camera waits until this is clearly not a click, then catches up with the pointer.
        if (glm::distance(event.position, pressed_at_) <= click_slack)
            return;
        drag_ = Drag::orbit;
        targets.camera.orbit(delta, targets.viewport.y);
        break;
    case Drag::orbit:
        targets.camera.orbit(delta, targets.viewport.y);
        break;
    case Drag::pan:
        targets.camera.pan(delta, targets.viewport.y);
        break;
    case Drag::grab:
        if (std::optional<GrabView> grab = targets.session.grabbed()) {
            if (const std::optional<glm::dvec3> place = place_in_plane(event.position, targets)) {
                grab->target = *place;
                targets.session.grab(grab);
            }
        } else {
            drag_ = Drag::none; // the session has let go: a restart or step back
        }
        break;
    case Drag::probe:
        if (const std::optional<glm::dvec3> place = place_in_plane(event.position, targets))
            targets.session.move_probe(handle_.probe, handle_.handle, *place);
        break;
    }
    last_ = event.position;
}

void Tools::release(const PointerEvent &event, const ToolTargets &targets) {
    if (drag_ == Drag::grab)
        targets.session.grab({});
    // A release over a panel is not a click on the scene.
    if (drag_ == Drag::maybe_click && !event.over_panel) {
        const Picked hit =
            pick(targets.session, targets.camera, pressed_at_, targets.viewport).value_or(Picked{});
        targets.selected = hit.body;
        targets.selected_particle = hit.particle;
    }
    drag_ = Drag::none;
}

void Tools::begin_grab(const PointerEvent &event, const ToolTargets &targets) {
    const Simulation *simulation = targets.session.simulation();
    const Picked hit =
        pick(targets.session, targets.camera, event.position, targets.viewport).value_or(Picked{});
    GrabView grab;
    grab.target = hit.point;
    if (hit.particle && !simulation->soft_parts().particles[*hit.particle].pinned) {
        grab.particle = hit.particle;
        grab.max_force = grab_strength * simulation->soft_parts().mass_around(*hit.particle);
    } else if (hit.body && simulation->body_info(*hit.body).kind == BodyKind::dynamic) {
        const BodyState state = simulation->read().bodies[*hit.body];
        grab.body = *hit.body;
        grab.local_point = glm::conjugate(state.orientation) * (hit.point - state.position);
        grab.max_force = grab_strength * simulation->body_info(*hit.body).mass;
    } else {
        drag_ = Drag::orbit;
        return;
    }
    grab_point_ = hit.point;
    grab_normal_ = -glm::dvec3(targets.camera.forward());
    targets.session.grab(grab);
    targets.selected = hit.body;
    targets.selected_particle = hit.particle;
    drag_ = Drag::grab;
}

void Tools::shoot(const PointerEvent &event, const ToolTargets &targets) const {
    const PickRay ray = targets.camera.pick_ray(event.position, targets.viewport);
    // The ball looks equally large at any camera distance, and starts far enough ahead not to fill
    // the view.
    const double radius =
        std::clamp(0.02 * static_cast<double>(targets.camera.distance), 0.05, 1.0);
    const glm::dvec3 from = glm::dvec3(ray.origin) + glm::dvec3(ray.direction) * (4 * radius);
    targets.session.shoot(from, glm::dvec3(ray.direction) * shot_speed, radius);
}

} // namespace plumb
