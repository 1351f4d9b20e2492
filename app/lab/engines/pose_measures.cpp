// Compiled with PLUMB_DOUBLE, to resolve micrometres of depth at 100 m from the origin.
#include "app/lab/engines/pose_measures.h"

#include "engine/geometry/manifold.h"
#include "engine/geometry/overlap.h"
#include "engine/scene/real/body_def.h"
#include "engine/space/bvh.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace plumb {

static_assert(sizeof(Real) == sizeof(double));

bool is_finite(std::span<const BodyState> states) {
    return std::ranges::all_of(states, [](const BodyState &state) {
        const glm::dvec3 &p = state.position;
        const glm::dquat &q = state.orientation;
        const double all = p.x + p.y + p.z + q.w + q.x + q.y + q.z;
        return std::isfinite(all) && glm::length(p) < 1e6;
    });
}

struct PoseMeasures::Colliders {
    struct One {
        std::uint32_t body;
        Shape shape;
    };
    std::vector<BodyDef> defs; // keep the hulls' meshes alive
    std::vector<One> all;
    std::set<std::pair<std::uint32_t, std::uint32_t>> joined; // lower index first
};

PoseMeasures::PoseMeasures(const EngineScene &scene)
    : scene_(scene), colliders_(std::make_unique<Colliders>()) {
    const SceneDesc &desc = scene.desc;
    for (std::uint32_t body = 0; body < desc.bodies.size(); ++body) {
        const BodyDef &def = colliders_->defs.emplace_back(body_def(desc, desc.bodies[body]));
        for (const ColliderDef &collider : def.colliders)
            colliders_->all.push_back({body, collider.shape});
        if (desc.bodies[body].kind == BodyKind::dynamic &&
            (scene.masses[top_].mass == 0 ||
             desc.bodies[body].position.y > desc.bodies[top_].position.y))
            top_ = body;
    }
    for (const JointDesc &joint : desc.joints)
        if (!joint.collide_connected && !joint.body_a.empty() && !joint.body_b.empty()) {
            const auto a = static_cast<std::uint32_t>(scene.body(joint.body_a));
            const auto b = static_cast<std::uint32_t>(scene.body(joint.body_b));
            colliders_->joined.insert(std::minmax(a, b));
        }
}

PoseMeasures::~PoseMeasures() = default;

Depth PoseMeasures::depth(std::span<const BodyState> states) const {
    std::vector<Shape> shapes;
    std::vector<std::uint32_t> solids, planes;
    std::vector<Aabb> boxes;
    for (std::uint32_t i = 0; i < colliders_->all.size(); ++i) {
        const Colliders::One &one = colliders_->all[i];
        const BodyState &state = states[one.body];
        const Transform pose{Vec3(state.position), glm::normalize(Quat(state.orientation))};
        shapes.push_back(
            std::visit([&](const auto &shape) { return Shape(placed(shape, pose)); }, one.shape));
        if (std::holds_alternative<HalfSpace>(shapes.back())) {
            planes.push_back(i);
        } else {
            solids.push_back(i);
            boxes.push_back(bounds(shapes.back()));
        }
    }

    Depth depth;
    std::size_t points = 0;
    const auto meet = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t body_a = colliders_->all[a].body, body_b = colliders_->all[b].body;
        if (body_a == body_b ||
            (scene_.masses[body_a].mass == 0 && scene_.masses[body_b].mass == 0) ||
            colliders_->joined.contains(std::minmax(body_a, body_b)))
            return;
        const Manifold manifold = collide(shapes[a], shapes[b], Real(0));
        for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
            const double deep = -manifold.points[i].separation;
            if (deep > 0) {
                depth.deepest = std::max(depth.deepest, deep);
                depth.mean += deep;
                ++points;
            }
        }
    };
    const Bvh tree(boxes);
    for (std::uint32_t i = 0; i < solids.size(); ++i) {
        tree.query(boxes[i], [&](std::uint32_t other) {
            if (other > i && overlaps(boxes[i], boxes[other]))
                meet(solids[i], solids[other]);
            return true;
        });
        for (const std::uint32_t plane : planes)
            meet(solids[i], plane);
    }
    if (points > 0)
        depth.mean /= static_cast<double>(points);
    return depth;
}

double PoseMeasures::joint_drift(std::span<const BodyState> states) const {
    double drift = 0;
    const auto anchor = [&](const std::string &body, const glm::dvec3 &local) {
        if (body.empty())
            return local;
        const BodyState &state = states[scene_.body(body)];
        return state.position + state.orientation * local;
    };
    for (const JointDesc &joint : scene_.desc.joints)
        drift = std::max(drift, glm::distance(anchor(joint.body_a, joint.anchor_a_local),
                                              anchor(joint.body_b, joint.anchor_b_local)));
    return drift;
}

double PoseMeasures::kinetic_energy(std::span<const BodyState> before,
                                    std::span<const BodyState> after, double dt) const {
    double energy = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        const BodyMass &mass = scene_.masses[i];
        if (mass.mass == 0)
            continue;
        const glm::dvec3 velocity = (after[i].position - before[i].position) / dt;
        const glm::dquat turn = glm::conjugate(before[i].orientation) * after[i].orientation;
        const glm::dvec3 sine(turn.x, turn.y, turn.z);
        const double length = glm::length(sine);
        const double angle = 2 * std::atan2(length, std::abs(turn.w));
        const glm::dvec3 spin = length > 0 ? sine * (angle / (length * dt)) : glm::dvec3(0);
        energy += 0.5 * mass.mass * glm::dot(velocity, velocity) +
                  0.5 * glm::dot(mass.inertia, spin * spin);
    }
    return energy;
}

double PoseMeasures::top_displacement(std::span<const BodyState> states) const {
    return glm::distance(states[top_].position, scene_.desc.bodies[top_].position);
}

} // namespace plumb
