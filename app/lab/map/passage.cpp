#include "app/lab/map/passage.h"

#include "engine/math/rigid.h"
#include "engine/scene/real/body_def.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace plumb {

namespace {

struct Obstacle {
    std::string name;
    ColliderDef collider; // shape in world space
    Transform surface_pose;
};

// One body's path past one obstacle.
struct Way {
    std::size_t mover = 0, obstacle = 0;
    std::optional<Vec3> entered_by; // surface normal where the centre went in
};

struct Mover {
    std::string name;
    std::size_t body = 0;
    glm::dvec3 center{0}; // at the previous sample
};

bool joined(const SceneDesc &scene, const std::string &a, const std::string &b) {
    return std::ranges::any_of(scene.joints, [&](const JointDesc &joint) {
        return !joint.collide_connected && ((joint.body_a == a && joint.body_b == b) ||
                                            (joint.body_a == b && joint.body_b == a));
    });
}

Ray step_ray(const glm::dvec3 &from, const glm::dvec3 &to) {
    return {Vec3{from}, Vec3{to - from}, Real(1)};
}

// Counts a height field's top and a mesh's front; a mesh's back too if both sides are solid.
bool crosses(const TriangleSurface &surface, const Transform &pose, const Ray &in_world) {
    const Ray ray{to_local_point(pose, in_world.origin), to_local_vector(pose, in_world.direction),
                  in_world.max_t};
    if (const auto *mesh = std::get_if<MeshTree>(&surface.source())) {
        const std::optional<MeshHit> hit = raycast(*mesh, ray);
        if (!hit || surface.sides() == Sides::both)
            return hit.has_value();
        const Triangle triangle = surface.triangle(hit->triangle);
        const Vec3 front = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
        return glm::dot(front, ray.direction) < Real(0);
    }
    const std::optional<RayHit> hit = raycast(surface, ray);
    return hit && hit->normal.y > Real(0);
}

// Whether the centre leaves the solid in this step on the opposite side from where it went in.
bool comes_out_behind(const Shape &shape, const Ray &step, Way &way) {
    const std::optional<RayInterval> inside = ray_interval(shape, step);
    if (std::holds_alternative<HalfSpace>(shape))
        return inside && inside->enter_normal != Vec3{Real(0)};
    if (inside && !way.entered_by)
        way.entered_by = inside->enter_normal;
    if (!way.entered_by || (inside && inside->t_exit >= Real(1)))
        return false;
    // The reversed ray enters where this one leaves.
    const std::optional<RayInterval> back =
        ray_interval(shape, {step.origin + step.direction, -step.direction, Real(1)});
    const Vec3 left_by = back ? back->enter_normal : step.direction;
    const bool behind = glm::dot(*way.entered_by, left_by) < Real(0);
    way.entered_by.reset();
    return behind;
}

} // namespace

struct PassageWatch::Parts {
    std::vector<Mover> movers;
    std::vector<Obstacle> obstacles;
    std::vector<Way> ways; // grouped by mover
    std::string first;
    Frame frame; // of the last sample
};

PassageWatch::PassageWatch(const SceneDesc &scene, const Simulation &simulation)
    : parts_(std::make_unique<Parts>()) {
    simulation.read(parts_->frame, {});
    for (const BodyDesc &body : scene.bodies) {
        if (body.kind != BodyKind::static_body)
            continue;
        const BodyDef def = body_def(scene, body);
        for (ColliderDef collider : def.colliders) {
            if (collider.sensor)
                continue;
            const Transform surface_pose = compose(def.pose, collider.surface_pose);
            if (!collider.surface)
                collider.shape = placed(collider.shape, def.pose);
            parts_->obstacles.push_back({body.name, std::move(collider), surface_pose});
        }
    }
    for (const BodyDesc &body : scene.bodies) {
        const auto index = simulation.find_body(body.name);
        if (body.kind != BodyKind::dynamic || body.colliders.size() != 1 || body.center_of_mass ||
            body.colliders.front().sensor || !index)
            continue;
        const FilterDesc &filter = body.colliders.front().filter;
        const Filter own{static_cast<std::uint32_t>(filter.layer), filter.ignores};
        for (std::size_t i = 0; i < parts_->obstacles.size(); ++i)
            if (may_collide(own, parts_->obstacles[i].collider.filter) &&
                !joined(scene, body.name, parts_->obstacles[i].name))
                parts_->ways.push_back({parts_->movers.size(), i, std::nullopt});
        parts_->movers.push_back({body.name, *index, parts_->frame.bodies[*index].position});
    }
}

PassageWatch::~PassageWatch() = default;

void PassageWatch::begin_again(const Simulation &simulation) {
    simulation.read(parts_->frame, {});
    for (Mover &mover : parts_->movers)
        mover.center = parts_->frame.bodies[mover.body].position;
    for (Way &way : parts_->ways)
        way.entered_by.reset();
    parts_->first.clear();
}

void PassageWatch::sample(const Simulation &simulation) {
    if (!parts_->first.empty())
        return;
    simulation.read(parts_->frame, {});
    auto way = parts_->ways.begin();
    for (std::size_t i = 0; i < parts_->movers.size(); ++i) {
        Mover &mover = parts_->movers[i];
        const glm::dvec3 now = parts_->frame.bodies[mover.body].position;
        const Ray step = step_ray(mover.center, now);
        for (; way != parts_->ways.end() && way->mover == i; ++way) {
            const Obstacle &obstacle = parts_->obstacles[way->obstacle];
            if (step.direction == Vec3{Real(0)})
                continue;
            const ColliderDef &collider = obstacle.collider;
            const bool passed = collider.surface
                                    ? crosses(*collider.surface, obstacle.surface_pose, step)
                                    : comes_out_behind(collider.shape, step, *way);
            if (passed && parts_->first.empty())
                parts_->first = mover.name + " through " + obstacle.name;
        }
        mover.center = now;
    }
}

const std::string &PassageWatch::first() const {
    return parts_->first;
}

} // namespace plumb
