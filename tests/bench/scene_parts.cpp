#include "tests/bench/scene_parts.h"

#include <cmath>

namespace plumb::parts {

BodyDesc &add(SceneDesc &scene, const std::string &what, ShapeDesc shape,
              const glm::dvec3 &position) {
    BodyDesc &body = scene.bodies.emplace_back();
    body.name = what + '_' + std::to_string(scene.bodies.size() - 1);
    body.colliders.emplace_back().shape = std::move(shape);
    body.position = position;
    if (!scene.materials.empty())
        body.material = scene.materials.front().name;
    return body;
}

SceneDesc on_ground() {
    SceneDesc scene;
    add(scene, "ground", PlaneDesc{}, {0, 0, 0}).kind = BodyKind::static_body;
    return scene;
}

void set_material(SceneDesc &scene, double friction, double restitution) {
    scene.materials.clear(); // replaced
    MaterialDesc &material = scene.materials.emplace_back();
    material.name = "all";
    material.friction = friction;
    material.restitution = restitution;
    for (BodyDesc &body : scene.bodies)
        body.material = "all";
}

void add_joint(SceneDesc &scene, JointType type, std::size_t a, std::size_t b,
               const glm::dvec3 &at) {
    JointDesc &joint = scene.joints.emplace_back();
    joint.name = "joint_" + std::to_string(scene.joints.size() - 1);
    joint.type = type;
    const glm::dquat frame(std::sqrt(0.5), 0, -std::sqrt(0.5), 0); // maps x to the world's z
    const auto attach = [&](std::size_t index, std::string &name, glm::dvec3 &anchor,
                            glm::dquat &local) {
        anchor = at;
        local = frame;
        if (index == the_world)
            return;
        const BodyDesc &body = scene.bodies[index];
        const glm::dquat inverse = glm::conjugate(body.orientation);
        name = body.name;
        anchor = inverse * (at - body.position);
        local = inverse * frame;
    };
    attach(a, joint.body_a, joint.anchor_a_local, joint.frame_a_local);
    attach(b, joint.body_b, joint.anchor_b_local, joint.frame_b_local);
}

glm::dquat from_y_to(const glm::dvec3 &direction) {
    const glm::dvec3 axis = glm::cross(glm::dvec3(0, 1, 0), direction);
    return glm::normalize(glm::dquat(1 + direction.y, axis.x, axis.y, axis.z));
}

void add_pyramid(SceneDesc &scene, int base, double z) {
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i)
            add(scene, "box", BoxDesc{}, {1.05 * (i - 0.5 * (base - row - 1)), 0.5 + row, z});
}

void add_net(SceneDesc &scene, int side, bool by_edge) {
    const std::size_t first = scene.bodies.size();
    for (int z = 0; z < side; ++z)
        for (int x = 0; x < side; ++x) {
            BodyDesc &ball = add(scene, "ball", SphereDesc{0.1}, glm::dvec3(x, 0, z));
            ball.mass = 1;
            const std::size_t here = scene.bodies.size() - 1;
            if (x > 0)
                add_joint(scene, JointType::ball, here - 1, here, {x - 0.5, 0, z});
            if (z > 0)
                add_joint(scene, JointType::ball, here - static_cast<std::size_t>(side), here,
                          {x, 0, z - 0.5});
        }
    for (int x = 0; x < side; ++x)
        if (by_edge || x == 0 || x == side - 1)
            add_joint(scene, JointType::ball, the_world, first + static_cast<std::size_t>(x),
                      {x, 0, -0.5});
}

void add_ragdoll(SceneDesc &scene, const glm::dvec3 &at) {
    const std::size_t pelvis = scene.bodies.size();
    const auto part = [&](const char *name, ShapeDesc shape, double x, double z, double mass) {
        add(scene, name, std::move(shape), at + glm::dvec3(x, 0, z)).mass = mass;
        return scene.bodies.size() - 1;
    };
    const auto limb = [&](const char *name, double half_height, double radius, double x, double z,
                          double mass) {
        const std::size_t index = part(name, CapsuleDesc{half_height, radius}, x, z, mass);
        scene.bodies[index].orientation = from_y_to({1, 0, 0}); // feet at x = 0
        return index;
    };
    const auto join = [&](JointType type, std::size_t a, std::size_t b, double x, double z) {
        add_joint(scene, type, a, b, at + glm::dvec3(x, 0, z));
    };
    part("pelvis", BoxDesc{{0.1, 0.09, 0.16}}, 0.95, 0, 12);
    const std::size_t chest = part("chest", BoxDesc{{0.19, 0.1, 0.18}}, 1.27, 0, 22);
    const std::size_t head = part("head", SphereDesc{0.11}, 1.63, 0, 5);
    join(JointType::ball, pelvis, chest, 1.06, 0);
    join(JointType::ball, chest, head, 1.49, 0);
    for (const double side : {-1.0, 1.0}) {
        const std::size_t thigh = limb("thigh", 0.13, 0.07, 0.65, 0.1 * side, 8);
        const std::size_t shin = limb("shin", 0.15, 0.05, 0.22, 0.1 * side, 4);
        join(JointType::ball, pelvis, thigh, 0.85, 0.1 * side);
        join(JointType::hinge, thigh, shin, 0.435, 0.1 * side);
        const std::size_t upper = limb("upper_arm", 0.09, 0.045, 1.26, 0.25 * side, 2);
        const std::size_t lower = limb("lower_arm", 0.09, 0.04, 0.98, 0.25 * side, 1.5);
        join(JointType::ball, chest, upper, 1.4, 0.25 * side);
        join(JointType::hinge, upper, lower, 1.12, 0.25 * side);
    }
}

} // namespace plumb::parts
