#include "engine/scene/real/read_world.h"

#include "engine/dynamics/world.h"
#include "engine/math/basis.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void read_contacts(const World &world, std::vector<ContactView> &views) {
    for (const Contact &contact : world.contacts()) {
        const double rate = world.substeps_of(world.island_body(contact.key.a, contact.key.b)) /
                            world.settings().dt;
        const TangentBasis basis = tangent_basis(contact.manifold.normal);
        for (int k = 0; k < contact.manifold.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const ManifoldPoint &point = contact.manifold.points[index];
            const Vec3 &impulse = contact.impulses[index];
            ContactView &view = views.emplace_back();
            view.body_a = contact.key.a;
            view.body_b = contact.key.b;
            view.child_a = contact.key.child_a;
            view.child_b = contact.key.child_b;
            if (contact.key.triangle < ContactKey::inside)
                view.triangle = contact.key.triangle;
            view.feature = point.feature;
            view.is_sensor = contact.sensor;
            view.position = glm::dvec3{point.position};
            view.normal = glm::dvec3{contact.manifold.normal};
            view.separation = static_cast<double>(point.separation);
            view.normal_force = static_cast<double>(impulse.x) * rate;
            view.friction_force = rate * glm::dvec3{impulse.y * basis.t1 + impulse.z * basis.t2};
        }
    }
}

JointView joint_view(const World &world, const JointDesc &desc, std::uint32_t i) {
    const Joint &joint = world.joints()[i];
    const Motion &a = world.joint_motion(joint.a);
    const Motion &b = world.joint_motion(joint.b);
    JointView view;
    view.joint = i;
    view.type = joint.type;
    if (joint.a != Joint::world)
        view.body_a = joint.a;
    if (joint.b != Joint::world)
        view.body_b = joint.b;
    view.anchor_a = glm::dvec3{world.anchor_a(joint)};
    view.anchor_b = glm::dvec3{world.anchor_b(joint)};
    view.frame_a = glm::dquat{a.rotation * joint.frame_a_local};
    view.frame_b = glm::dquat{b.rotation * joint.frame_b_local};
    view.limits = desc.limits;
    view.motor_speed = desc.motor_speed;
    view.max_motor_force = desc.max_motor_force;
    view.frequency = desc.frequency;
    view.break_force = desc.break_force;
    view.broken = world.state().joints[i].broken;
    const JointError error = world.joint_errors(i);
    view.drift = static_cast<double>(error.linear);
    view.angle_drift = static_cast<double>(error.angular);
    const JointPlace place = place_of(joint, a, b);
    view.position = static_cast<double>(place.position);
    view.speed = static_cast<double>(place.speed);
    if (desc.max_length > 0)
        view.limits = {desc.min_length, desc.max_length};
    const World::JointLoad load = world.joint_load(i);
    view.force = glm::dvec3{load.force};
    view.torque = glm::dvec3{load.torque};
    const double rate =
        world.substeps_of(world.island_body(joint.a, joint.b)) / world.settings().dt;
    view.motor_force =
        desc.motor_speed ? rate * static_cast<double>(world.state().joints[i].impulses.back()) : 0;
    return view;
}

} // namespace

BodyState body_state(const World &world, std::uint32_t body) {
    const Motion &motion = world.motions()[body];
    const Transform pose = world.pose_of(body);
    return {glm::dvec3{pose.position}, glm::dquat{pose.rotation}, glm::dvec3{motion.velocity},
            glm::dvec3{motion.angular_velocity}, world.state().paces[body].is_asleep()};
}

void read_world(const World &world, std::span<const JointDesc> joints, Frame &into,
                const FrameParts &parts) {
    into.step_count = world.step_count();
    into.time = world.time();
    into.bodies.resize(world.motions().size());
    for (std::uint32_t i = 0; i < into.bodies.size(); ++i)
        into.bodies[i] = body_state(world, i);
    const State &state = world.state();
    into.particles.resize(state.particles.size());
    for (std::size_t i = 0; i < into.particles.size(); ++i)
        into.particles[i] = {glm::dvec3{state.particles[i].position},
                             glm::dvec3{state.particles[i].velocity}};
    into.torn.assign(state.torn.begin(), state.torn.end());
    into.joints.clear();
    for (std::uint32_t i = 0; parts.joints && i < world.joints().size(); ++i)
        if (world.joints()[i].alive)
            into.joints.push_back(joint_view(world, joints[i], i));
    into.contacts.clear();
    if (parts.contacts)
        read_contacts(world, into.contacts);
    into.impacts.clear();
    if (parts.impacts)
        for (const Impact &impact : world.impacts())
            into.impacts.push_back({impact.key.a, impact.key.b, glm::dvec3{impact.position},
                                    glm::dvec3{impact.normal},
                                    static_cast<double>(impact.impulse)});
}

} // namespace plumb::inline PLUMB_PRECISION
