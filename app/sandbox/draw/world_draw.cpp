#include "app/sandbox/draw/world_draw.h"

#include "app/render/palette.h"
#include "app/sandbox/draw/joint_draw.h"
#include "app/sandbox/draw/shape_draw.h"
#include "app/sandbox/draw/soft_draw.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb {

namespace {

// Radius of a bounding sphere about the body's origin; 0 for a plane.
double reach(const BodyInfo &body) {
    double far = 0;
    for (const ColliderDesc &collider : body.colliders)
        far = std::max(far, glm::length(collider.position) + reach(collider.shape));
    return far;
}

bool is_plane(const ShapeDesc &shape) {
    return std::holds_alternative<PlaneDesc>(shape);
}

glm::vec3 colour_of(const BodyInfo &body, std::size_t index) {
    if (body.colour)
        return *body.colour;
    switch (body.kind) {
    case BodyKind::static_body:
        return colours::static_body;
    case BodyKind::kinematic:
        return colours::kinematic;
    case BodyKind::dynamic:
        break;
    }
    return palette_colour(index);
}

void add_body(DrawList &list, const BodyInfo &body, const BodyState &pose, std::size_t index,
              const WorldDrawOptions &options) {
    ShapeStyle style;
    style.colour = colour_of(body, index);
    style.selected = options.selected == index;
    style.highlighted = options.hovered == index;
    for (const ColliderDesc &collider : body.colliders)
        draw_shape(list, collider.shape, pose.position + pose.orientation * collider.position,
                   pose.orientation * collider.orientation, style);
}

void add_line(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, const glm::vec3 &colour,
              float width = 2) {
    list.lines.push_back({glm::vec3(a), glm::vec3(b), colour, width});
}

// The arrow's head takes an eighth of its length.
void add_arrow(DrawList &list, const glm::dvec3 &from, const glm::dvec3 &vector,
               const glm::vec3 &colour) {
    const double length = glm::length(vector);
    if (!(length > 1e-6) || !std::isfinite(length))
        return;
    const glm::dvec3 to = from + vector;
    add_line(list, from, to, colour);
    const glm::dvec3 along = vector / length;
    const glm::dvec3 other = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 aside = glm::normalize(glm::cross(along, other)) * (0.06 * length);
    const glm::dvec3 back = to - along * (0.125 * length);
    add_line(list, to, back + aside, colour);
    add_line(list, to, back - aside, colour);
}

// A contact moves with its bodies but does not turn with them: under a rolling ball it stays at the
// bottom.
glm::dvec3 contact_place(const Simulation &simulation, const Frame &frame,
                         const std::vector<BodyState> &poses, const ContactView &contact) {
    glm::dvec3 shift(0);
    double moving = 0;
    for (const std::size_t body : {contact.body_a, contact.body_b}) {
        if (body >= poses.size() || simulation.body_info(body).kind == BodyKind::static_body)
            continue;
        shift += poses[body].position - frame.bodies[body].position;
        moving += 1;
    }
    return moving > 0 ? contact.position + shift / moving : contact.position;
}

void add_contacts(DrawList &list, const Simulation &simulation, const Frame &frame,
                  const std::vector<BodyState> &poses, double weight) {
    for (const ContactView &contact : frame.contacts) {
        const glm::dvec3 place = contact_place(simulation, frame, poses, contact);
        // The stalk is 0.38 m long for the weight of the median body. It grows with the square root
        // of the force, so that light and heavy contacts both show.
        const double force = weight > 0 ? std::max(0.0, contact.normal_force) / weight : 0;
        const double length = std::min(2.0, 0.08 + 0.3 * std::sqrt(force));
        DrawPoint point;
        point.position = glm::vec3(place);
        point.normal = glm::vec3(contact.normal * length);
        point.colour =
            contact.normal_force > 0 ? colours::contact : colours::contact * 0.6f + 0.35f;
        list.points.push_back(point);
        const double friction = glm::length(contact.friction_force);
        if (weight > 0 && friction > 0)
            add_arrow(list, place,
                      contact.friction_force / friction *
                          std::min(2.0, 0.3 * std::sqrt(friction / weight)),
                      colours::kinematic);
    }
}

// A ring at the impact, normal to it, that shrinks with age. Its radius grows with the square root
// of the speed change the impulse would give the median body: 20 cm for 1 m/s.
void add_impacts(DrawList &list, const std::vector<SeenImpact> &impacts, double mass) {
    constexpr int corners = 16;
    for (const SeenImpact &seen : impacts) {
        const ImpactView &impact = seen.impact;
        const double left = 1 - seen.age / Session::impact_shown;
        const double radius = left * std::min(2.0, 0.2 * std::sqrt(impact.impulse / mass));
        if (!(radius > 1e-6) || !std::isfinite(radius))
            continue;
        const glm::dvec3 other =
            std::abs(impact.normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(impact.normal, other));
        const glm::dvec3 v = glm::cross(impact.normal, u);
        const auto corner = [&](int k) {
            const double angle = 2 * std::numbers::pi * k / corners;
            return impact.position + radius * (std::cos(angle) * u + std::sin(angle) * v);
        };
        for (int k = 0; k < corners; ++k)
            add_line(list, corner(k), corner(k + 1), colours::impact, 2);
        add_line(list, impact.position - radius * impact.normal,
                 impact.position + radius * impact.normal, colours::impact, 2);
    }
}

void add_bounds(DrawList &list, const BodyInfo &body, const BodyState &pose) {
    glm::dvec3 min(std::numeric_limits<double>::infinity());
    glm::dvec3 max = -min;
    for (const ColliderDesc &collider : body.colliders) {
        if (is_plane(collider.shape))
            return;
        const BoundsDesc box =
            bounds(collider.shape, pose.position + pose.orientation * collider.position,
                   pose.orientation * collider.orientation);
        min = glm::min(min, box.min);
        max = glm::max(max, box.max);
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
            glm::dvec3 a = min;
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            a[u] = (corner & 1) != 0 ? max[u] : min[u];
            a[v] = (corner & 2) != 0 ? max[v] : min[v];
            glm::dvec3 b = a;
            b[axis] = max[axis];
            add_line(list, a, b, colours::bounds, 1);
        }
    }
}

// Mass of the median dynamic body, kg; 0 if there is none.
double typical_mass(const Simulation &simulation) {
    std::vector<double> masses;
    for (std::size_t body = 0; body < simulation.body_count(); ++body) {
        const BodyInfo &info = simulation.body_info(body);
        if (info.alive && info.kind == BodyKind::dynamic)
            masses.push_back(info.mass);
    }
    if (masses.empty())
        return 0;
    const auto middle = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
    std::nth_element(masses.begin(), middle, masses.end());
    return *middle;
}

// The grabbed point; nullopt if the grabbed body or particle does not exist.
std::optional<glm::dvec3> held_place(const GrabView &grab, const std::vector<BodyState> &bodies,
                                     const std::vector<ParticleState> &particles) {
    if (grab.particle)
        return *grab.particle < particles.size() ? std::optional(particles[*grab.particle].position)
                                                 : std::nullopt;
    if (grab.body >= bodies.size())
        return std::nullopt;
    const BodyState &pose = bodies[grab.body];
    return pose.position + pose.orientation * grab.local_point;
}

void add_joints(DrawList &list, const Simulation &simulation, const Frame &frame,
                const std::vector<BodyState> &poses, bool all, double weight) {
    const std::vector<JointView> joints = joints_at(frame, poses);
    if (joints.empty())
        return;
    std::vector<double> reaches;
    for (std::size_t body = 0; body < simulation.body_count(); ++body)
        reaches.push_back(reach(simulation.body_info(body)));
    const JointSurroundings surroundings{poses, reaches, simulation.settings().gravity, weight};
    draw_links(list, joints, surroundings);
    if (all)
        draw_joints(list, joints, surroundings);
}

} // namespace

Camera camera_of(const CameraDesc &camera) {
    Camera result;
    result.target = glm::vec3(camera.target);
    result.distance = static_cast<float>(camera.distance);
    result.yaw = static_cast<float>(camera.yaw);
    result.pitch = static_cast<float>(camera.pitch);
    result.fov = static_cast<float>(camera.fov);
    return result;
}

DrawList draw_world(const Simulation &simulation, const Camera &camera,
                    const WorldDrawOptions &options, const std::vector<BodyState> &poses,
                    const std::vector<ParticleState> &particles) {
    DrawList list;
    list.camera = camera;
    list.view.wireframe = options.wireframe;
    list.view.shadows = options.shadows;
    list.view.grid = options.grid;
    const Frame frame = simulation.read({.joints = true, .contacts = options.contacts});
    const std::vector<BodyState> &shown =
        poses.size() == frame.bodies.size() ? poses : frame.bodies;
    for (std::size_t body = 0; body < shown.size(); ++body)
        if (simulation.body_info(body).alive)
            add_body(list, simulation.body_info(body), shown[body], body, options);
    const std::vector<ParticleState> &shown_particles =
        particles.size() == frame.particles.size() ? particles : frame.particles;
    draw_soft_parts(list, {simulation.soft_parts(), shown, shown_particles, frame.torn},
                    options.selected_particle, options.hovered_particle);
    for (const AttractorDesc &attractor : simulation.attractors()) {
        DrawShape ball;
        ball.position = glm::vec3(attractor.position);
        ball.size = glm::vec3(static_cast<float>(attractor.radius));
        ball.colour = colours::static_body;
        list.shapes.push_back(ball);
    }
    const double mass = options.contacts || options.joints ? typical_mass(simulation) : 0;
    const double weight = mass * glm::length(simulation.settings().gravity);
    add_joints(list, simulation, frame, shown, options.joints, weight);
    if (options.contacts) {
        add_contacts(list, simulation, frame, shown, weight);
        add_impacts(list, options.impacts, mass);
    }
    if (options.bounds)
        for (std::size_t body = 0; body < shown.size(); ++body)
            if (simulation.body_info(body).alive)
                add_bounds(list, simulation.body_info(body), shown[body]);
    if (options.velocities)
        for (std::size_t body = 0; body < shown.size(); ++body)
            if (simulation.body_info(body).alive &&
                simulation.body_info(body).kind != BodyKind::static_body)
                // The distance travelled in a quarter of a second.
                add_arrow(list, shown[body].position, frame.bodies[body].velocity * 0.25,
                          colours::ink);
    const auto held = options.grab ? held_place(*options.grab, shown, shown_particles)
                                   : std::optional<glm::dvec3>{};
    if (held) {
        add_line(list, *held, options.grab->target, colours::grab, 2);
        DrawPoint point;
        point.position = glm::vec3(options.grab->target);
        point.colour = colours::grab;
        list.points.push_back(point);
    }
    return list;
}

void add_ghost(DrawList &list, const Simulation &simulation, const std::vector<BodyState> &poses,
               const std::vector<ParticleState> &particles) {
    DrawList ghost;
    for (std::size_t body = 0; body < poses.size(); ++body)
        if (simulation.body_info(body).alive &&
            simulation.body_info(body).kind != BodyKind::static_body)
            add_body(ghost, simulation.body_info(body), poses[body], body, {});
    const Frame frame = simulation.read();
    draw_soft_parts(ghost, {simulation.soft_parts(), poses, particles, frame.torn}, {}, {});
    const auto pale = [](const glm::vec3 &colour) {
        return glm::mix(colour, colours::ghost, 0.6f);
    };
    for (DrawShape shape : ghost.shapes) {
        shape.glass = true;
        shape.colour = pale(shape.colour);
        list.shapes.push_back(shape);
    }
    for (DrawMesh mesh : ghost.meshes) {
        mesh.glass = true;
        mesh.colour = pale(mesh.colour);
        list.meshes.push_back(std::move(mesh));
    }
    for (DrawLine line : ghost.lines) {
        line.colour = pale(line.colour);
        list.lines.push_back(line);
    }
}

Around around(const Simulation &simulation, std::optional<std::size_t> body) {
    const Frame frame = simulation.read();
    if (body && *body < simulation.body_count() && simulation.body_info(*body).alive) {
        const double radius = reach(simulation.body_info(*body));
        return {glm::vec3(frame.bodies[*body].position),
                radius > 0 ? static_cast<float>(radius) : 5.0f};
    }
    // A floor may be far larger than what stands on it, so static bodies only count if nothing
    // moves.
    for (const bool static_too : {false, true}) {
        glm::dvec3 low(std::numeric_limits<double>::max());
        glm::dvec3 high(std::numeric_limits<double>::lowest());
        for (std::size_t i = 0; i < simulation.body_count(); ++i) {
            const BodyInfo &info = simulation.body_info(i);
            const glm::dvec3 at = frame.bodies[i].position;
            if (!info.alive ||
                std::ranges::any_of(info.colliders, is_plane, &ColliderDesc::shape) ||
                !std::isfinite(at.x + at.y + at.z) ||
                (info.kind == BodyKind::static_body && !static_too))
                continue;
            low = glm::min(low, at - reach(info));
            high = glm::max(high, at + reach(info));
        }
        for (std::size_t i = 0; i < frame.particles.size(); ++i) {
            const ParticleInfo &info = simulation.soft_parts().particles[i];
            const glm::dvec3 at = frame.particles[i].position;
            if (!std::isfinite(at.x + at.y + at.z))
                continue;
            low = glm::min(low, at - info.radius);
            high = glm::max(high, at + info.radius);
        }
        if (low.x <= high.x)
            return {glm::vec3((low + high) * 0.5),
                    static_cast<float>(glm::length(high - low) * 0.5)};
    }
    return {};
}

} // namespace plumb
