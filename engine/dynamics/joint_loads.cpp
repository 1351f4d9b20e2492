// How joints' forces stiffen the bodies that they act on, and what is done about it.
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The largest rate times substep that a single pass of Gauss-Seidel follows, measured with balls on
// arms; and the largest that joints solved together follow, short of the 2 of every explicit rule
// of second order.
constexpr Real inertia_alone = Real(1.2);
constexpr Real inertia_together = Real(1.7);

// Joints that are further from holding than this share of their arms, or as many radians, have been
// torn apart: they are pulled together softly.
constexpr Real torn_share = Real(0.001);

Real least(const Vec3 &v) {
    return std::min({v.x, v.y, v.z});
}

bool is_torn(const RowBlock &rows) {
    const Real most = torn_share * size_of(rows);
    return !(glm::dot(rows.error, rows.error) <= most * most);
}

// use(body, F r) for each end of a joint that moves by forces; `share` of the substep's impulse is
// in joint.impulse.
template <typename Use>
void for_each_end(const JointConstraint &joint, Real h, Real share, Use &&use) {
    if (joint.rows.kind == RowKind::angular)
        return;
    const Real force = glm::length(joint.impulse) / (share * h);
    if (joint.moves_a)
        use(joint.a, force * glm::length(joint.rows.r_a));
    if (joint.moves_b)
        use(joint.b, force * glm::length(joint.rows.r_b));
}

// The least inertia that substeps of h follow.
Real needed_inertia(Real stiffness, Real h, Real followed) {
    return stiffness * h * h / (followed * followed);
}

bool is_followed(const Body &body, Real stiffness, Real h) {
    return needed_inertia(stiffness, h, inertia_together) <= least(body.inertia);
}

// For the present substep; a body that bears less again is as it was. Says whether anything
// changed.
bool raise_inertia(SolverBody &motion, const Body &body, Real stiffness, Real h) {
    // What cannot move as a joint asks (a locked axis) bears ever more, the heavier it is made.
    constexpr Real most = Real(1e3);
    const Real needed =
        std::min(needed_inertia(stiffness, h, inertia_alone), most * least(body.inertia));
    // The inertia of a body that is not a ball was found anew when it turned.
    if (!(needed > least(body.inertia)) && !is_isotropic(body.inertia))
        return false;
    Body heavier = body;
    for (int axis = 0; axis < 3; ++axis)
        heavier.inv_inertia[axis] = std::min(body.inv_inertia[axis], Real(1) / needed);
    const Mat3 before = motion.inv_inertia;
    motion.inv_inertia = solver_inverse_inertia(heavier, motion.rotation);
    return motion.inv_inertia != before;
}

} // namespace

void joint_stiffness(StepContext &context, Real h, std::vector<Real> &stiffness) {
    stiffness.assign(context.bodies.size(), Real(0));
    for (const JointConstraint &joint : context.scratch.joints)
        for_each_end(joint, h, Real(1),
                     [&](std::uint32_t body, Real more) { stiffness[body] += more; });
}

bool can_follow(StepContext &context, const JointGroup &group, Real h) {
    const JointSystem &system = context.scratch.joint_system;
    std::vector<Real> &stiffness = context.scratch.stiffness;
    const auto for_all_ends = [&](auto &&use) {
        for (std::uint32_t place = group.first; place < group.last; ++place)
            for_each_end(context.scratch.joints[system.block(place)], h, Real(0.5), use);
    };
    bool follows = true;
    for_all_ends([&](std::uint32_t body, Real) { stiffness[body] = Real(0); });
    for_all_ends([&](std::uint32_t body, Real more) { stiffness[body] += more; });
    for_all_ends([&](std::uint32_t body, Real) {
        follows = follows && is_followed(context.model.bodies[body], stiffness[body], h);
    });
    return follows;
}

void follow_loads(StepContext &context, Real h) {
    std::vector<Real> &stiffness = context.scratch.stiffness;
    stiffness.clear();
    if (context.scratch.joints.empty())
        return;
    joint_stiffness(context, h, stiffness);
    std::vector<std::uint8_t> &changed = context.scratch.changed;
    changed.assign(context.bodies.size(), 0);
    for (const std::uint32_t i : context.moving())
        if (context.model.bodies[i].kind == BodyKind::dynamic && stiffness[i] > Real(0))
            changed[i] =
                raise_inertia(context.bodies[i], context.model.bodies[i], stiffness[i], h) ? 1 : 0;

    JointSystem &system = context.scratch.joint_system;
    for (JointGroup &group : system.groups()) {
        group.is_held = true;
        for (std::uint32_t place = group.first; group.is_held && place < group.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            const auto follows = [&](std::uint32_t body) {
                return body == Joint::world ||
                       is_followed(context.model.bodies[body], stiffness[body], h);
            };
            group.is_held = !is_torn(joint.rows) && follows(joint.a) && follows(joint.b);
        }
        const auto for_all_bodies = [&](auto &&use) {
            for (std::uint32_t place = group.first; place < group.last; ++place) {
                const JointConstraint &joint = context.scratch.joints[system.block(place)];
                for (const std::uint32_t body : {joint.a, joint.b})
                    if (body != Joint::world)
                        use(changed[body]);
            }
        };
        bool is_changed = group.is_held != group.is_factored;
        for_all_bodies([&](std::uint8_t one) { is_changed = is_changed || one != 0; });
        if (is_changed)
            for_all_bodies([](std::uint8_t &one) { one = 1; });
        for (std::uint32_t place = group.first; place < group.last; ++place)
            context.scratch.joints[system.block(place)].is_held = group.is_held;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
