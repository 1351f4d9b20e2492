// The selected body.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"
#include "engine/scene/joint_type.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <imgui/imgui.h>

namespace plumb {

namespace {

std::string triple(const glm::dvec3 &v, const char *format = "%.3f, %.3f, %.3f") {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), format, v.x, v.y, v.z);
    return text.data();
}

const char *text(BodyKind kind) {
    switch (kind) {
    case BodyKind::static_body:
        return "static";
    case BodyKind::kinematic:
        return "kinematic";
    case BodyKind::dynamic:
        return "dynamic";
    }
    return "";
}

// The rotation's angle in degrees, and its axis.
std::string turn_text(const glm::dquat &orientation) {
    const double angle = glm::degrees(glm::angle(orientation));
    std::array<char, 128> result{};
    if (!(std::abs(angle) > 0.05))
        return "none";
    const glm::dvec3 axis = glm::axis(orientation);
    std::snprintf(result.data(), result.size(), "%.1f° about %.2f, %.2f, %.2f", angle, axis.x,
                  axis.y, axis.z);
    return result.data();
}

void contact_rows(const Frame &frame, std::size_t body) {
    std::size_t points = 0;
    double force = 0;
    for (const ContactView &contact : frame.contacts) {
        if (contact.body_a == body || contact.body_b == body) {
            ++points;
            force += contact.normal_force;
        }
    }
    value_row("Contact points", std::to_string(points));
    value_row("Normal force", number(force, "N"));
}

// An angle in degrees, or a length.
std::string place(const JointView &joint, double value, const char *rate = "") {
    return joint_type(joint.type).turns ? number(glm::degrees(value), std::string("°") + rate)
                                        : number(value, std::string("m") + rate);
}

// The joint's limits, motor and current state, one row each.
void joint_rows(const JointView &joint) {
    const JointTypeInfo &type = joint_type(joint.type);
    if (joint.broken) {
        value_row("State", "broken");
        return;
    }
    if (!type.place.empty())
        value_row(type.place, place(joint, joint.position));
    if (joint.limits && (*joint.limits)[0] == (*joint.limits)[1])
        value_row("Held at", place(joint, (*joint.limits)[0]));
    else if (joint.limits)
        value_row("Limits",
                  place(joint, (*joint.limits)[0]) + " to " + place(joint, (*joint.limits)[1]));
    if (joint.motor_speed) {
        const char *unit = type.turns ? "N m" : "N";
        value_row("Motor", place(joint, *joint.motor_speed, "/s") + ", up to " +
                               number(joint.max_motor_force, unit));
        value_row("Motor output", number(joint.motor_force, unit));
        value_row("Speed", place(joint, joint.speed, "/s"));
    }
    if (joint.frequency > 0)
        value_row("Spring", number(joint.frequency, "Hz"));
    value_row("Error", number(joint.drift, "m"));
    if (joint_type(joint.type).frames != JointTypeInfo::Frames::none)
        value_row("Angle error", number(glm::degrees(joint.angle_drift), "°"));
    value_row("Force", number(glm::length(joint.force), "N") +
                           (joint.break_force > 0 ? " of " + number(joint.break_force, "N") : ""));
    if (glm::length(joint.torque) > 0)
        value_row("Torque", number(glm::length(joint.torque), "N m"));
}

// The joints that hold the body, each under its name and type.
void joints_of(const Simulation &simulation, const Frame &frame, std::size_t body) {
    constexpr std::size_t shown_at_most = 8;
    std::size_t count = 0;
    for (const JointView &joint : frame.joints) {
        if (joint.body_a != body && joint.body_b != body)
            continue;
        if (++count > shown_at_most)
            continue;
        ImGui::Separator();
        value_row(simulation.joint_name(joint.joint),
                  std::string(joint_type(joint.type).name) + " joint");
        joint_rows(joint);
    }
    if (count > shown_at_most)
        value_row("More joints", std::to_string(count - shown_at_most));
}

// Rows for all springs attached to a particle, or for a whole cloth.
template <typename Counts>
void spring_rows(const Simulation &simulation, const Frame &frame, const Counts &counts) {
    const SoftParts &parts = simulation.soft_parts();
    std::size_t count = 0;
    std::size_t torn = 0;
    double strain = 0;
    for (std::size_t i = 0; i < parts.springs.size(); ++i) {
        const SpringInfo &spring = parts.springs[i];
        if (!counts(spring))
            continue;
        ++count;
        if (frame.torn[i] != 0) {
            ++torn;
            continue;
        }
        const double length = glm::distance(place_of(spring.a, frame.bodies, frame.particles),
                                            place_of(spring.b, frame.bodies, frame.particles));
        strain = std::max(strain, std::abs(length / spring.rest_length - 1));
    }
    value_row("Springs",
              std::to_string(count) + (torn > 0 ? ", " + std::to_string(torn) + " torn" : ""));
    value_row("Largest strain", number(100 * strain, "%"));
}

void particle_rows(const PanelContext &context, std::size_t particle) {
    const Simulation &simulation = *context.session.simulation();
    const SoftParts &parts = simulation.soft_parts();
    const ParticleInfo &info = parts.particles[particle];
    const Frame &frame = context.session.present();
    const ParticleState &state = frame.particles[particle];
    value_row("Name", parts.particle_name(particle));
    value_row("Kind", info.pinned ? "particle, pinned" : "particle");
    value_row("Mass", number(info.mass, "kg"));
    value_row("Radius", number(info.radius, "m"));
    if (!info.material.empty())
        value_row("Material", info.material);
    ImGui::Separator();
    value_row("Position", triple(state.position) + " m");
    value_row("Velocity", triple(state.velocity) + " m/s");
    value_row("Speed", number(glm::length(state.velocity), "m/s"));
    ImGui::Separator();
    const auto is_end = [&](const SpringEndInfo &end) {
        return end.kind == SpringEndInfo::Kind::particle && end.index == particle;
    };
    spring_rows(simulation, frame,
                [&](const SpringInfo &spring) { return is_end(spring.a) || is_end(spring.b); });
    if (!info.cloth)
        return;
    const ClothInfo &cloth = parts.cloths[*info.cloth];
    ImGui::Separator();
    value_row("Cloth", cloth.name);
    value_row("Cloth mass", number(parts.mass_around(particle), "kg"));
    value_row("Particles", std::to_string(cloth.particle_count));
    spring_rows(simulation, frame,
                [&](const SpringInfo &spring) { return spring.cloth == info.cloth; });
}

} // namespace

void inspector_panel(PanelContext &context) {
    const Simulation *simulation = context.session.simulation();
    const std::optional<std::size_t> &body = context.view.selected;
    const std::optional<std::size_t> &particle = context.view.selected_particle;
    if (simulation && particle && *particle < context.session.present().particles.size()) {
        particle_rows(context, *particle);
        return;
    }
    if (!simulation || !body || *body >= simulation->body_count() ||
        !simulation->body_info(*body).alive) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled(
            "Click a body, a particle or a cloth to see its name, mass, position and velocity.");
        ImGui::Spacing();
        for (const MouseInfo &gesture : mouse_gestures())
            value_row(gesture.title, std::string(gesture.gesture));
        ImGui::PopTextWrapPos();
        return;
    }
    const BodyInfo &info = simulation->body_info(*body);
    const Frame frame = simulation->read({.joints = true, .contacts = true});
    const BodyState &state = frame.bodies[*body];
    value_row("Name", info.name);
    value_row("Kind", text(info.kind));
    for (const ColliderDesc &collider : info.colliders)
        value_row("Shape", summary(collider.shape));
    if (!info.material.empty())
        value_row("Material", info.material);
    if (info.kind == BodyKind::dynamic) {
        value_row("Mass", number(info.mass, "kg"));
        value_row("Inertia", triple(info.inertia, "%.3g, %.3g, %.3g") + " kg m²");
    }
    ImGui::Separator();
    value_row("Position", triple(state.position) + " m");
    value_row("Rotation", turn_text(state.orientation));
    if (info.kind == BodyKind::static_body) {
        joints_of(*simulation, frame, *body);
        return;
    }
    value_row("Velocity", triple(state.velocity) + " m/s");
    value_row("Speed", state.asleep ? "asleep" : number(glm::length(state.velocity), "m/s"));
    value_row("Spin", triple(state.angular_velocity) + " rad/s");
    if (info.force != glm::dvec3(0))
        value_row("Own force", triple(info.force) + " N");
    if (info.torque != glm::dvec3(0))
        value_row("Own torque", triple(info.torque) + " N m");
    ImGui::Separator();
    contact_rows(frame, *body);
    joints_of(*simulation, frame, *body);
}

} // namespace plumb
