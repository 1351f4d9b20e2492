#include "engine/dynamics/joint_constraint.h"

#include "engine/core/collect.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Of joints that are solved together, as a share of what their own blocks give way: enough for
// joints that say the same twice, too little to be seen.
constexpr Real held_compliance = Real(1e-3);

// K of a point-to-point constraint: (1/ma + 1/mb) 1 - [ra] Ia^-1 [ra] - [rb] Ib^-1 [rb]
// (Catto 2009, "Modeling and Solving Constraints", slide 52, in 3D).
Mat3 point_matrix(const SolverBody &a, const SolverBody &b, const Vec3 &r_a, const Vec3 &r_b) {
    const Mat3 ra = cross_matrix(r_a);
    const Mat3 rb = cross_matrix(r_b);
    Mat3 linear{Real(0)};
    for (int i = 0; i < 3; ++i)
        linear[i][i] = a.inv_mass[i] + b.inv_mass[i];
    return linear - ra * a.inv_inertia * ra - rb * b.inv_inertia * rb;
}

// K between two rows: u^T K v (Baraff 1996, "Linear-Time Dynamics using Lagrange Multipliers").
Real row_coupling(const RowBlock &rows, const SolverBody &a, const SolverBody &b, const Vec3 &u,
                  const Vec3 &v) {
    if (rows.kind == RowKind::angular)
        return glm::dot(u, a.inv_inertia * v) + glm::dot(u, b.inv_inertia * v);
    return glm::dot(u, (a.inv_mass + b.inv_mass) * v) +
           glm::dot(a.inv_inertia * glm::cross(rows.r_a, u), glm::cross(rows.r_a, v)) +
           glm::dot(b.inv_inertia * glm::cross(rows.r_b, u), glm::cross(rows.r_b, v));
}

// The inverse of a symmetric matrix that is not negative. Where nothing can move along some
// direction (a locked axis), a trace's rounding stands for the zero: no impulse goes that way.
Mat3 inverse_of(Mat3 k) {
    const Real trace = k[0][0] + k[1][1] + k[2][2];
    if (!(trace > Real(0)))
        return Mat3{Real(0)};
    const Real size = trace / Real(3);
    const Real least = Real(64) * std::numeric_limits<Real>::epsilon();
    if (!(glm::determinant(k) > least * size * size * size))
        for (int i = 0; i < 3; ++i)
            k[i][i] += Real(1e-3) * size;
    return glm::inverse(k);
}

Mat3 mass_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b) {
    if (rows.kind == RowKind::point)
        return inverse_of(point_matrix(a, b, rows.r_a, rows.r_b));
    if (rows.count == 1) {
        const Real k = rows.kind == RowKind::linear
                           ? inverse_effective_mass(a, b, rows.r_a, rows.r_b, rows.axes[0])
                           : row_coupling(rows, a, b, rows.axes[0], rows.axes[0]);
        Mat3 mass{Real(0)};
        mass[0][0] = k > Real(0) ? Real(1) / k : Real(0);
        return mass;
    }
    Mat3 k{Real(0)};
    for (int i = 0; i < rows.count; ++i)
        for (int j = 0; j <= i; ++j)
            k[i][j] = k[j][i] = row_coupling(rows, a, b, rows.axes[static_cast<std::size_t>(i)],
                                             rows.axes[static_cast<std::size_t>(j)]);
    Mat3 mass{Real(0)};
    if (rows.count == 2) {
        const Real determinant = k[0][0] * k[1][1] - k[1][0] * k[0][1];
        const Real size = Real(0.5) * (k[0][0] + k[1][1]);
        if (determinant > Real(1e-6) * size * size) {
            mass[0][0] = k[1][1] / determinant;
            mass[1][1] = k[0][0] / determinant;
            mass[1][0] = mass[0][1] = -k[1][0] / determinant;
        } else {
            for (int i = 0; i < 2; ++i)
                mass[i][i] = k[i][i] > Real(0) ? Real(1) / (k[0][0] + k[1][1]) : Real(0);
        }
    } else {
        mass = inverse_of(k);
    }
    return mass;
}

// The mean velocity over h, because it turns, of the end of an arm that starts as r: the chord of
// its circle, ((exp(h [w]) - 1) r) / h (Rodrigues).
Vec3 chord_velocity(const Vec3 &angular_velocity, const Vec3 &r, Real h) {
    const Real squared = h * h * glm::dot(angular_velocity, angular_velocity);
    Real along = Real(1) - squared / Real(6) * (Real(1) - squared / Real(20));
    Real inward = Real(0.5) - squared / Real(24) * (Real(1) - squared / Real(30));
    if (squared > Real(0.04)) { // the series' next terms show
        const Real angle = std::sqrt(squared);
        along = std::sin(angle) / angle;
        inward = (Real(1) - std::cos(angle)) / squared;
    }
    const Vec3 turning = glm::cross(angular_velocity, r);
    return along * turning + (inward * h) * glm::cross(angular_velocity, turning);
}

// How fast the rows' errors grow.
Vec3 row_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                  const JointPass &pass) {
    if (rows.kind == RowKind::angular) {
        const Vec3 turning = b.angular_velocity - a.angular_velocity;
        Vec3 v{Real(0)};
        for (int i = 0; i < rows.count; ++i)
            v[i] = glm::dot(rows.axes[static_cast<std::size_t>(i)], turning);
        return v;
    }
    Vec3 relative = b.velocity_at(rows.r_b) - a.velocity_at(rows.r_a);
    if (pass.at_the_end) {
        // The mean over h of the anchors' relative velocity.
        const Vec3 now = relative;
        relative =
            (b.velocity - a.velocity) + (chord_velocity(b.angular_velocity, rows.r_b, pass.h) -
                                         chord_velocity(a.angular_velocity, rows.r_a, pass.h));
        if (rows.turns_with_a)
            relative += chord_velocity(-a.angular_velocity, pass.h * now, pass.h);
    }
    if (rows.kind == RowKind::point)
        return relative;
    Vec3 v{Real(0)};
    for (int i = 0; i < rows.count; ++i)
        v[i] = glm::dot(rows.axes[static_cast<std::size_t>(i)], relative);
    if (pass.at_the_end && rows.swing_length > Real(0)) {
        // How much longer the line between the anchors becomes while they swing aside.
        const Real distance = rows.swing_length;
        const Vec3 aside = pass.h * (relative - v.x * rows.axes[0]);
        const Real squared = std::min(glm::dot(aside, aside), distance * distance);
        v.x += squared / (distance + std::sqrt(distance * distance - squared)) / pass.h;
    }
    return v;
}

void apply(SolverBody &body, const RowBlock &rows, const Vec3 &arm, const Vec3 &impulse) {
    if (rows.kind == RowKind::point) {
        body.apply_impulse(impulse, arm);
        return;
    }
    Vec3 sum = impulse.x * rows.axes[0];
    for (int i = 1; i < rows.count; ++i)
        sum += impulse[i] * rows.axes[static_cast<std::size_t>(i)];
    if (rows.kind == RowKind::angular)
        body.apply_angular_impulse(sum);
    else
        body.apply_impulse(sum, arm);
}

// What does not move by forces is not written to: joints of other bodies, that are solved at the
// same time, hang on it, too.
void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    if (joint.moves_a)
        apply(context.body(joint.a), joint.rows, joint.rows.r_a, -impulse);
    if (joint.moves_b)
        apply(context.body(joint.b), joint.rows, joint.rows.r_b, impulse);
}

// The change of a limit's impulse; `side` is 1 for a lower limit, whose impulse is never negative,
// and -1 for an upper one.
Real limit_change(const JointConstraint &joint, Real speed, const Softness &softness,
                  const JointPass &pass, Real side) {
    const Real gap = side * joint.rows.error.x;
    const Real impulse = side * joint.impulse.x;
    const bool is_off = gap > Real(0);
    if (is_off && joint.is_spring())
        return -joint.impulse.x; // a slack spring does not pull
    if (is_off && pass.loaded_only && impulse == Real(0))
        return Real(0);
    const Softness used = is_off ? Softness{} : softness;
    const Real target = is_off ? gap / pass.h : used.bias_rate * gap;
    const Real change = -used.mass_scale * joint.mass[0][0] * (side * speed + target) -
                        used.impulse_scale * impulse;
    return side * (std::max(impulse + change, Real(0)) - impulse);
}

Vec3 pushed(const Vec3 &bias, Real most) {
    const Real speed = glm::length(bias);
    return speed > most ? (most / speed) * bias : bias;
}

Vec3 impulse_change(const JointConstraint &joint, const SolverBody &a, const SolverBody &b,
                    const JointPass &pass) {
    const RowBlock &rows = joint.rows;
    const Softness softness = joint.is_spring()
                                  ? make_soft(rows.frequency, rows.damping_ratio, pass.spring_time)
                                  : pass.softness;
    const Vec3 v = row_velocity(rows, a, b, pass);
    const Real most =
        joint.is_spring() ? std::numeric_limits<Real>::infinity() : pass.push_velocity;
    const auto towards = [&](const Vec3 &error) {
        if (rows.count == 1)
            return Vec3{-softness.mass_scale * joint.mass[0][0] *
                                (v.x + std::clamp(softness.bias_rate * error.x, -most, most)) -
                            softness.impulse_scale * joint.impulse.x,
                        Real(0), Real(0)};
        return -softness.mass_scale *
                   (joint.mass * (v + pushed(softness.bias_rate * error, most))) -
               softness.impulse_scale * joint.impulse;
    };
    switch (rows.bounds) {
    case RowBounds::equal:
        return towards(rows.error);
    case RowBounds::at_least:
        return {limit_change(joint, v.x, softness, pass, Real(1)), Real(0), Real(0)};
    case RowBounds::at_most:
        return {limit_change(joint, v.x, softness, pass, Real(-1)), Real(0), Real(0)};
    case RowBounds::motor: {
        const Real limit = rows.max_force * pass.h * pass.force_share;
        const Real change = -joint.mass[0][0] * (v.x - rows.speed);
        return {std::clamp(joint.impulse.x + change, -limit, limit) - joint.impulse.x, Real(0),
                Real(0)};
    }
    case RowBounds::pull: {
        const Real limit = rows.max_force * pass.h * pass.force_share;
        Vec3 total = joint.impulse + towards(rows.error);
        const Real length = glm::length(total);
        if (length > limit)
            total *= limit / length;
        return total - joint.impulse;
    }
    }
    return Vec3{Real(0)};
}

Vec3 memory_of(const StepContext &context, const JointConstraint &constraint) {
    if (constraint.joint == JointConstraint::grab)
        return context.grab.impulse;
    const auto &impulses = context.joints[constraint.joint].impulses;
    Vec3 memory{Real(0)};
    for (int i = 0; i < constraint.rows.count; ++i)
        memory[i] = impulses[constraint.rows.first_memory + static_cast<std::size_t>(i)];
    return memory;
}

// The right-hand sides of a group's equations, its own among those of all.
std::span<Vec3> sides_of(StepContext &context, const JointGroup &group) {
    return std::span(context.scratch.sides).subspan(group.first, group.last - group.first);
}

// All rows of a group at once. Where bodies turn far within the substep, the ends of their arms
// move along circles, and it takes some of Newton's steps until they meet.
void solve_group(StepContext &context, const JointGroup &group, const JointPass &pass) {
    const JointSystem &system = context.scratch.joint_system;
    const std::span<Vec3> sides = sides_of(context, group);
    // Far more than it takes when a body turns a radian within the substep.
    constexpr int most_steps = 8;
    constexpr Real tolerance = Real(1e-6); // of the arms' lengths
    for (int step = 0; step < (pass.at_the_end ? most_steps : 1); ++step) {
        bool holds = step > 0;
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            const JointConstraint &joint = context.scratch.joints[system.block(place)];
            Vec3 side =
                row_velocity(joint.rows, context.body(joint.a), context.body(joint.b), pass);
            if (pass.held_share > Real(0))
                side += pushed((pass.held_share / pass.h) * joint.rows.error, pass.push_velocity) +
                        system.softening(place) * joint.impulse;
            sides[place - group.first] = -side;
            const Real most = tolerance * size_of(joint.rows) / pass.h;
            holds = holds && glm::dot(side, side) <= most * most;
        }
        if (holds)
            return;
        system.solve(group, sides);
        for (std::uint32_t place = group.first; place < group.last; ++place) {
            JointConstraint &joint = context.scratch.joints[system.block(place)];
            const Vec3 &change = sides[place - group.first];
            joint.impulse += change;
            apply(context, joint, change);
        }
    }
}

// Leaves a group to Gauss-Seidel, from the half of the remembered impulses with which the substep
// began.
void let_go(StepContext &context, JointGroup &group) {
    const JointSystem &system = context.scratch.joint_system;
    group.is_held = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[system.block(place)];
        const Vec3 change = Real(0.5) * joint.remembered - joint.impulse;
        joint.impulse += change;
        apply(context, joint, change);
        joint.is_held = false;
        joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
    }
}

// What a group takes off the inverse mass of a row that is not of it, such as a limit's, when it
// answers to a unit impulse there: c^T K^-1 c, with c what the impulse does to the group's rows.
Real answered(StepContext &context, const JointConstraint &joint, const JointGroup &group) {
    const JointSystem &system = context.scratch.joint_system;
    const std::span<Vec3> sides = sides_of(context, group);
    const auto struck = [&](std::uint32_t body) {
        SolverBody motion = context.body(body);
        motion.velocity = motion.angular_velocity = Vec3{Real(0)};
        return motion;
    };
    SolverBody a = struck(joint.a);
    SolverBody b = struck(joint.b);
    apply(a, joint.rows, joint.rows.r_a, Vec3{Real(-1), Real(0), Real(0)});
    apply(b, joint.rows, joint.rows.r_b, Vec3{Real(1), Real(0), Real(0)});
    const SolverBody still;
    const auto after = [&](std::uint32_t body) -> const SolverBody & {
        return body == Joint::world ? still : body == joint.a ? a : body == joint.b ? b : still;
    };
    const auto effect = [&](std::uint32_t place) {
        const JointConstraint &other = context.scratch.joints[system.block(place)];
        return row_velocity(other.rows, after(other.a), after(other.b), JointPass{});
    };
    for (std::uint32_t place = group.first; place < group.last; ++place)
        sides[place - group.first] = effect(place);
    system.solve(group, sides);
    Real sum = Real(0);
    for (std::uint32_t place = group.first; place < group.last; ++place)
        sum += glm::dot(effect(place), sides[place - group.first]);
    return sum;
}

bool is_changed(const StepContext &context, std::uint32_t body) {
    return body != Joint::world && context.scratch.changed[body] != 0;
}
bool is_changed(const StepContext &context, const JointConstraint &joint) {
    return is_changed(context, joint.a) || is_changed(context, joint.b);
}

// Limits and motors against bodies whose joints are solved together: as heavy as those make them.
void weigh_with_groups(StepContext &context, bool changed_only) {
    JointSystem &system = context.scratch.joint_system;
    if (system.groups().empty())
        return;
    for (JointConstraint &joint : context.scratch.joints) {
        if (changed_only && !is_changed(context, joint))
            continue;
        Real &mass = joint.mass[0][0];
        if (joint.is_held || joint.rows.count != 1 || joint.is_spring() || !(mass > Real(0)))
            continue;
        std::uint32_t last = JointSystem::none;
        Real inverse = Real(1) / mass;
        const Real least = Real(1e-3) * inverse;
        for (const std::uint32_t body : {joint.a, joint.b}) {
            const std::uint32_t group =
                body == Joint::world ? JointSystem::none : system.group_of(body);
            if (group == JointSystem::none || group == last || !system.groups()[group].is_held)
                continue;
            last = group;
            inverse -= answered(context, joint, system.groups()[group]);
        }
        mass = Real(1) / std::max(inverse, least);
    }
}

// Some microseconds of work.
constexpr std::size_t joints_a_part = 16;
constexpr std::size_t groups_a_part = 1;

// Calls use(joint, a, b, block) for the rows of the joints `first` to `last - 1` that hold, in
// order; the grab comes after the last joint.
template <typename Use>
void emit(StepContext &context, std::size_t first, std::size_t last, std::vector<RowBlock> &rows,
          Use &&use) {
    RowWriter writer(rows);
    const std::size_t count = context.active.joints.size();
    for (std::size_t k = first; k < last && k < count; ++k) {
        const std::uint32_t i = context.active.joints[k];
        const Joint &joint = context.model.joints[i];
        rows.clear();
        emit_rows(joint, context.body(joint.a), context.body(joint.b), writer);
        for (const RowBlock &block : rows)
            use(i, joint.a, joint.b, block);
    }
    if (last > count && context.active.holds_grab) {
        rows.clear();
        emit_rows(context.grab, context.world_frame, context.body(context.grab.body), writer);
        for (const RowBlock &block : rows)
            use(JointConstraint::grab, Joint::world, context.grab.body, block);
    }
}

std::size_t joints_and_grab(const StepContext &context) {
    return context.active.joints.size() + (context.active.holds_grab ? 1 : 0);
}

// Factors the groups that are held, and of which `is_due` says so.
template <typename Due> void factor_groups(StepContext &context, Due &&is_due) {
    JointSystem &system = context.scratch.joint_system;
    const std::span<JointGroup> groups = system.groups();
    for_parts(context.tasks, groups.size(), groups_a_part, [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin)) {
            group.is_factored = group.is_held;
            if (group.is_held && is_due(group))
                system.factor(context, group, held_compliance);
        }
    });
}

} // namespace

Real size_of(const RowBlock &rows) {
    return rows.kind == RowKind::angular
               ? Real(1)
               : glm::length(rows.r_a) + glm::length(rows.r_b) + rows.swing_length;
}

void prepare_joints(StepContext &context) {
    std::vector<JointConstraint> &constraints = context.scratch.joints;
    constraints.clear();
    context.scratch.joint_system.release();
    if (context.active.joints.empty() && !context.active.holds_grab)
        return;
    const auto is_dynamic = [&](std::uint32_t body) {
        return body != Joint::world && context.model.bodies[body].kind == BodyKind::dynamic;
    };
    const std::size_t count = joints_and_grab(context);
    context.scratch.rows.resize(part_count(context.tasks, count, joints_a_part));
    context.scratch.first_blocks.clear();
    for (std::size_t k = 0; k < count; ++k) {
        context.scratch.first_blocks.push_back(static_cast<std::uint32_t>(constraints.size()));
        emit(context, k, k + 1, context.scratch.rows.front(),
             [&](std::uint32_t joint, std::uint32_t a, std::uint32_t b, const RowBlock &block) {
                 JointConstraint &out = constraints.emplace_back();
                 out.joint = joint;
                 out.a = a;
                 out.b = b;
                 out.moves_a = is_dynamic(a);
                 out.moves_b = is_dynamic(b);
                 out.rows = block;
                 out.impulse = memory_of(context, out);
             });
    }
}

void refresh_joints(StepContext &context) {
    if (context.scratch.joints.empty())
        return;
    const auto refresh = [&](std::size_t begin, std::size_t end, std::size_t part) {
        JointConstraint *next = context.scratch.joints.data() + context.scratch.first_blocks[begin];
        emit(context, begin, end, context.scratch.rows[part],
             [&](std::uint32_t, std::uint32_t a, std::uint32_t b, const RowBlock &block) {
                 next->rows = block;
                 if (!next->is_held)
                     next->mass = mass_of(block, context.body(a), context.body(b));
                 ++next;
             });
    };
    for_counted_parts(context.tasks, joints_and_grab(context), joints_a_part, refresh);
    factor_groups(context, [](const JointGroup &) { return true; });
    weigh_with_groups(context, false);
}

void refresh_changed_joints(StepContext &context) {
    JointSystem &system = context.scratch.joint_system;
    for (JointConstraint &joint : context.scratch.joints)
        if (!joint.is_held && is_changed(context, joint))
            joint.mass = mass_of(joint.rows, context.body(joint.a), context.body(joint.b));
    // A group that has changed has changed all of its bodies.
    factor_groups(context, [&](const JointGroup &group) {
        return is_changed(context, context.scratch.joints[system.block(group.first)]);
    });
    weigh_with_groups(context, true);
}

void remember_joints(StepContext &context) {
    for (JointConstraint &joint : context.scratch.joints) {
        joint.remembered = joint.impulse;
        joint.impulse = Vec3{Real(0)};
    }
}

void recall_joints(StepContext &context, Real share, Springs springs) {
    for (JointConstraint &joint : context.scratch.joints) {
        if (springs == Springs::skip && joint.is_spring())
            continue;
        const Vec3 recalled = share * joint.remembered;
        joint.impulse += recalled;
        apply(context, joint, recalled);
    }
    context.report.constraint_passes += context.scratch.joints.size();
}

void repeat_springs(StepContext &context) {
    for (JointConstraint &joint : context.scratch.joints)
        if (joint.is_spring()) {
            apply(context, joint, joint.impulse);
            joint.impulse *= Real(2);
        }
}

// Groups come first, to see whether they hold, and again after other joints have changed what they
// did.
void solve_joints(StepContext &context, const JointPass &pass) {
    const std::span<JointGroup> groups = context.scratch.joint_system.groups();
    const auto hold = [&](std::size_t begin, std::size_t end) {
        for (JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held) {
                solve_group(context, group, pass);
                if (!can_follow(context, group, pass.h))
                    let_go(context, group);
            }
    };
    if (pass.at_the_end)
        for_parts(context.tasks, groups.size(), groups_a_part, hold);
    bool is_changed = !pass.at_the_end;
    for (JointConstraint &joint : context.scratch.joints) {
        if (joint.is_held || (pass.springs == Springs::skip && joint.is_spring()) ||
            (pass.skips_motors && joint.rows.bounds == RowBounds::motor))
            continue;
        const Vec3 change =
            impulse_change(joint, context.body(joint.a), context.body(joint.b), pass);
        joint.impulse += change;
        apply(context, joint, change);
        is_changed = true;
    }
    const auto solve = [&](std::size_t begin, std::size_t end) {
        for (const JointGroup &group : groups.subspan(begin, end - begin))
            if (group.is_held)
                solve_group(context, group, pass);
    };
    if (is_changed)
        for_parts(context.tasks, groups.size(), groups_a_part, solve);
    context.report.constraint_passes += context.scratch.joints.size();
}

void answer_impact(StepContext &context, std::uint32_t group) {
    if (group == JointSystem::none)
        return;
    JointSystem &system = context.scratch.joint_system;
    const JointGroup &all = system.groups()[group];
    if (!all.is_held)
        return;
    const std::span<Vec3> sides = sides_of(context, all);
    for (std::uint32_t place = all.first; place < all.last; ++place) {
        const JointConstraint &joint = context.scratch.joints[system.block(place)];
        sides[place - all.first] =
            -row_velocity(joint.rows, context.body(joint.a), context.body(joint.b), JointPass{});
    }
    system.solve(all, sides);
    for (std::uint32_t place = all.first; place < all.last; ++place) {
        const JointConstraint &joint = context.scratch.joints[system.block(place)];
        apply(context, joint, sides[place - all.first]);
    }
}

void store_joints(StepContext &context) {
    const Real rate =
        static_cast<Real>(context.settings.substeps) / static_cast<Real>(context.settings.dt);
    for (const JointConstraint &joint : context.scratch.joints) {
        const Vec3 &total = joint.impulse;
        if (joint.joint == JointConstraint::grab) {
            context.grab.impulse = total;
            continue;
        }
        JointMemory &memory = context.joints[joint.joint];
        for (int i = 0; i < joint.rows.count; ++i)
            memory.impulses[joint.rows.first_memory + static_cast<std::size_t>(i)] = total[i];
        const Real break_force = context.model.joints[joint.joint].break_force;
        if (break_force > Real(0) && joint.rows.kind != RowKind::angular &&
            joint.rows.bounds != RowBounds::motor && glm::length(total) * rate > break_force)
            memory.broken = true;
    }
    for (const std::uint32_t i : context.active.joints)
        if (context.joints[i].broken)
            context.joints[i].impulses = {};
}

} // namespace plumb::inline PLUMB_PRECISION
