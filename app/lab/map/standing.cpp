#include "app/lab/map/standing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace plumb {

namespace {

// In widths of a body: how far within the outline its centre of mass must be, how far outside it a
// load may be, and how far bodies may be apart, or overlap, and still touch.
constexpr double within = 0.05, outside = 1e-3, apart = 0.01;
constexpr double upright = 0.999; // a contact normal's vertical part

bool is_still(const BodyDesc &body) {
    return body.velocity == glm::dvec3(0) && body.angular_velocity == glm::dvec3(0);
}

// Whether nothing acts but weight and contacts.
bool is_mere_pile(const SceneDesc &scene, const glm::dvec3 &gravity) {
    return gravity.x == 0 && gravity.z == 0 && gravity.y < 0 && scene.joints.empty() &&
           scene.attractors.empty() && scene.particles.empty() && scene.springs.empty() &&
           scene.cloths.empty() && !scene.grab &&
           std::ranges::all_of(scene.bodies, [](const BodyDesc &body) {
               return is_still(body) &&
                      (body.kind != BodyKind::dynamic ||
                       (body.gravity_scale > 0 && std::isfinite(smallest_width(body))));
           });
}

// The scene's contacts as it starts, by a step too short to move anything.
std::vector<ContactView> contacts_at_start(const SceneDesc &scene) {
    RunOptions options;
    options.method = "soft_step";
    options.settings.give(&StepSettings::dt, 1e-5);
    options.precision = Precision::f64;
    const auto simulation = Simulation::create(scene, options, nullptr);
    simulation->step();
    Frame frame;
    simulation->read(frame, {.contacts = true});
    return frame.contacts;
}

double cross(const glm::dvec2 &a, const glm::dvec2 &b) {
    return a.x * b.y - a.y * b.x;
}

// Counterclockwise; without points on its edges.
std::vector<glm::dvec2> outline(std::vector<glm::dvec2> points) {
    std::ranges::sort(points, [](const glm::dvec2 &a, const glm::dvec2 &b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    std::vector<glm::dvec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t begin = hull.size();
        for (const glm::dvec2 &point : points) {
            while (hull.size() >= begin + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back(); // the other side begins with it
        std::ranges::reverse(points);
    }
    return hull;
}

// How far within; negative outside, and for an outline without an area.
double depth_within(const std::vector<glm::dvec2> &hull, const glm::dvec2 &point) {
    if (hull.size() < 3)
        return -std::numeric_limits<double>::infinity();
    double depth = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        depth = std::min(depth, cross(edge, point - hull[i]) / glm::length(edge));
    }
    return depth;
}

struct Touched {
    std::vector<glm::dvec2> below, above; // contact points, from the top
    std::vector<std::size_t> on;
};

} // namespace

StandingWatch::StandingWatch(const SceneDesc &scene, const Simulation &simulation) {
    if (!is_mere_pile(scene, simulation.settings().gravity))
        return;
    const Frame frame = simulation.read();
    for (const BodyState &state : frame.bodies)
        heights_.push_back(state.position.y);
    std::map<std::size_t, double> widths; // of the moving bodies
    for (const BodyDesc &body : scene.bodies)
        if (body.kind == BodyKind::dynamic)
            widths[simulation.find_body(body.name).value()] = smallest_width(body);

    std::map<std::size_t, Touched> touched;
    for (const ContactView &contact : contacts_at_start(scene)) {
        if (contact.is_sensor)
            continue;
        const bool a_moves = widths.contains(contact.body_a);
        const double width =
            std::min(a_moves ? widths[contact.body_a] : std::numeric_limits<double>::infinity(),
                     widths.contains(contact.body_b) ? widths[contact.body_b]
                                                     : std::numeric_limits<double>::infinity());
        if (contact.separation > apart * width)
            continue;
        if (contact.separation < -apart * width)
            return; // they will be pushed apart
        if (std::abs(contact.normal.y) < upright)
            continue; // beside each other: no force is needed there
        const bool b_is_above = contact.normal.y > 0;
        const std::size_t upper = b_is_above ? contact.body_b : contact.body_a;
        const std::size_t lower = b_is_above ? contact.body_a : contact.body_b;
        const glm::dvec2 point(contact.position.x, contact.position.z);
        touched[upper].below.push_back(point);
        touched[upper].on.push_back(lower);
        touched[lower].above.push_back(point);
    }
    std::vector<Standing> standing;
    for (const auto &each : widths) {
        const std::size_t body = each.first;
        const double width = each.second;
        Touched &own = touched[body];
        if (own.below.empty())
            return;
        const std::vector<glm::dvec2> hull = outline(own.below);
        const glm::dvec3 &center = frame.bodies[body].position;
        if (depth_within(hull, {center.x, center.z}) < within * width ||
            !std::ranges::all_of(own.above, [&](const glm::dvec2 &load) {
                return depth_within(hull, load) >= -outside * width;
            }))
            return;
        standing.push_back({body, width, std::move(own.on)});
    }
    standing_ = std::move(standing);
}

std::string StandingWatch::fallen(const Simulation &simulation) const {
    const Frame frame = simulation.read();
    const auto drop = [&](std::size_t body) {
        return heights_[body] - frame.bodies[body].position.y;
    };
    for (const Standing &each : standing_) {
        double below = 0;
        for (const std::size_t body : each.on)
            below = std::max(below, drop(body));
        if (drop(each.body) - below > 0.5 * each.width)
            return simulation.body_info(each.body).name;
    }
    return {};
}

} // namespace plumb
