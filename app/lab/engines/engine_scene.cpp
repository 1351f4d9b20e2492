#include "app/lab/engines/engine.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace plumb {

EngineScene::EngineScene(SceneDesc scene, const RunOptions &options, int substeps, int iterations)
    : desc(std::move(scene)), iterations_(iterations) {
    const auto simulation = Simulation::create(desc, options, nullptr);
    dt_ = simulation->settings().dt / substeps;
    gravity_ = simulation->settings().gravity;
    for (std::size_t body = 0; body < desc.bodies.size(); ++body) {
        const BodyInfo &info = simulation->body_info(body);
        masses.push_back({info.mass, info.inertia});
        indices_[info.name] = body;
    }
}

namespace {

std::string beyond_engines(const BodyDesc &body, const ColliderDesc &collider) {
    if (std::holds_alternative<MeshDesc>(collider.shape))
        return "meshes";
    if (std::holds_alternative<HeightFieldDesc>(collider.shape))
        return "height fields";
    if (collider.sensor)
        return "sensors";
    if (collider.filter.layer != 0 || collider.filter.ignores != 0)
        return "collision layers";
    if (!collider.material.empty() && collider.material != body.material)
        return "bodies with several materials";
    return "";
}

std::string beyond_engines(const JointDesc &joint) {
    if (joint.type != JointType::ball && joint.type != JointType::hinge)
        return "joints other than ball and hinge";
    if (joint.limits || joint.motor_speed || joint.frequency > 0 || joint.break_force > 0)
        return "joints with limits, a motor, a spring or a breaking force";
    return "";
}

bool lies_in_its_mass_frame(const BodyDesc &body, const BodyDesc &described) {
    constexpr double near = 1e-6; // m, rad: float round-off
    if (!described.mass_pose)
        return true;
    return glm::distance(described.mass_pose->position, body.position) < near &&
           std::abs(glm::dot(described.mass_pose->orientation, body.orientation)) > 1 - near;
}

} // namespace

std::string beyond_engines(const SceneDesc &scene) {
    if (!scene.particles.empty() || !scene.springs.empty() || !scene.cloths.empty())
        return "particles, springs or cloth";
    if (!scene.attractors.empty())
        return "attractors";
    if (scene.step_count > 0)
        return "saved states";
    if (scene.bodies.empty())
        return "scenes without bodies";
    const SceneDesc described = Simulation::create(scene, {}, nullptr)->describe();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDesc &body = scene.bodies[i];
        if (body.gravity_scale != 1 || body.linear_damping > 0 || body.angular_damping > 0)
            return "bodies with damping or a gravity scale";
        if (body.force != glm::dvec3(0) || body.torque != glm::dvec3(0))
            return "bodies with a constant force or torque";
        if (std::ranges::find(body.locked, true) != body.locked.end())
            return "bodies with locked axes";
        if (body.kind == BodyKind::dynamic && !lies_in_its_mass_frame(body, described.bodies[i]))
            return "bodies whose frame is not their principal-axis frame";
        for (const ColliderDesc &collider : body.colliders)
            if (std::string what = beyond_engines(body, collider); !what.empty())
                return what;
    }
    for (const JointDesc &joint : scene.joints)
        if (std::string what = beyond_engines(joint); !what.empty())
            return what;
    return "";
}

const MaterialDesc &EngineScene::material(const BodyDesc &body) const {
    static const MaterialDesc by_default;
    const auto named = std::ranges::find(desc.materials, body.material, &MaterialDesc::name);
    return named == desc.materials.end() ? by_default : *named;
}

std::size_t EngineScene::body(const std::string &name) const {
    return indices_.at(name);
}

} // namespace plumb
