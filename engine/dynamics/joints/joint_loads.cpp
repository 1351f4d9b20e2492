// How joint forces stiffen the bodies they act on, and what is done about it.
#include "engine/dynamics/joints/joint_bearings.h"
#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The largest rate times substep that a single Gauss-Seidel pass follows, measured with balls on
// arms.
constexpr Real followed = Real(1.2);

// Joints with an error of more than this share of their arms, or this many radians, have been torn
// apart.
constexpr Real torn_share = Real(0.05);

bool is_torn(const JointConstraint &joint) {
    const Real most = torn_share * joint.size;
    Vec3 error = joint.rows.error;
    if (joint.bearing != Bearing::none) // has been reached at any speed
        error.z = Real(0);
    return !(glm::dot(error, error) <= most * most);
}

// Whether a group hangs from more than one place. Only then can it be out of reach of one: no
// impulse would bring its torn joints together, so they are pulled softly. All others are held at
// any error, because Gauss-Seidel may feed energy into joints with long arms.
bool hangs_from_several(const StepContext &context, const JointGroup &group) {
    const auto is_place = [&](std::uint32_t body) {
        return body == Joint::world || context.model.bodies[body].kind != BodyKind::dynamic;
    };
    std::optional<std::uint32_t> first;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        const JointConstraint &joint =
            context.scratch.joints[context.scratch.joint_system->block(place)];
        if (!is_place(joint.a) && !is_place(joint.b))
            continue;
        if (first.value_or(joint.joint) != joint.joint)
            return true;
        first = joint.joint;
    }
    return false;
}

// Calls use(body, force, arm) for the last substep's impulses on the bodies at their ends.
template <typename Use> void for_forces(const StepContext &context, Real h, Use &&use) {
    for (const JointConstraint &joint : context.scratch.joints) {
        if (joint.rows.kind == RowKind::angular)
            continue;
        const Vec3 force = world_impulse(joint.rows, joint.impulse) / h;
        if (joint.moves_a)
            use(joint.a, -force, joint.rows.r_a);
        if (joint.moves_b)
            use(joint.b, force, joint.rows.r_b);
    }
}

// Whether a stiffness may be too much for the substep to follow; for most bodies its bound alone
// rules that out.
Real followed_rate(Real h) {
    return h * h / (followed * followed);
}
bool may_be_too_stiff(const GeometricStiffness &stiffness, const Vec3 &inertia, Real h) {
    constexpr Real nearly = Real(0.99); // for rounding
    return !(squared_rate(Vec3{followed_rate(h) * stiffness.most}, inertia) < nearly);
}

// Sets the inertia for the present substep; a body under less load gets its own back. Returns
// whether anything changed.
bool raise_inertia(SolverBody &motion, const Body &body, const GeometricStiffness &stiffness,
                   Real h) {
    // A body that cannot move as a joint asks (a locked axis) takes ever more load the heavier it
    // is made.
    constexpr Real most = Real(1e3);
    const Vec3 needed =
        followed_rate(h) * axial_stiffness(stiffness, body.inertia, motion.rotation);
    Vec3 inverse = body.inv_inertia;
    if (squared_rate(needed, body.inertia) > Real(1)) {
        for (int axis = 0; axis < 3; ++axis)
            inverse[axis] = std::min(inverse[axis],
                                     Real(1) / std::min(needed[axis], most * body.inertia[axis]));
    } else if (!is_isotropic(body.inertia)) {
        return false; // was recomputed when the body turned
    }
    const Mat3 before = motion.inv_inertia;
    motion.inv_inertia = solver_inverse_inertia(body, inverse, motion.rotation);
    return motion.inv_inertia != before;
}

// For all bodies that joint forces act on. Marks those that changed.
void raise_inertias(StepContext &context, Real h) {
    std::vector<GeometricStiffness> &stiffness = context.scratch.stiffness;
    std::vector<std::uint8_t> &changed = context.scratch.changed;
    stiffness.resize(context.bodies.size());
    changed.assign(context.bodies.size(), 0);
    for_forces(context, h, [&](std::uint32_t body, const Vec3 &force, const Vec3 &arm) {
        stiffness[body].add_bound(force, arm);
    });
    bool needs_tensors = false;
    for (const std::uint32_t i : context.moving()) {
        const Body &body = context.model.bodies[i];
        if (body.kind != BodyKind::dynamic || !(stiffness[i].most > Real(0)))
            continue;
        const bool is_ball = is_isotropic(body.inertia);
        changed[i] = is_ball || may_be_too_stiff(stiffness[i], body.inertia, h) ? 1 : 0;
        needs_tensors = needs_tensors || (changed[i] != 0 && !is_ball);
    }
    if (needs_tensors)
        for_forces(context, h, [&](std::uint32_t body, const Vec3 &force, const Vec3 &arm) {
            if (changed[body] != 0)
                stiffness[body].add_tensor(force, arm);
        });
    for (const std::uint32_t i : context.moving())
        if (changed[i] != 0)
            changed[i] =
                raise_inertia(context.bodies[i], context.model.bodies[i], stiffness[i], h) ? 1 : 0;
}

} // namespace

void follow_loads(StepContext &context, Real h) {
    context.scratch.stiffness.clear();
    if (context.scratch.joints.empty())
        return;
    raise_inertias(context, h);
    std::vector<std::uint8_t> &changed = context.scratch.changed;
    JointSystem &system = *context.scratch.joint_system;
    for (JointGroup &group : system.groups()) {
        bool torn = false;
        for (std::uint32_t place = group.first; !torn && place < group.last; ++place)
            torn = is_torn(context.scratch.joints[system.block(place)]);
        group.is_held = !torn || !hangs_from_several(context, group);
        // What held it no longer does, and would fling its bodies about.
        if (!group.is_held && !group.was_torn)
            for (std::uint32_t place = group.first; place < group.last; ++place)
                context.scratch.joints[system.block(place)].impulse = Vec3{Real(0)};
        // Torn in the middle of a step: the cause may need more substeps.
        group.was_let_go =
            group.was_let_go || (!group.is_held && group.is_factored && !group.was_torn);
        group.was_torn = group.was_torn || !group.is_held;
        const auto for_all_bodies = [&](auto &&use) {
            for (std::uint32_t place = group.first; place < group.last; ++place) {
                const JointConstraint &joint = context.scratch.joints[system.block(place)];
                for (const std::uint32_t body : {joint.a, joint.b})
                    if (body != Joint::world)
                        use(changed[body]);
            }
        };
        bool is_changed =
            choose_bearings(context, group, Real(1)) || group.is_held != group.is_factored;
        for_all_bodies([&](std::uint8_t one) { is_changed = is_changed || one != 0; });
        if (is_changed)
            for_all_bodies([](std::uint8_t &one) { one = 1; });
        for (std::uint32_t place = group.first; place < group.last; ++place)
            context.scratch.joints[system.block(place)].is_held = group.is_held;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
