// soft_step's work on a block of ball joints. Compiled once for each instruction set, by including
// itself. Each lane performs the operations of the functions for single joints in the same order,
// with bit-identical results.
#include "engine/dynamics/islands/bracing.h"
#include "engine/dynamics/joints/joint_columns.h"

#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/joint_impulse.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/joints/joint_kernels.cpp"
// Vectors of unknown size cannot stand in structs.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/dynamics/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace columns::HWY_NAMESPACE; // NOLINT(google-build-using-namespace)

struct Matrix {
    Vector x, y, z; // columns
};
HWY_INLINE Matrix load_matrix(const ColumnsMatrix &from, std::size_t lane) {
    return {load(from.x, lane), load(from.y, lane), load(from.z, lane)};
}
HWY_INLINE void store_matrix(const Matrix &m, ColumnsMatrix &to, std::size_t lane) {
    store(m.x, to.x, lane);
    store(m.y, to.y, lane);
    store(m.z, to.z, lane);
}
HWY_INLINE Vector product(const Matrix &m, const Vector &v) {
    return plus(plus(times(v.x, m.x), times(v.y, m.y)), times(v.z, m.z));
}

HWY_INLINE Mask is_body(const JointBlock::End &end, std::size_t lane) {
    return hn::Gt(load(end.is_body, lane), hn::Zero(tag));
}

// Three Reals of each lane's body; 0 for the world.
HWY_INLINE Vector gather_end(const JointBlock::End &end, const BodyReals &bodies, int offset,
                             std::size_t lane) {
    return choose(is_body(end, lane), gather_rows(bodies.bodies, offset, end.body, lane), zeros());
}

struct Velocity {
    Vector linear, angular;
};

HWY_INLINE Velocity velocity_of(const JointBlock::End &end, const BodyReals &bodies,
                                std::size_t lane) {
    return {gather_end(end, bodies, bodies.velocity, lane),
            gather_end(end, bodies, bodies.angular_velocity, lane)};
}

// SolverBody::apply_impulse, except for lanes that are `left`.
HWY_INLINE void apply(const JointBlock::End &end, Velocity velocity, const Vector &impulse,
                      const BodyReals &bodies, unsigned left, std::size_t lane) {
    velocity.linear = plus(velocity.linear, times(load(end.inv_mass, lane), impulse));
    const Vector turn = cross(load(end.arm, lane), impulse);
    velocity.angular = plus(velocity.angular, product(load_matrix(end.inv_inertia, lane), turn));
    const unsigned writes = end.writes & ~left;
    scatter_rows(velocity.linear, velocity.angular, bodies.bodies, bodies.velocity, end.body,
                 writes, lane);
}

HWY_INLINE Vector negative(const Vector &v) {
    return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}

// glm's quaternion times vector.
HWY_INLINE Vector rotated(const Vector &axis, Lanes w, const Vector &v) {
    const Vector once = cross(axis, v);
    const Vector twice = cross(axis, once);
    return plus(v, times(all(Real(2)), plus(times(w, once), twice)));
}

// chord_velocity (joint_impulse.cpp), for turns whose square is no more than this.
constexpr Real near = Real(0.04);
HWY_INLINE Vector chord_velocity(const Vector &angular, Lanes squared, const Vector &arm, Real h) {
    const Lanes one = all(Real(1));
    const auto part = [&](Real of) HWY_ATTR { return hn::Div(squared, all(of)); };
    const Lanes along = hn::Sub(one, hn::Mul(part(Real(6)), hn::Sub(one, part(Real(20)))));
    const Lanes inward =
        hn::Sub(all(Real(0.5)), hn::Mul(part(Real(24)), hn::Sub(one, part(Real(30)))));
    const Vector turning = cross(angular, arm);
    return plus(times(along, turning), times(hn::Mul(inward, all(h)), cross(angular, turning)));
}

// pushed (joint_impulse.h).
HWY_INLINE Vector pushed(const Vector &bias, Lanes most) {
    const Lanes length = hn::Sqrt(dot(bias, bias));
    const auto is_fast = hn::Gt(length, most);
    const Lanes slowed = hn::Div(most, hn::IfThenElse(is_fast, length, all(Real(1))));
    return choose(is_fast, times(slowed, bias), bias);
}

// impulse_change (joint_impulse.h) of a point's rows, applied.
void solve_impl(JointBlock &block, const BodyReals &bodies, const JointPass &pass) {
    block.left = 0;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Velocity a = velocity_of(block.a, bodies, lane);
        const Velocity b = velocity_of(block.b, bodies, lane);
        const Vector arm_a = load(block.a.arm, lane);
        const Vector arm_b = load(block.b.arm, lane);
        auto is_far = hn::FirstN(tag, 0);
        Vector speed;
        if (pass.at_the_end) {
            const Lanes squared_h = all(pass.h * pass.h);
            const Lanes squared_a = hn::Mul(squared_h, dot(a.angular, a.angular));
            const Lanes squared_b = hn::Mul(squared_h, dot(b.angular, b.angular));
            is_far = hn::Not(hn::And(hn::Le(squared_a, all(near)), hn::Le(squared_b, all(near))));
            speed = plus(minus(b.linear, a.linear),
                         minus(chord_velocity(b.angular, squared_b, arm_b, pass.h),
                               chord_velocity(a.angular, squared_a, arm_a, pass.h)));
        } else {
            speed = minus(plus(b.linear, cross(b.angular, arm_b)),
                          plus(a.linear, cross(a.angular, arm_a)));
        }
        const Vector bias = pushed(times(all(pass.softness.bias_rate), load(block.error, lane)),
                                   all(pass.push_velocity));
        const Vector before = load(block.impulse, lane);
        const Vector wanted = times(all(-pass.softness.mass_scale),
                                    product(load_matrix(block.mass, lane), plus(speed, bias)));
        const Vector change = minus(wanted, times(all(pass.softness.impulse_scale), before));
        store(choose(is_far, before, plus(before, change)), block.impulse, lane);
        const unsigned left = bits_of(is_far, lane);
        apply(block.a, a, negative(change), bodies, left, lane);
        apply(block.b, b, change, bodies, left, lane);
        block.left = static_cast<std::uint16_t>(block.left | left);
    }
}

void warm_start_impl(JointBlock &block, const BodyReals &bodies, Real share) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector start = times(all(share), load(block.remembered, lane));
        store(plus(load(block.impulse, lane), start), block.impulse, lane);
        apply(block.a, velocity_of(block.a, bodies, lane), negative(start), bodies, 0, lane);
        apply(block.b, velocity_of(block.b, bodies, lane), start, bodies, 0, lane);
    }
}

// An end's share of point_matrix (joint_impulse.cpp).
HWY_INLINE void subtract_end(Matrix &k, const Matrix &inv_inertia, const Vector &arm) {
    const Matrix crossed{cross(arm, inv_inertia.x), cross(arm, inv_inertia.y),
                         cross(arm, inv_inertia.z)};
    k.x = minus(k.x, minus(times(arm.z, crossed.y), times(arm.y, crossed.z)));
    k.y = minus(k.y, minus(times(arm.x, crossed.z), times(arm.z, crossed.x)));
    k.z = minus(k.z, minus(times(arm.y, crossed.x), times(arm.x, crossed.y)));
}

HWY_INLINE Matrix reload_inertia(JointBlock::End &end, const BodyReals &bodies, std::size_t lane) {
    const Matrix inertia{gather_end(end, bodies, bodies.inv_inertia, lane),
                         gather_end(end, bodies, bodies.inv_inertia + 3, lane),
                         gather_end(end, bodies, bodies.inv_inertia + 6, lane)};
    store_matrix(inertia, end.inv_inertia, lane);
    return inertia;
}

// mass_of (joint_impulse.h), for bodies neither very heavy nor very light nor locked along an axis.
HWY_INLINE void weigh_lanes(JointBlock &block, const BodyReals &bodies, std::size_t lane) {
    const Vector linear = plus(load(block.a.inv_mass, lane), load(block.b.inv_mass, lane));
    const Lanes zero = hn::Zero(tag);
    Matrix k{{linear.x, zero, zero}, {zero, linear.y, zero}, {zero, zero, linear.z}};
    subtract_end(k, reload_inertia(block.a, bodies, lane), load(block.a.arm, lane));
    subtract_end(k, reload_inertia(block.b, bodies, lane), load(block.b.arm, lane));
    const auto minor = [](Lanes a, Lanes b, Lanes c, Lanes d)
                           HWY_ATTR { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); };
    const Lanes determinant = hn::Add(hn::Sub(hn::Mul(k.x.x, minor(k.y.y, k.z.z, k.z.y, k.y.z)),
                                              hn::Mul(k.y.x, minor(k.x.y, k.z.z, k.z.y, k.x.z))),
                                      hn::Mul(k.z.x, minor(k.x.y, k.y.z, k.y.y, k.x.z)));
    const Lanes trace = hn::Add(hn::Add(k.x.x, k.y.y), k.z.z);
    const Lanes size = hn::Div(trace, all(Real(3)));
    constexpr Real small = Real(1e-6);
    const Lanes least = hn::Mul(hn::Mul(hn::Mul(all(least_determinant), size), size), size);
    const auto is_usual =
        hn::And(hn::And(hn::Gt(trace, all(small)), hn::Lt(trace, all(Real(1) / small))),
                hn::Gt(determinant, least));
    const Lanes scale = hn::Div(all(Real(1)), determinant);
    const auto cofactor = [&](Lanes a, Lanes b, Lanes c, Lanes d)
                              HWY_ATTR { return hn::Mul(minor(a, b, c, d), scale); };
    const auto opposite = [&](Lanes a, Lanes b, Lanes c, Lanes d)
                              HWY_ATTR { return hn::Mul(hn::Neg(minor(a, b, c, d)), scale); };
    store_matrix({{cofactor(k.y.y, k.z.z, k.z.y, k.y.z), opposite(k.x.y, k.z.z, k.z.y, k.x.z),
                   cofactor(k.x.y, k.y.z, k.y.y, k.x.z)},
                  {opposite(k.y.x, k.z.z, k.z.x, k.y.z), cofactor(k.x.x, k.z.z, k.z.x, k.x.z),
                   opposite(k.x.x, k.y.z, k.y.x, k.x.z)},
                  {cofactor(k.y.x, k.z.y, k.z.x, k.y.y), opposite(k.x.x, k.z.y, k.z.x, k.x.y),
                   cofactor(k.x.x, k.y.y, k.y.x, k.x.y)}},
                 block.mass, lane);
    block.left = static_cast<std::uint16_t>(block.left | bits_of(hn::Not(is_usual), lane));
}

void weigh_impl(JointBlock &block, const BodyReals &bodies) {
    block.left = 0;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag))
        weigh_lanes(block, bodies, lane);
}

HWY_INLINE Vector present_arm(const JointBlock::End &end, const BodyReals &bodies,
                              std::size_t lane) {
    const auto body = is_body(end, lane);
    const Lanes w = hn::GatherIndex(tag, bodies.bodies + bodies.rotation_w, load(end.body, lane));
    return rotated(gather_end(end, bodies, bodies.rotation, lane),
                   hn::IfThenElse(body, w, all(Real(1))), load(end.anchor, lane));
}

// emit_point (joint_rows.h) at the present poses, and act_at_one_place (joint_constraint.cpp).
void refresh_impl(JointBlock &block, const BodyReals &bodies) {
    block.left = 0;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector arm_a = present_arm(block.a, bodies, lane);
        const Vector arm_b = present_arm(block.b, bodies, lane);
        const Vector between = minus(gather_end(block.b, bodies, bodies.position, lane),
                                     gather_end(block.a, bodies, bodies.position, lane));
        const Vector error = plus(between, minus(arm_b, arm_a));
        // half_way (bracing.h)
        const Lanes squared = dot(error, error);
        const Lanes most =
            hn::Mul(all(joints_meet_within), hn::Add(dot(arm_a, arm_a), dot(arm_b, arm_b)));
        const auto is_far = hn::Gt(squared, most);
        const Lanes one = all(Real(1));
        const Lanes share =
            hn::IfThenElse(is_far, hn::Div(most, hn::IfThenElse(is_far, squared, one)), one);
        const Vector half = times(hn::Mul(load(block.meeting, lane), share), error);
        store(plus(arm_a, half), block.a.arm, lane);
        store(minus(arm_b, half), block.b.arm, lane);
        store(error, block.error, lane);
        weigh_lanes(block, bodies, lane);
    }
}

} // namespace

void weigh_joints(std::span<JointBlock> blocks, const BodyReals &bodies) {
    for (JointBlock &block : blocks)
        weigh_impl(block, bodies);
}
void refresh_joints(std::span<JointBlock> blocks, const BodyReals &bodies) {
    for (JointBlock &block : blocks)
        refresh_impl(block, bodies);
}
void warm_start_joints(std::span<JointBlock> blocks, const BodyReals &bodies, Real share) {
    for (JointBlock &block : blocks)
        warm_start_impl(block, bodies, share);
}
void solve_joints(std::span<JointBlock> blocks, const BodyReals &bodies, const JointPass &pass) {
    for (JointBlock &block : blocks)
        solve_impl(block, bodies, pass);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(weigh_joints);
HWY_EXPORT(refresh_joints);
HWY_EXPORT(warm_start_joints);
HWY_EXPORT(solve_joints);

void weigh(std::span<JointBlock> blocks, const BodyReals &bodies) {
    HWY_DYNAMIC_DISPATCH(weigh_joints)(blocks, bodies);
}
void refresh(std::span<JointBlock> blocks, const BodyReals &bodies) {
    HWY_DYNAMIC_DISPATCH(refresh_joints)(blocks, bodies);
}
void warm_start(std::span<JointBlock> blocks, const BodyReals &bodies, Real share) {
    HWY_DYNAMIC_DISPATCH(warm_start_joints)(blocks, bodies, share);
}
void solve(std::span<JointBlock> blocks, const BodyReals &bodies, const JointPass &pass) {
    HWY_DYNAMIC_DISPATCH(solve_joints)(blocks, bodies, pass);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
