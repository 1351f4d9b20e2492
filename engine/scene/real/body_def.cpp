#include "engine/scene/real/body_def.h"

#include "engine/math/rigid.h"
#include "engine/scene/real/solid_shape.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void set_shape(ColliderDef &out, const ColliderDesc &desc, const std::string &body) {
    const Transform pose{Vec3{desc.position}, unit(Quat{desc.orientation})};
    out.surface = triangle_surface(desc.shape);
    if (out.surface) {
        out.surface_pose = pose;
        return;
    }
    SolidShape solid = solid_shape(desc.shape);
    if (!solid.shape)
        throw std::invalid_argument("the points of a hull of \"" + body + "\" have no solid hull");
    const bool is_placed =
        desc.position != glm::dvec3(0) || desc.orientation != glm::dquat(1, 0, 0, 0);
    out.shape = is_placed ? placed(*solid.shape, pose) : *solid.shape;
    out.hull = std::move(solid.hull);
}

} // namespace

const MaterialDesc &material_of(const SceneDesc &scene, const std::string &name) {
    static const MaterialDesc default_material;
    const auto named = std::ranges::find(scene.materials, name, &MaterialDesc::name);
    return name.empty() || named == scene.materials.end() ? default_material : *named;
}

BodyDef body_def(const SceneDesc &scene, const BodyDesc &desc) {
    BodyDef def;
    def.kind = desc.kind;
    for (const ColliderDesc &from : desc.colliders) {
        ColliderDef &to = def.colliders.emplace_back();
        set_shape(to, from, desc.name);
        const MaterialDesc &material =
            material_of(scene, from.material.empty() ? desc.material : from.material);
        to.material = {static_cast<Real>(material.friction),
                       static_cast<Real>(material.restitution)};
        to.filter = {static_cast<std::uint32_t>(from.filter.layer), from.filter.ignores};
        to.sensor = from.sensor;
        to.density = static_cast<Real>(density_of(scene, desc, from));
    }
    if (desc.mass)
        def.mass = static_cast<Real>(*desc.mass);
    if (desc.center_of_mass)
        def.center_of_mass = Vec3{*desc.center_of_mass};
    if (desc.inertia)
        def.inertia = Vec3{*desc.inertia};
    def.pose = {Vec3{desc.position}, unit(Quat{desc.orientation})};
    if (desc.mass_pose)
        def.mass_pose = {Vec3{desc.mass_pose->position}, unit(Quat{desc.mass_pose->orientation})};
    def.velocity = Vec3{desc.velocity};
    def.angular_velocity = Vec3{desc.angular_velocity};
    def.locked = desc.locked;
    def.gravity_scale = static_cast<Real>(desc.gravity_scale);
    def.force = Vec3{desc.force};
    def.torque = Vec3{desc.torque};
    def.linear_damping = static_cast<Real>(desc.linear_damping);
    def.angular_damping = static_cast<Real>(desc.angular_damping);
    return def;
}

} // namespace plumb::inline PLUMB_PRECISION
