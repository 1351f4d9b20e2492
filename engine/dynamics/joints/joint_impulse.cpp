#include "engine/dynamics/joints/joint_impulse.h"

#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// K of a point-to-point constraint: (1/ma + 1/mb) 1 - [ra] Ia^-1 [ra] - [rb] Ib^-1 [rb]
// (Catto 2009, "Modeling and Solving Constraints", slide 52, in 3D).
Mat3 point_matrix(const SolverBody &a, const SolverBody &b, const Vec3 &r_a, const Vec3 &r_b) {
    Mat3 k{Real(0)};
    for (int i = 0; i < 3; ++i)
        k[i][i] = a.inv_mass[i] + b.inv_mass[i];
    const auto subtract = [&](const Mat3 &inv_inertia, const Vec3 &r) {
        const Mat3 crossed{glm::cross(r, inv_inertia[0]), glm::cross(r, inv_inertia[1]),
                           glm::cross(r, inv_inertia[2])};
        k[0] -= r.z * crossed[1] - r.y * crossed[2];
        k[1] -= r.x * crossed[2] - r.z * crossed[0];
        k[2] -= r.y * crossed[0] - r.x * crossed[1];
    };
    subtract(a.inv_inertia, r_a);
    subtract(b.inv_inertia, r_b);
    return k;
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

// The inverse of a symmetric positive semidefinite matrix; 0 for 0.
Mat3 inverse_of(const Mat3 &k, bool may_be_locked) {
    const Real trace = k[0][0] + k[1][1] + k[2][2];
    if (!(trace > Real(0)))
        return Mat3{Real(0)};
    constexpr Real small = Real(1e-6);
    const Real size = trace / Real(3);
    if (trace > small && trace < Real(1) / small &&
        glm::determinant(k) > least_determinant * size * size * size)
        return glm::inverse(k);
    // Scaled by a power of two, which does not round: the determinant of a very heavy body's K
    // would underflow.
    const double scale = std::exp2(-std::ilogb(trace));
    const glm::dmat3 scaled = scale * glm::dmat3(k);
    return Mat3(scale * glm::inverse(may_be_locked ? scaled + locked_compliance(scaled) : scaled));
}

Softness spring_softness(const RowBlock &rows, const JointPass &pass) {
    const Real time =
        pass.springs == Springs::midpoint ? spring_share(rows, pass.h) * pass.h : pass.h;
    return make_soft(rows.frequency, rows.damping_ratio, time);
}

// m/s or rad/s. The angle of a soft hinge may jump far beyond a limit.
Real fastest_push(const JointConstraint &joint, const JointPass &pass) {
    return joint.is_spring() ? std::numeric_limits<Real>::infinity() : pass.push_velocity;
}

// The change of a limit's impulse; `side` is 1 for a lower limit, whose impulse is never negative,
// and -1 for an upper limit.
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
    const Real target =
        is_off ? gap / pass.h : std::max(used.bias_rate * gap, -fastest_push(joint, pass));
    const Real change = -used.mass_scale * joint.mass[0][0] * (side * speed + target) -
                        used.impulse_scale * impulse;
    return side * (std::max(impulse + change, Real(0)) - impulse);
}

} // namespace

bool may_be_locked(const SolverBody &a, const SolverBody &b) {
    const auto is_free = [](const SolverBody &body) {
        return !body.has_locks && body.inv_mass.x > Real(0);
    };
    return !is_free(a) && !is_free(b);
}

glm::dmat3 locked_compliance(const glm::dmat3 &k) {
    const double size = (k[0][0] + k[1][1] + k[2][2]) / 3;
    constexpr double rounding = 16.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    // The determinant over the sum of products of two eigenvalues each is between a third of the
    // least eigenvalue and the whole.
    const double minors = k[0][0] * k[1][1] - k[1][0] * k[0][1] + k[1][1] * k[2][2] -
                          k[2][1] * k[1][2] + k[2][2] * k[0][0] - k[0][2] * k[2][0];
    if (!(size > 0) || glm::determinant(k) > rounding * size * minors)
        return glm::dmat3{0.0};
    // Close to 1 along immovable directions, close to 0 along all others.
    constexpr double small = 16 * rounding;
    const glm::dmat3 locked = small * glm::inverse(k / size + glm::dmat3{small});
    constexpr double stiff = 1e3; // times the others
    return (stiff * size) * (locked * locked);
}

namespace {

// K of the rows.
Mat3 matrix_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b) {
    if (rows.kind == RowKind::point)
        return point_matrix(a, b, rows.r_a, rows.r_b);
    Mat3 k{Real(0)};
    for (int i = 0; i < rows.count; ++i)
        for (int j = 0; j <= i; ++j)
            k[i][j] = k[j][i] = row_coupling(rows, a, b, rows.axes[static_cast<std::size_t>(i)],
                                             rows.axes[static_cast<std::size_t>(j)]);
    return k;
}

} // namespace

Mat3 mass_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b) {
    if (rows.kind == RowKind::point)
        return inverse_of(point_matrix(a, b, rows.r_a, rows.r_b), may_be_locked(a, b));
    if (rows.count == 1) {
        const Real k = rows.kind == RowKind::linear
                           ? inverse_effective_mass(a, b, rows.r_a, rows.r_b, rows.axes[0])
                           : row_coupling(rows, a, b, rows.axes[0], rows.axes[0]);
        Mat3 mass{Real(0)};
        mass[0][0] = k > Real(0) ? Real(1) / k : Real(0);
        return mass;
    }
    const Mat3 k = matrix_of(rows, a, b);
    Mat3 mass{Real(0)};
    if (rows.count == 2) {
        const glm::dmat3 fine(k); // of a slender rod's, single precision would leave little
        const double determinant = fine[0][0] * fine[1][1] - fine[1][0] * fine[0][1];
        const double size = 0.5 * (fine[0][0] + fine[1][1]);
        if (determinant > 1e-6 * size * size) {
            mass[0][0] = static_cast<Real>(fine[1][1] / determinant);
            mass[1][1] = static_cast<Real>(fine[0][0] / determinant);
            mass[1][0] = mass[0][1] = static_cast<Real>(-fine[1][0] / determinant);
        } else {
            for (int i = 0; i < 2; ++i)
                mass[i][i] = k[i][i] > Real(0) ? Real(1) / (k[0][0] + k[1][1]) : Real(0);
        }
    } else {
        mass = inverse_of(k, may_be_locked(a, b));
    }
    return mass;
}

namespace {

// The mean velocity over h of the end of a turning arm that starts at r: the chord of its circle,
// ((exp(h [w]) - 1) r) / h (Rodrigues).
WideVec3 chord_velocity(const WideVec3 &angular_velocity, const WideVec3 &r, Real h) {
    const Real squared = h * h * dot(angular_velocity, angular_velocity);
    // sin(x) / x and (1 - cos(x)) / x^2, both at once.
    using Pair [[gnu::vector_size(2 * sizeof(Real))]] = Real;
    const Pair square = {squared, squared};
    Pair factors =
        Pair{Real(1), Real(0.5)} - square / Pair{Real(6), Real(24)} *
                                       (Pair{Real(1), Real(1)} - square / Pair{Real(20), Real(30)});
    if (squared > Real(0.04)) { // the series' next terms show
        const Real angle = std::sqrt(squared);
        factors = Pair{std::sin(angle) / angle, (Real(1) - std::cos(angle)) / squared};
    }
    const WideVec3 turning = cross(angular_velocity, r);
    return factors[0] * turning + (factors[1] * h) * cross(angular_velocity, turning);
}

} // namespace

WideVec3 point_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                        const JointPass &pass) {
    const WideVec3 velocity_a = WideVec3::followed(a.velocity);
    const WideVec3 velocity_b = WideVec3::followed(b.velocity);
    const WideVec3 turning_a = WideVec3::followed(a.angular_velocity);
    const WideVec3 turning_b = WideVec3::followed(b.angular_velocity);
    const WideVec3 r_a = WideVec3::followed(rows.r_a);
    const WideVec3 r_b = WideVec3::followed(rows.r_b);
    if (!pass.at_the_end)
        return (velocity_b + cross(turning_b, r_b)) - (velocity_a + cross(turning_a, r_a));
    return (velocity_b - velocity_a) +
           (chord_velocity(turning_b, r_b, pass.h) - chord_velocity(turning_a, r_a, pass.h));
}

Vec3 axial_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                    const JointPass &pass) {
    Vec3 v{Real(0)};
    const auto along = [&](const Vec3 &way) {
        for (int i = 0; i < rows.count; ++i)
            v[i] = glm::dot(rows.axes[static_cast<std::size_t>(i)], way);
    };
    if (rows.kind == RowKind::angular) {
        const Vec3 relative = b.angular_velocity - a.angular_velocity;
        along(relative);
        // On average over the substep a's axes are where half of its turn takes them; what spins
        // about one of them would lean towards the others.
        if (pass.at_the_end && rows.count > 1) {
            const Vec3 bend = glm::cross(relative, a.angular_velocity);
            const Vec3 again = glm::cross(bend, a.angular_velocity);
            const Vec3 turned = (Real(0.5) * pass.h) * bend + (pass.h * pass.h / Real(6)) * again;
            for (int i = 0; i < rows.count; ++i)
                v[i] += glm::dot(rows.axes[static_cast<std::size_t>(i)], turned);
        }
        return v;
    }
    Vec3 relative = point_velocity(rows, a, b, pass).narrow();
    if (pass.at_the_end && rows.turns_with_a)
        relative +=
            chord_velocity(WideVec3(-a.angular_velocity), WideVec3(pass.h * relative), pass.h)
                .narrow();
    along(relative);
    if (pass.at_the_end && rows.swing_length > Real(0)) {
        // How much longer the line between the anchors gets as they swing sideways.
        const Real distance = rows.swing_length;
        const Vec3 aside = pass.h * (relative - v.x * rows.axes[0]);
        const Real squared = std::min(glm::dot(aside, aside), distance * distance);
        v.x += squared / (distance + std::sqrt(distance * distance - squared)) / pass.h;
    }
    return v;
}

Vec3 half_bend(const RowBlock &rows, const SolverBody &a, const SolverBody &b, Real h) {
    const auto towards_axis = [](const Vec3 &w, const Vec3 &r) {
        return glm::cross(w, glm::cross(w, r));
    };
    const Vec3 bend =
        Real(0.5) * h *
        (towards_axis(b.angular_velocity, rows.r_b) - towards_axis(a.angular_velocity, rows.r_a));
    if (rows.kind == RowKind::point)
        return bend;
    const Vec3 parting = b.velocity_at(rows.r_b) - a.velocity_at(rows.r_a);
    const Vec3 seen = rows.turns_with_a ? bend - h * glm::cross(a.angular_velocity, parting) : bend;
    Vec3 v{Real(0)};
    for (int i = 0; i < rows.count; ++i)
        v[i] = glm::dot(rows.axes[static_cast<std::size_t>(i)], seen);
    if (rows.swing_length > Real(0)) {
        const Real along = glm::dot(rows.axes[0], parting);
        v.x += Real(0.5) * h * (glm::dot(parting, parting) - along * along) / rows.swing_length;
    }
    return v;
}

void apply(SolverBody &body, const RowBlock &rows, const Vec3 &arm, const Vec3 &impulse) {
    const bool is_linear = rows.kind != RowKind::angular;
    const WideVec3 push(impulse);
    const WideVec3 turn = is_linear ? cross(WideVec3::followed(arm), push) : push;
    const WideVec3 turning =
        WideVec3::followed(body.angular_velocity) + WideMat3::followed(body.inv_inertia) * turn;
    if (is_linear)
        body.velocity =
            (WideVec3::followed(body.velocity) + WideVec3::followed(body.inv_mass) * push).narrow();
    body.angular_velocity = turning.narrow();
}

void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    const RowBlock &rows = joint.rows;
    const Vec3 along = world_impulse(rows, impulse);
    if (joint.moves_a)
        apply(context.bodies[joint.a], rows, rows.r_a, -along);
    if (joint.moves_b)
        apply(context.bodies[joint.b], rows, rows.r_b, along);
}

Vec3 pushed(const Vec3 &bias, Real most) {
    const Real speed = glm::length(bias);
    return speed > most ? (most / speed) * bias : bias;
}

namespace {

// K of several rows as it was when the bodies were joined with their frames aligned, turned with a.
// With the present K a spring's stiffness would turn with both bodies and feed energy into what
// swings on it. That of a turn is turned half way with b: only then, where it is not the same about
// all axes, is its torque the slope of an energy, to second order in the angle.
Mat3 matrix_as_joined(StepContext &context, const JointConstraint &joint) {
    const Joint &of = context.model.joints[joint.joint];
    const RowBlock &rows = joint.rows;
    Quat rotation_a = context.body(joint.a).rotation;
    if (rows.kind == RowKind::angular && rows.count == 3) {
        const Quat seen_by_b =
            context.body(joint.b).rotation * of.frame_b_local * glm::conjugate(of.frame_a_local);
        rotation_a = glm::normalize(
            rotation_a + (glm::dot(rotation_a, seen_by_b) < Real(0) ? -seen_by_b : seen_by_b));
    }
    std::array<SolverBody, 2> ends;
    const auto put = [&](SolverBody &end, std::uint32_t index, const Quat &rotation) {
        if (index == Joint::world || !(context.model.bodies[index].mass > Real(0)))
            return;
        const Body &body = context.model.bodies[index];
        end.inv_mass = Vec3{Real(1) / body.mass};
        end.inv_inertia = world_inverse_inertia(rotation, body.inv_inertia);
    };
    const Quat rotation_b = rotation_a * of.frame_a_local * glm::conjugate(of.frame_b_local);
    put(ends[0], joint.a, rotation_a);
    put(ends[1], joint.b, rotation_b);
    RowBlock then = rows;
    then.r_a = rotation_a * of.anchor_a_local;
    then.r_b = rotation_b * of.anchor_b_local;
    Mat3 k = matrix_of(then, ends[0], ends[1]);
    if (rows.kind == RowKind::angular && rows.count == 2) { // about which b spins
        k[0][0] = k[1][1] = Real(0.5) * (k[0][0] + k[1][1]);
        k[0][1] = k[1][0] = Real(0);
    }
    return k;
}

// The mean over all directions of K at a point of a body: 1/m + tr([r]^T I^-1 [r]) / 3. The line
// between anchors may turn to any direction.
Real mean_inverse_mass(const StepContext &context, std::uint32_t index, const Vec3 &r_local) {
    if (index == Joint::world || !(context.model.bodies[index].mass > Real(0)))
        return Real(0);
    const Body &body = context.model.bodies[index];
    const Vec3 squared = r_local * r_local;
    const Real all = squared.x + squared.y + squared.z;
    return Real(1) / body.mass + glm::dot(body.inv_inertia, Vec3{all} - squared) / Real(3);
}

// Softness of a single-row spring, which may be a limit.
Softness spring_softness(const StepContext &context, const JointConstraint &joint,
                         const JointPass &pass) {
    Softness softness = spring_softness(joint.rows, pass);
    const Real stiffness = softness.mass_scale / softness.impulse_scale; // a2 of make_soft
    const Joint &of = context.model.joints[joint.joint];
    const Real joined = joint.mass[0][0] * (mean_inverse_mass(context, of.a, of.anchor_a_local) +
                                            mean_inverse_mass(context, of.b, of.anchor_b_local));
    if (joined > Real(0)) {
        softness.mass_scale = stiffness / (stiffness + joined);
        softness.impulse_scale = joined / (stiffness + joined);
    }
    return softness;
}

// Impulse change of a spring of several rows.
Vec3 spring_change(StepContext &context, const JointConstraint &joint, const Vec3 &wanted,
                   const Softness &softness) {
    const Real stiffness = softness.mass_scale / softness.impulse_scale; // a2 of make_soft
    const SolverBody &a = context.body(joint.a);
    const SolverBody &b = context.body(joint.b);
    const Mat3 joined = matrix_as_joined(context, joint);
    Mat3 k = stiffness * matrix_of(joint.rows, a, b) + joined;
    if (joint.rows.count == 2)
        k[2][2] = k[1][1]; // of no row
    return -inverse_of(k, may_be_locked(a, b)) * (stiffness * wanted + joined * joint.impulse);
}

} // namespace

Vec3 impulse_change(StepContext &context, const JointConstraint &joint, const JointPass &pass) {
    const SolverBody &a = context.body(joint.a);
    const SolverBody &b = context.body(joint.b);
    const RowBlock &rows = joint.rows;
    const Softness softness = !joint.is_spring() ? pass.softness
                              : rows.count == 1  ? spring_softness(context, joint, pass)
                                                 : spring_softness(rows, pass);
    const Vec3 v = row_velocity(rows, a, b, pass) + joint.turning;
    const Real most = fastest_push(joint, pass);
    const auto towards = [&](const Vec3 &error) {
        if (rows.count == 1)
            return Vec3{-softness.mass_scale * joint.mass[0][0] *
                                (v.x + std::clamp(softness.bias_rate * error.x, -most, most)) -
                            softness.impulse_scale * joint.impulse.x,
                        Real(0), Real(0)};
        if (joint.is_stiff_as_joined())
            return spring_change(context, joint, v + softness.bias_rate * error, softness);
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

} // namespace plumb::inline PLUMB_PRECISION
