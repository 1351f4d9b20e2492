// How joints' forces stiffen the bodies that they act on, and what is done about it.
#include "engine/dynamics/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The largest rate times substep that a single pass of Gauss-Seidel follows, measured with balls on
// arms.
constexpr Real followed = Real(1.2);

// Joints that are further from holding than this share of their arms, or as many radians, have been
// torn apart: they are pulled together softly.
constexpr Real torn_share = Real(0.001);

bool is_torn(const RowBlock &rows) {
    const Real most = torn_share * size_of(rows);
    return !(glm::dot(rows.error, rows.error) <= most * most);
}

// What the impulses of the last substep do to the bodies at their ends.
void find_stiffness(const StepContext &context, Real h,
                    std::vector<GeometricStiffness> &stiffness) {
    stiffness.resize(context.bodies.size());
    for (const JointConstraint &joint : context.scratch.joints) {
        if (joint.rows.kind == RowKind::angular)
            continue;
        const Vec3 force = world_impulse(joint.rows, joint.impulse) / h;
        if (joint.moves_a)
            stiffness[joint.a].add(-force, joint.rows.r_a);
        if (joint.moves_b)
            stiffness[joint.b].add(force, joint.rows.r_b);
    }
}

// For the present substep; a body that bears less again is as it was. Says whether anything
// changed.
bool raise_inertia(SolverBody &motion, const Body &body, const GeometricStiffness &stiffness,
                   Real h) {
    // What cannot move as a joint asks (a locked axis) bears ever more, the heavier it is made.
    constexpr Real most = Real(1e3);
    const Vec3 needed =
        (h * h / (followed * followed)) * axial_stiffness(stiffness, body.inertia, motion.rotation);
    // The inertia of a body that is not a ball was found anew when it turned.
    if (!(squared_rate(needed, body.inertia) > Real(1)) && !is_isotropic(body.inertia))
        return false;
    Body heavier = body;
    for (int axis = 0; axis < 3; ++axis)
        heavier.inv_inertia[axis] = std::min(
            body.inv_inertia[axis], Real(1) / std::min(needed[axis], most * body.inertia[axis]));
    const Mat3 before = motion.inv_inertia;
    motion.inv_inertia = solver_inverse_inertia(heavier, motion.rotation);
    return motion.inv_inertia != before;
}

} // namespace

void follow_loads(StepContext &context, Real h) {
    std::vector<GeometricStiffness> &stiffness = context.scratch.stiffness;
    stiffness.clear();
    if (context.scratch.joints.empty())
        return;
    find_stiffness(context, h, stiffness);
    std::vector<std::uint8_t> &changed = context.scratch.changed;
    changed.assign(context.bodies.size(), 0);
    for (const std::uint32_t i : context.moving())
        if (context.model.bodies[i].kind == BodyKind::dynamic && stiffness[i].most > Real(0))
            changed[i] =
                raise_inertia(context.bodies[i], context.model.bodies[i], stiffness[i], h) ? 1 : 0;

    JointSystem &system = context.scratch.joint_system;
    for (JointGroup &group : system.groups()) {
        group.is_held = true;
        for (std::uint32_t place = group.first; group.is_held && place < group.last; ++place)
            group.is_held = !is_torn(context.scratch.joints[system.block(place)].rows);
        group.was_torn = group.was_torn || !group.is_held;
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
