#include "engine/scene/file/warnings.h"

#include "engine/core/disjoint_sets.h"
#include "engine/dynamics/method_info.h"
#include "engine/scene/file/number.h"
#include "engine/scene/joint_type.h"
#include "engine/scene/simulation.h"
#include "engine/scene/start_overlaps.h"
#include "engine/scene/touching_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb {

namespace {

constexpr double overlap_limit = 0.01;   // of the smaller width
constexpr double anchor_gap_limit = 0.1; // of the smaller width
constexpr double mass_ratio_limit = 100;
// Largest spacing of float positions, as a fraction of a body's width: the depth a contact may not
// exceed (substep_tolerance). At three times this a pendulum's energy is 1 % off after a minute.
constexpr double coarseness_limit = 3e-4;
constexpr std::size_t listed_of_a_kind = 10;

// Three digits are enough for a message.
std::string rounded(double value) {
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
    return buffer.data();
}

std::string in_quotes(const std::string &name) {
    return '"' + name + '"';
}

// The warnings of one kind, limited to the first few.
class Group {
  public:
    explicit Group(std::string more) : more_(std::move(more)) {}

    void add(const FilePosition &at, std::string what, std::string suggestion) {
        ++count_;
        if (count_ <= listed_of_a_kind)
            messages_.push_back({SceneMessage::Severity::warning, at.line, at.column,
                                 std::move(what), std::move(suggestion)});
    }

    void move_into(std::vector<SceneMessage> &all) {
        if (count_ > listed_of_a_kind)
            messages_.back().what +=
                " (and " + std::to_string(count_ - listed_of_a_kind) + " more " + more_ + ")";
        all.insert(all.end(), messages_.begin(), messages_.end());
    }

  private:
    std::string more_;
    std::size_t count_ = 0;
    std::vector<SceneMessage> messages_;
};

class Checker {
  public:
    Checker(const SceneDesc &scene, const ScenePositions &positions)
        : scene_(scene), positions_(positions) {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            const BodyDesc &body = scene.bodies[i];
            indices_[body.name] = i;
            masses_.push_back(body.kind == BodyKind::dynamic ? mass_of(scene, body) : 0);
            widths_.push_back(smallest_width(body));
            bounds_.push_back(bounds(body));
        }
    }

    std::vector<SceneMessage> run() {
        check_joints();
        check_springs();
        check_pairs();
        check_dt();
        check_places();
        std::vector<SceneMessage> all;
        for (Group *kind :
             {&far_away_, &overlaps_, &mass_ratios_, &gaps_, &idle_joints_, &idle_springs_,
              &stiff_springs_, &fast_, &spinning_, &falling_, &pendulums_})
            kind->move_into(all);
        return all;
    }

  private:
    bool is_dynamic(std::size_t body) const {
        return scene_.bodies[body].kind == BodyKind::dynamic;
    }

    std::optional<std::size_t> index(const std::string &name) const {
        return name.empty() ? std::nullopt : std::optional(indices_.at(name));
    }

    glm::dvec3 to_world(const std::optional<std::size_t> &body, const glm::dvec3 &local) const {
        if (!body)
            return local;
        return scene_.bodies[*body].position + scene_.bodies[*body].orientation * local;
    }

    // The gap between anchors that the joint should keep together.
    double start_gap(const JointDesc &joint, const std::optional<std::size_t> &a,
                     const std::optional<std::size_t> &b) const {
        const glm::dvec3 gap =
            to_world(b, joint.anchor_b_local) - to_world(a, joint.anchor_a_local);
        switch (joint_type(joint.type).anchors) {
        case JointTypeInfo::Anchors::together:
            return glm::length(gap);
        case JointTypeInfo::Anchors::on_axis: {
            const glm::dvec3 local = joint.frame_a_local * glm::dvec3(1, 0, 0);
            const glm::dvec3 axis = a ? scene_.bodies[*a].orientation * local : local;
            return glm::length(gap - glm::dot(gap, axis) * axis);
        }
        case JointTypeInfo::Anchors::apart:
            break; // a rod may start at another length than its own
        }
        return 0;
    }

    bool differ_in_mass(std::size_t a, std::size_t b) const {
        const double ratio = std::max(masses_[a], masses_[b]) / std::min(masses_[a], masses_[b]);
        return is_dynamic(a) && is_dynamic(b) && ratio > mass_ratio_limit * (1 + 1e-9);
    }

    void warn_of_mass_ratio(std::size_t a, std::size_t b, const FilePosition &at, const char *how) {
        const double ratio = std::max(masses_[a], masses_[b]) / std::min(masses_[a], masses_[b]);
        mass_ratios_.add(at,
                         in_quotes(scene_.bodies[a].name) + " and " +
                             in_quotes(scene_.bodies[b].name) + " " + how +
                             ", and their masses differ by a factor of " + rounded(ratio),
                         "iterative solvers converge slowly above 100: make the masses more "
                         "similar, or expect many iterations");
    }

    void check_joints() {
        welds_.start(scene_.bodies.size());
        for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
            const JointDesc &joint = scene_.joints[i];
            const FilePosition &at = positions_.joints[i];
            const std::optional<std::size_t> a = index(joint.body_a);
            const std::optional<std::size_t> b = index(joint.body_b);
            if (a && b && !joint.collide_connected && !joint.broken) {
                exempt_.emplace_back(std::minmax(*a, *b));
                if (joint.type == JointType::fixed && joint.frequency == 0 &&
                    joint.break_force == 0)
                    welds_.join(static_cast<std::uint32_t>(*a), static_cast<std::uint32_t>(*b));
            }
            if (!(a && is_dynamic(*a)) && !(b && is_dynamic(*b)))
                idle_joints_.add(at,
                                 "joint " + in_quotes(joint.name) +
                                     " moves nothing: neither of its bodies is dynamic",
                                 "");
            if (a && b && differ_in_mass(*a, *b))
                warn_of_mass_ratio(*a, *b, at, "are joined");
            const double gap = start_gap(joint, a, b);
            double width = std::numeric_limits<double>::infinity();
            for (const std::optional<std::size_t> &body : {a, b})
                if (body)
                    width = std::min(width, widths_[*body]);
            if (joint.frequency == 0 && gap > anchor_gap_limit * width)
                gaps_.add(at,
                          "the two anchors of " + std::string(joint_type(joint.type).name) +
                              " joint " + in_quotes(joint.name) + " start " + rounded(gap) +
                              " m apart" +
                              (joint.type == JointType::slider ? " across its axis" : ""),
                          "they should coincide, or the first step will jerk them together");
        }
        std::sort(exempt_.begin(), exempt_.end());
    }

    // 1/kg; 0 for an end that never moves.
    double inv_mass(const SoftParts &parts, const SpringEndInfo &end) const {
        switch (end.kind) {
        case SpringEndInfo::Kind::world:
            break;
        case SpringEndInfo::Kind::particle:
            return parts.particles[end.index].pinned ? 0 : 1 / parts.particles[end.index].mass;
        case SpringEndInfo::Kind::body:
            return masses_[end.index] > 0 ? 1 / masses_[end.index] : 0;
        }
        return 0;
    }

    void check_springs() {
        if (scene_.springs.empty())
            return;
        const SoftParts parts(scene_);
        const MethodInfo *method = find_method_info(scene_.world.method);
        const double step = method ? substep(settings_of(scene_.world, *method)) : 0;
        for (std::size_t i = 0; i < scene_.springs.size(); ++i) {
            const SpringInfo &spring = parts.springs[i];
            const double moved = inv_mass(parts, spring.a) + inv_mass(parts, spring.b);
            const std::string name = in_quotes(scene_.springs[i].name);
            if (moved == 0)
                idle_springs_.add(positions_.springs[i],
                                  "spring " + name + " moves nothing: neither of its ends moves",
                                  "");
            // The limit as for a pendulum, below. RK4 is stable up to 2.83; methods with contacts
            // are implicit here.
            const double omega = std::sqrt(spring.stiffness * moved);
            if (method && !method->contacts && method->name != "backward_euler" && omega * step > 2)
                stiff_springs_.add(positions_.springs[i],
                                   "spring " + name +
                                       " has omega = sqrt(k / m) = " + rounded(omega) +
                                       " rad/s, and omega h = " + rounded(omega * step) +
                                       " > 2 is unstable (h = dt / substeps)",
                                   "a step h up to " + rounded(2 / omega));
        }
    }

    static double substep(const StepSettings &settings) { return settings.dt / settings.substeps; }

    void check_pair(std::size_t a, std::size_t b) {
        if (a > b)
            std::swap(a, b);
        const BodyDesc &body_a = scene_.bodies[a];
        const BodyDesc &body_b = scene_.bodies[b];
        if (std::binary_search(exempt_.begin(), exempt_.end(), std::pair(a, b)) ||
            welds_.root_of(static_cast<std::uint32_t>(a)) ==
                welds_.root_of(static_cast<std::uint32_t>(b)))
            return;
        const double limit = overlap_limit * std::min(widths_[a], widths_[b]);
        const std::optional<double> depth = start_overlaps_.deepest(body_a, body_b, limit);
        if (!depth)
            return;
        // Report the body further down in the file: that is the one to move.
        const FilePosition &at = positions_.bodies[b];
        if (*depth > limit && scene_.step_count == 0) // not where a run was saved
            overlaps_.add(at,
                          in_quotes(body_a.name) + " and " + in_quotes(body_b.name) +
                              " overlap by " + rounded(*depth) + " m at the start",
                          "move them apart, or they will be thrown apart");
        if (differ_in_mass(a, b))
            warn_of_mass_ratio(a, b, at, "touch");
    }

    // Shapes cannot penetrate deeper than their bounding boxes overlap along any axis, so a pile of
    // bodies that merely touch needs no closer look.
    bool may_overlap(std::size_t a, std::size_t b) const {
        const glm::dvec3 depth =
            glm::min(bounds_[a].max - bounds_[b].min, bounds_[b].max - bounds_[a].min);
        const double limit = overlap_limit * std::min(widths_[a], widths_[b]);
        return depth.x > limit && depth.y > limit && depth.z > limit;
    }

    void check_pairs() {
        std::vector<BoundsDesc> boxes;
        std::vector<std::size_t> bounded; // the body of each box
        std::vector<std::size_t> planes;
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const BodyDesc &body = scene_.bodies[i];
            if (has_plane(body)) {
                planes.push_back(i);
                continue;
            }
            // If one body is infinitely wide, only the other's width counts.
            const double near = std::isfinite(widths_[i]) ? overlap_limit * widths_[i] : 0;
            boxes.push_back({bounds_[i].min - near, bounds_[i].max + near});
            bounded.push_back(i);
        }
        for (const std::size_t plane : planes)
            for (const std::size_t other : bounded)
                if (is_dynamic(other))
                    check_pair(plane, other);
        for_touching_boxes(boxes, [&](std::size_t i, std::size_t j) {
            const std::size_t a = bounded[i];
            const std::size_t b = bounded[j];
            if ((is_dynamic(a) || is_dynamic(b)) && (may_overlap(a, b) || differ_in_mass(a, b)))
                check_pair(a, b);
            return true;
        });
    }

    void check_dt() {
        MethodInfo unknown;
        unknown.name = scene_.world.method;
        const MethodInfo *method = find_method_info(scene_.world.method);
        const StepSettings settings = settings_of(scene_.world, method ? *method : unknown);
        const double dt = settings.dt;
        const double substep = dt / settings.substeps;
        const double gravity = glm::length(settings.gravity);
        double smallest = std::numeric_limits<double>::infinity();
        const BodyDesc *smallest_body = nullptr;
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const BodyDesc &body = scene_.bodies[i];
            const double width = widths_[i];
            if (is_dynamic(i) && width < smallest) {
                smallest = width;
                smallest_body = &body;
            }
            const double way = glm::length(body.velocity) * dt;
            if (body.kind != BodyKind::static_body && way > width)
                fast_.add(positions_.bodies[i],
                          in_quotes(body.name) + " moves " + rounded(way) +
                              " m in one step, more than its width of " + rounded(width) +
                              " m, and may pass through others (|v| dt > width)",
                          "world.dt up to " + rounded(width / glm::length(body.velocity)));
            const double turn = glm::length(body.angular_velocity) * dt;
            if (body.kind != BodyKind::static_body && turn > std::numbers::pi)
                spinning_.add(positions_.bodies[i],
                              in_quotes(body.name) + " turns by " + rounded(turn) +
                                  " rad in one step, more than half a revolution (|w| dt > pi)",
                              "world.dt up to " +
                                  rounded(std::numbers::pi / glm::length(body.angular_velocity)));
        }
        // One step from rest covers g dt^2 with semi-implicit Euler.
        if (smallest_body && gravity * dt * dt > 0.5 * smallest)
            falling_.add(positions_.dt,
                         "a body falls " + rounded(gravity * dt * dt) +
                             " m in its first step, more than half the width of " +
                             in_quotes(smallest_body->name) + " (g dt^2 > width / 2)",
                         "dt up to " + rounded(std::sqrt(0.5 * smallest / gravity)));
        // A small swing on a rod of length L is a spring of omega = sqrt(g / L); semi-implicit
        // Euler is unstable above omega h = 2 (Hairer, Lubich, Wanner 2003, "Geometric numerical
        // integration illustrated by the Stormer-Verlet method").
        for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
            const JointDesc &joint = scene_.joints[i];
            if (joint.type != JointType::distance)
                continue;
            const double omega = std::sqrt(gravity / joint.max_length);
            if (omega * substep > 2)
                pendulums_.add(positions_.joints[i],
                               "a pendulum on " + in_quotes(joint.name) +
                                   " has omega = sqrt(g / length) = " + rounded(omega) +
                                   " rad/s, and omega h = " + rounded(omega * substep) +
                                   " > 2 is unstable (h = dt / substeps)",
                               "a step h up to " + rounded(2 / omega));
        }
    }

    // Spacing of float positions at the body, as a fraction of its width.
    double coarseness(std::size_t i) const {
        const glm::dvec3 at = glm::abs(scene_.bodies[i].position);
        const auto far = static_cast<float>(std::max({at.x, at.y, at.z}));
        const float next = std::nextafter(far, std::numeric_limits<float>::infinity());
        return static_cast<double>(next - far) / widths_[i];
    }

    // Reports only the worst body.
    void check_places() {
        if (scene_.world.precision != Precision::f32)
            return;
        std::size_t worst = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            if (!is_dynamic(i) || coarseness(i) <= coarseness_limit)
                continue;
            if (count++ == 0 || coarseness(i) > coarseness(worst))
                worst = i;
        }
        if (count == 0)
            return;
        const double distance = glm::length(scene_.bodies[worst].position);
        const double apart = coarseness(worst) * widths_[worst];
        const std::string others =
            count == 1 ? "" : " (and " + std::to_string(count - 1) + " more such bodies)";
        far_away_.add(positions_.bodies[worst],
                      in_quotes(scene_.bodies[worst].name) + " is " + rounded(distance) +
                          " m from the origin, where float positions are " + rounded(apart) +
                          " m apart: too coarse to simulate its motion" + others,
                      "world.precision = \"double\", or move the scene closer to the origin");
    }

    const SceneDesc &scene_;
    const ScenePositions &positions_;
    std::map<std::string, std::size_t> indices_;
    std::vector<double> masses_; // 0 unless dynamic
    std::vector<double> widths_;
    std::vector<BoundsDesc> bounds_;
    StartOverlaps start_overlaps_;
    std::vector<std::pair<std::size_t, std::size_t>> exempt_; // sorted
    DisjointSets welds_; // bodies that unbreakable fixed joints make one

    Group far_away_{"such bodies"};
    Group overlaps_{"overlaps"};
    Group mass_ratios_{"such pairs"};
    Group gaps_{"such joints"};
    Group idle_joints_{"such joints"};
    Group idle_springs_{"such springs"};
    Group stiff_springs_{"such springs"};
    Group fast_{"such bodies"};
    Group spinning_{"such bodies"};
    Group falling_{"such bodies"};
    Group pendulums_{"such joints"};
};

} // namespace

std::vector<SceneMessage> scene_warnings(const SceneDesc &scene, const ScenePositions &positions) {
    return Checker(scene, positions).run();
}

} // namespace plumb
