#include "app/sandbox/draw/joint_draw.h"

#include "app/render/palette.h"
#include "engine/scene/joint_type.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb {

namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double wire_share = 0.006; // wire radius / length

void add_line(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, float width = 2,
              const glm::vec3 &colour = colours::joint) {
    list.lines.push_back({glm::vec3(a), glm::vec3(b), colour, width});
}

void add_dot(DrawList &list, const glm::dvec3 &at, const glm::vec3 &colour = colours::joint) {
    DrawPoint point;
    point.position = glm::vec3(at);
    point.colour = colour;
    list.points.push_back(point);
}

// The shortest rotation from +y to a unit direction that does not point down. Near -y the angle
// approaches pi and this formula cancels; callers flip the direction, as a rod looks the same from
// either end.
glm::dquat turn_from_up(const glm::dvec3 &direction) {
    return glm::normalize(glm::dquat(1 + direction.y, direction.z, 0, -direction.x));
}

// A segment of a rod, rope or wire.
void add_capsule(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double radius) {
    const double length = glm::distance(a, b);
    if (!(length > 0) || !std::isfinite(length))
        return;
    DrawShape piece;
    piece.kind = DrawKind::capsule;
    piece.position = glm::vec3(0.5 * (a + b));
    const glm::dvec3 along = (b - a) / length;
    piece.rotation = glm::quat(turn_from_up(along.y < 0 ? -along : along));
    piece.size = glm::vec3(radius, 0.5 * length, 0);
    piece.colour = colours::rod;
    list.shapes.push_back(piece);
}

// A tangent basis of a unit vector.
std::pair<glm::dvec3, glm::dvec3> across(const glm::dvec3 &axis) {
    const glm::dvec3 other = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 first = glm::normalize(glm::cross(axis, other));
    return {first, glm::cross(axis, first)};
}

void add_joint_arrow(DrawList &list, const glm::dvec3 &from, const glm::dvec3 &vector,
                     const glm::vec3 &colour) {
    const double length = glm::length(vector);
    if (!(length > 1e-6) || !std::isfinite(length))
        return;
    const glm::dvec3 to = from + vector;
    const glm::dvec3 back = to - 0.125 * vector;
    const glm::dvec3 aside = across(vector / length).first * (0.06 * length);
    add_line(list, from, to, 2, colour);
    add_line(list, to, back + aside, 2, colour);
    add_line(list, to, back - aside, 2, colour);
}

glm::dvec3 turned(const glm::dvec3 &v, const glm::dvec3 &axis, double angle) {
    return glm::angleAxis(angle, axis) * v;
}

// ---- rods, ropes, springs ----

// Points of a rope of that length hanging between two ends, as a parabola, which a shallow catenary
// nearly is. Straight if the rope is taut or there is no gravity.
std::vector<glm::dvec3> hanging(const glm::dvec3 &a, const glm::dvec3 &b, double length,
                                const glm::dvec3 &gravity) {
    constexpr int pieces = 16;
    const double pull = glm::length(gravity);
    const auto points = [&](double sag) {
        std::vector<glm::dvec3> all;
        for (int i = 0; i <= pieces; ++i) {
            const double t = static_cast<double>(i) / pieces;
            all.push_back(a + t * (b - a) +
                          (pull > 0 ? 4 * t * (1 - t) * sag / pull : 0) * gravity);
        }
        return all;
    };
    const auto length_of = [&](double sag) {
        const std::vector<glm::dvec3> all = points(sag);
        double sum = 0;
        for (std::size_t i = 1; i < all.size(); ++i)
            sum += glm::distance(all[i - 1], all[i]);
        return sum;
    };
    if (!(pull > 0) || glm::distance(a, b) >= length)
        return {a, b};
    double low = 0;
    double high = length; // a rope is at least twice as long as its sag
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (length_of(middle) < length ? low : high) = middle;
    }
    return points(low);
}

// A wire coiled around the line from a to b, whose turns spread as it stretches.
std::vector<glm::dvec3> coil(const glm::dvec3 &a, const glm::dvec3 &b, double rest_length) {
    constexpr int turns = 7;
    constexpr int pieces = 10; // per turn
    const double length = glm::distance(a, b);
    if (!(length > 0) || !std::isfinite(length))
        return {};
    const glm::dvec3 axis = (b - a) / length;
    const auto [u, v] = across(axis);
    const double radius = 0.06 * rest_length;
    const double straight = 0.1; // at each end
    std::vector<glm::dvec3> points{a};
    for (int i = 0; i <= turns * pieces; ++i) {
        const double t = static_cast<double>(i) / (turns * pieces);
        const double angle = turn * turns * t;
        points.push_back(a + (straight + (1 - 2 * straight) * t) * (b - a) +
                         radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    points.push_back(b);
    return points;
}

bool is_link(const JointView &joint) {
    return joint_type(joint.type).anchors == JointTypeInfo::Anchors::apart;
}

void add_link(DrawList &list, const JointView &joint, const glm::dvec3 &gravity) {
    const auto [least, greatest] =
        joint.limits.value_or(std::array{joint.position, joint.position});
    const bool is_spring = joint.frequency > 0;
    const bool is_rope = least < greatest && !is_spring;
    const double size = is_rope || is_spring ? greatest : joint.position;
    const double radius = wire_share * size;
    const std::vector<glm::dvec3> points =
        is_spring ? coil(joint.anchor_a, joint.anchor_b, greatest)
        : is_rope ? hanging(joint.anchor_a, joint.anchor_b, greatest, gravity)
                  : std::vector{joint.anchor_a, joint.anchor_b};
    for (std::size_t i = 1; i < points.size(); ++i)
        add_capsule(list, points[i - 1], points[i], radius);
}

// ---- signs ----

// A joint seen from the body that holds the other: from a, or from b if a moves against the world.
struct Seen {
    const JointView &joint;
    const JointSurroundings &around;
    bool from_b = false;

    Seen(const JointView &view, const JointSurroundings &surroundings)
        : joint(view), around(surroundings), from_b(!view.body_b) {}

    glm::dvec3 anchor() const { return from_b ? joint.anchor_b : joint.anchor_a; }
    glm::dvec3 moving_anchor() const { return from_b ? joint.anchor_a : joint.anchor_b; }
    glm::dvec3 axis() const {
        return (from_b ? joint.frame_b : joint.frame_a) * glm::dvec3(1, 0, 0);
    }
    glm::dvec3 moving_y() const {
        return (from_b ? joint.frame_a : joint.frame_b) * glm::dvec3(0, 1, 0);
    }
    const std::optional<std::size_t> &moving() const {
        return from_b ? joint.body_a : joint.body_b;
    }
    double sign() const { return from_b ? -1 : 1; }
    double position() const { return sign() * joint.position; }
    std::optional<std::array<double, 2>> limits() const {
        if (!joint.limits)
            return std::nullopt;
        const auto [lower, upper] = *joint.limits;
        return from_b ? std::array{-upper, -lower} : std::array{lower, upper};
    }
    // symbol size (m), visible beside the smaller body
    double size() const {
        double smallest = 0;
        for (const std::optional<std::size_t> &body : {joint.body_a, joint.body_b})
            if (body && *body < around.reach.size() && around.reach[*body] > 0)
                smallest =
                    smallest > 0 ? std::min(smallest, around.reach[*body]) : around.reach[*body];
        return smallest > 0 ? 0.5 * smallest : 0.25;
    }
};

void add_arc(DrawList &list, const glm::dvec3 &centre, const glm::dvec3 &axis,
             const glm::dvec3 &zero, double from, double to, float width) {
    const int pieces = std::clamp(static_cast<int>(std::ceil(48 * (to - from) / turn)), 1, 48);
    for (int i = 0; i < pieces; ++i) {
        const auto at = [&](int k) {
            return centre + turned(zero, axis, from + (to - from) * k / pieces);
        };
        add_line(list, at(i), at(i + 1), width);
    }
}

void add_arc_and_hand(DrawList &list, const Seen &seen) {
    const glm::dvec3 centre = seen.anchor();
    const glm::dvec3 axis = seen.axis();
    const double radius = seen.size();
    add_line(list, centre - radius * axis, centre + radius * axis, 4);
    // The hand points at the turning body, if it can.
    glm::dvec3 hand = seen.moving_y();
    if (seen.moving() && *seen.moving() < seen.around.poses.size()) {
        const glm::dvec3 to = seen.around.poses[*seen.moving()].position - centre;
        const glm::dvec3 aside = to - glm::dot(to, axis) * axis;
        if (glm::length(aside) > 0.01 * radius)
            hand = glm::normalize(aside);
    }
    hand *= radius;
    add_line(list, centre, centre + hand, 3);
    const glm::dvec3 zero = turned(hand, axis, -seen.position());
    if (const auto limits = seen.limits()) {
        add_arc(list, centre, axis, zero, (*limits)[0], (*limits)[1], 3);
        for (const double limit : *limits)
            add_line(list, centre, centre + 1.15 * turned(zero, axis, limit), 1.5f);
    } else {
        add_arc(list, centre, axis, zero, 0, turn, 1.5f);
    }
    if (seen.joint.motor_speed) {
        // An arrow over a sixth of a turn, the way the motor drives.
        const double way = std::copysign(turn / 6, seen.sign() * *seen.joint.motor_speed);
        const glm::dvec3 outer = 1.25 * hand;
        add_arc(list, centre, axis, outer, std::min(0.0, way), std::max(0.0, way), 2);
        const glm::dvec3 tip = centre + turned(outer, axis, way);
        for (const double scale : {0.85, 1.15})
            add_line(list, tip, centre + scale * turned(outer, axis, 0.75 * way));
    }
}

void add_rail(DrawList &list, const Seen &seen) {
    const glm::dvec3 foot = seen.anchor();
    const glm::dvec3 axis = seen.axis();
    const double size = seen.size();
    const double place = seen.position();
    const std::array<double, 2> ends = seen.limits().value_or(
        std::array{std::min(0.0, place) - 2 * size, std::max(0.0, place) + 2 * size});
    const auto [u, v] = across(axis);
    const glm::dvec3 aside = 0.2 * size * u;
    for (const double side : {-1.0, 1.0})
        add_line(list, foot + ends[0] * axis + side * aside, foot + ends[1] * axis + side * aside);
    if (seen.limits())
        for (const double end : ends)
            for (const glm::dvec3 &way : {u, v})
                add_line(list, foot + end * axis - 0.5 * size * way,
                         foot + end * axis + 0.5 * size * way, 3);
    add_line(list, seen.moving_anchor() - aside, seen.moving_anchor() + aside, 4);
    if (seen.joint.motor_speed)
        add_joint_arrow(list, seen.moving_anchor(),
                        std::copysign(size, seen.sign() * *seen.joint.motor_speed) * axis,
                        colours::joint);
}

void add_cross(DrawList &list, const Seen &seen) {
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 arm{0};
        arm[k] = 0.5 * seen.size();
        const glm::dvec3 world = seen.joint.frame_a * arm;
        add_line(list, seen.anchor() - world, seen.anchor() + world, 3);
    }
}

// Scaled like contact forces.
void add_force(DrawList &list, const Seen &seen) {
    const double weight = seen.around.weight;
    const double force = glm::length(seen.joint.force);
    if (weight > 0 && force > 0)
        add_joint_arrow(list, seen.moving_anchor(),
                        seen.sign() * std::min(2.0, 0.3 * std::sqrt(force / weight)) / force *
                            seen.joint.force,
                        colours::contact);
}

// What the joint type adds; the anchors' dots are drawn anyway.
void add_sign(DrawList &list, const JointTypeInfo &type, const Seen &seen) {
    using Frames = JointTypeInfo::Frames;
    if (type.frames == Frames::whole)
        add_cross(list, seen);
    if (type.frames == Frames::axis)
        type.turns ? add_arc_and_hand(list, seen) : add_rail(list, seen);
}

} // namespace

std::vector<JointView> joints_at(const Frame &frame, std::span<const BodyState> poses) {
    std::vector<JointView> joints = frame.joints;
    for (JointView &joint : joints) {
        const auto move = [&](const std::optional<std::size_t> &body, glm::dvec3 &anchor,
                              glm::dquat &axes) {
            if (!body || *body >= poses.size())
                return;
            const BodyState &now = frame.bodies[*body];
            const BodyState &shown = poses[*body];
            if (shown.position == now.position && shown.orientation == now.orientation)
                return;
            const glm::dquat way = shown.orientation * glm::conjugate(now.orientation);
            anchor = shown.position + way * (anchor - now.position);
            axes = way * axes;
        };
        move(joint.body_a, joint.anchor_a, joint.frame_a);
        move(joint.body_b, joint.anchor_b, joint.frame_b);
        if (is_link(joint))
            joint.position = glm::distance(joint.anchor_a, joint.anchor_b);
    }
    return joints;
}

bool is_about_joints(const Simulation &simulation) {
    std::vector<bool> joined(simulation.body_count());
    for (const JointView &joint : simulation.read({.joints = true}).joints)
        for (const std::optional<std::size_t> &body : {joint.body_a, joint.body_b})
            if (body && !is_link(joint))
                joined[*body] = true;
    int with = 0;
    int without = 0;
    for (std::size_t body = 0; body < joined.size(); ++body) {
        const BodyInfo &info = simulation.body_info(body);
        if (info.alive && info.kind == BodyKind::dynamic)
            ++(joined[body] ? with : without);
    }
    return with > without;
}

void draw_spring(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double rest_length) {
    const std::vector<glm::dvec3> points = coil(a, b, rest_length);
    for (std::size_t i = 1; i < points.size(); ++i)
        add_capsule(list, points[i - 1], points[i], wire_share * rest_length);
}

void draw_wire(DrawList &list, const glm::dvec3 &a, const glm::dvec3 &b, double radius) {
    add_capsule(list, a, b, radius);
}

void draw_links(DrawList &list, std::span<const JointView> joints,
                const JointSurroundings &surroundings) {
    for (const JointView &joint : joints)
        if (is_link(joint) && !joint.broken)
            add_link(list, joint, surroundings.gravity);
}

void draw_joints(DrawList &list, std::span<const JointView> joints,
                 const JointSurroundings &surroundings) {
    for (const JointView &joint : joints) {
        const glm::vec3 colour = joint.broken ? colours::contact : colours::joint;
        for (const auto &[body, anchor] :
             {std::pair{joint.body_a, joint.anchor_a}, std::pair{joint.body_b, joint.anchor_b}}) {
            if (body && *body < surroundings.poses.size())
                add_line(list, surroundings.poses[*body].position, anchor, 1.5f, colour);
            add_dot(list, anchor, colour);
        }
        if (joint.broken)
            continue; // only its ends, in the error colour
        const JointTypeInfo &type = joint_type(joint.type);
        if (type.anchors != JointTypeInfo::Anchors::on_axis)
            add_line(list, joint.anchor_a, joint.anchor_b, 3);
        const Seen seen(joint, surroundings);
        add_sign(list, type, seen);
        add_force(list, seen);
    }
}

} // namespace plumb
