#include "engine/dynamics/methods/parts/augmented_rows.h"

#include "engine/dynamics/methods/parts/pose_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

Real Stiffening::begun(Real stiffness, Real unit, Real most) const {
    return std::min(std::max(kept * stiffness, start * unit), most);
}

Real Stiffening::grown(Real stiffness, Real unit, Real most, Real error) const {
    return std::min(stiffness + growth * unit * std::abs(error), most);
}

// ---- contacts

// A gap may close completely; only of overlap a share is left alone.
void begin_point(AugmentedPoint &point, Real separation, const Stiffening &stiffening) {
    PointPenalty &penalty = point.penalty;
    penalty.normal =
        stiffening.begun(penalty.normal, point.unit_normal, stiffening.limit * point.unit_normal);
    penalty.tangential = stiffening.begun(penalty.tangential, point.unit_tangential,
                                          stiffening.limit * point.unit_tangential);
    point.start = separation - stiffening.kept_error * std::min(separation, Real(0)); // (18)
    point.start_slip = (Real(1) - stiffening.kept_error) * penalty.slip;
    point.load *= stiffening.kept_error * stiffening.kept; // (19)
}

// Clamped forces keep their full stiffness: too stiff a model only shortens a body's step, but
// without it bodies that touch and separate within a step are launched.
PointForce force_of(const AugmentedPoint &point, const Vec3 &way, Real friction) {
    const PointPenalty &penalty = point.penalty;
    PointForce out;
    out.stiffness.x = penalty.normal;
    out.force.x = std::max(point.load.x - penalty.normal * (point.start + way.x), Real(0));
    if (friction == Real(0))
        return out;
    out.stiffness.y = out.stiffness.z = penalty.tangential;
    Vec2 wanted = Vec2{point.load.y, point.load.z} -
                  penalty.tangential * (point.start_slip + Vec2{way.y, way.z});
    const Real length = glm::length(wanted);
    const Real limit = friction * out.force.x;
    out.holds = length < limit;
    if (length > limit)
        wanted *= limit / length;
    out.force.y = wanted.x;
    out.force.z = wanted.y;
    return out;
}

void end_pass(AugmentedPoint &point, const Vec3 &way, Real friction, const Stiffening &stiffening) {
    const PointForce now = force_of(point, way, friction);
    point.load = now.force;
    PointPenalty &penalty = point.penalty;
    if (now.force.x > Real(0))
        penalty.normal =
            stiffening.grown(penalty.normal, point.unit_normal,
                             stiffening.limit * point.unit_normal, point.start + way.x);
    if (now.holds)
        penalty.tangential = stiffening.grown(penalty.tangential, point.unit_tangential,
                                              stiffening.limit * point.unit_tangential,
                                              glm::length(point.start_slip + Vec2{way.y, way.z}));
}

void end_point(AugmentedPoint &point, const Vec3 &way, Real friction) {
    point.penalty.slip = force_of(point, way, friction).holds
                             ? point.penalty.slip + Vec2{way.y, way.z}
                             : Vec2{Real(0)};
}

// ---- joints

void begin_block(AugmentedBlock &block, const RowBlock &rows, const SolverBody &a,
                 const SolverBody &b, const Stiffening &stiffening) {
    block.start = rows.error;
    const bool is_spring = rows.frequency > Real(0);
    const Real omega = Real(2) * std::numbers::pi_v<Real> * rows.frequency;
    for (int i = 0; i < rows.count; ++i) {
        Vec3 row{Real(0)};
        row[i] = Real(1);
        const Real inverse = inverse_effective_mass(rows, a, b, along(rows, row));
        const Real mass = inverse > Real(0) ? Real(1) / inverse : Real(0);
        block.unit[i] = mass / (stiffening.h * stiffening.h);
        block.most[i] = is_spring ? mass * omega * omega : stiffening.limit * block.unit[i];
        block.damping[i] = is_spring ? Real(2) * rows.damping_ratio * mass * omega : Real(0);
        block.stiffness[i] = stiffening.begun(block.stiffness[i], block.unit[i], block.most[i]);
    }
    block.load *= is_spring ? Real(0) : stiffening.kept_error * stiffening.kept;
}

namespace {

// The part of the error at the substep's start that is left alone.
Real left_alone(const RowBlock &rows, Real start) {
    switch (rows.bounds) {
    case RowBounds::at_least:
        return std::min(start, Real(0));
    case RowBounds::at_most:
        return std::max(start, Real(0));
    default:
        return start;
    }
}

} // namespace

BlockForce force_of(const AugmentedBlock &block, const RowBlock &rows, Real change,
                    const Stiffening &stiffening) {
    BlockForce out;
    const bool is_spring = rows.frequency > Real(0);
    for (int i = 0; i < rows.count; ++i) {
        const Real error = rows.error[i];
        out.error[i] = rows.bounds == RowBounds::motor ? change - rows.speed * stiffening.h
                       : is_spring
                           ? error
                           : error - stiffening.kept_error * left_alone(rows, block.start[i]);
        out.stiffness[i] = block.stiffness[i] + block.damping[i] / stiffening.h;
        out.force[i] = block.load[i] - block.stiffness[i] * out.error[i] -
                       block.damping[i] / stiffening.h * (error - block.start[i]);
        bool is_bounded = false;
        const auto bound = [&](Real least, Real most) {
            is_bounded = out.force[i] <= least || out.force[i] >= most;
            out.force[i] = std::clamp(out.force[i], least, most);
        };
        constexpr Real any = std::numeric_limits<Real>::infinity();
        if (rows.bounds == RowBounds::at_least)
            bound(Real(0), is_spring && error > Real(0) ? Real(0) : any);
        else if (rows.bounds == RowBounds::at_most)
            bound(is_spring && error < Real(0) ? Real(0) : -any, Real(0));
        else if (rows.bounds == RowBounds::motor)
            bound(-rows.max_force, rows.max_force);
        out.is_bounded[static_cast<std::size_t>(i)] = is_bounded;
    }
    if (rows.bounds == RowBounds::pull) {
        const Real length = glm::length(out.force);
        if (length > rows.max_force) {
            out.force *= rows.max_force / length;
            out.is_bounded = {true, true, true};
        }
    }
    return out;
}

Vec3 end_pass(AugmentedBlock &block, const RowBlock &rows, Real change,
              const Stiffening &stiffening) {
    const BlockForce now = force_of(block, rows, change, stiffening);
    for (int i = 0; i < rows.count; ++i)
        if (!now.is_bounded[static_cast<std::size_t>(i)])
            block.stiffness[i] =
                stiffening.grown(block.stiffness[i], block.unit[i], block.most[i], now.error[i]);
    if (!(rows.frequency > Real(0))) // a spring has no load, only its stiffness
        block.load = now.force;
    return now.force;
}

} // namespace plumb::inline PLUMB_PRECISION
