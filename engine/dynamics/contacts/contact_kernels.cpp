// What soft_step does with a block of contacts. Compiled once per instruction set, by including
// itself. Nothing here is fused or reordered by width: each lane sees the same operations whatever
// the processor.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/contacts/contact_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/contacts/contact_kernels.cpp"
// Vectors of unknown size cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
#include <limits>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/dynamics/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace columns::HWY_NAMESPACE; // NOLINT(google-build-using-namespace)
constexpr int most_sweeps = 8;
constexpr int most_friction_passes = 4;
// A contact of one or two points whose last sweep changed no normal impulse by more than this share
// of the greater is swept no more. Three or four share a load in many ways, and settle slowly: a
// stack that lands would tilt.
constexpr Real swept_share = Real(1e-5);
constexpr int few_points = 2;
// As a share of struck_speed: contacts that close or part faster are solved as a whole before their
// points.
constexpr Real even_share = Real(1) / Real(20);

// 1 / x, or 0 where x is not positive.
HWY_INLINE Lanes inverse(Lanes x) {
    const auto positive = hn::Gt(x, hn::Zero(tag));
    return hn::IfThenElseZero(positive,
                              hn::Div(all(Real(1)), hn::IfThenElse(positive, x, all(Real(1)))));
}

struct Velocity {
    Vector linear, angular;
};

HWY_INLINE Velocity gather_velocity(const BodyReals &bodies, const IndexColumn &index,
                                    std::size_t lane) {
    return {gather_rows(bodies.bodies, bodies.velocity, index, lane),
            gather_rows(bodies.bodies, bodies.angular_velocity, index, lane)};
}

HWY_INLINE void scatter_velocity(const Velocity &v, const BodyReals &bodies,
                                 const IndexColumn &index, unsigned writes, std::size_t lane) {
    scatter_rows(v.linear, v.angular, bodies.bodies, bodies.velocity, index, writes, lane);
}

// The two bodies of the contacts in the lanes of one vector.
struct Pair {
    Velocity a, b;
    Vector inv_mass_a, inv_mass_b;
    Symmetric inv_inertia_a, inv_inertia_b;

    HWY_INLINE Vector velocity_at(const Vector &r_a, const Vector &r_b) const {
        return minus(plus(b.linear, cross(b.angular, r_b)), plus(a.linear, cross(a.angular, r_a)));
    }
    HWY_INLINE void apply(const Vector &impulse, const Vector &r_a, const Vector &r_b) {
        a.linear = minus(a.linear, times(inv_mass_a, impulse));
        b.linear = plus(b.linear, times(inv_mass_b, impulse));
        a.angular = minus(a.angular, times(inv_inertia_a, cross(r_a, impulse)));
        b.angular = plus(b.angular, times(inv_inertia_b, cross(r_b, impulse)));
    }
};

HWY_INLINE Pair load_pair(const ContactBlock &block, const BodyReals &bodies, std::size_t lane) {
    return {gather_velocity(bodies, block.body_a, lane),
            gather_velocity(bodies, block.body_b, lane),
            load(block.inv_mass_a, lane),
            load(block.inv_mass_b, lane),
            load(block.inv_inertia_a, lane),
            load(block.inv_inertia_b, lane)};
}

HWY_INLINE void store_pair(const Pair &pair, const ContactBlock &block, const BodyReals &bodies,
                           std::size_t lane) {
    scatter_velocity(pair.a, bodies, block.body_a, block.writes_a, lane);
    scatter_velocity(pair.b, bodies, block.body_b, block.writes_b, lane);
}

// u^T K v (Baraff 1996, "Linear-Time Dynamics using Lagrange Multipliers"), from the turns r x u
// and r x v.
struct Turns {
    Vector a, b;
};
HWY_INLINE Turns turns(const Vector &r_a, const Vector &r_b, const Vector &u) {
    return {cross(r_a, u), cross(r_b, u)};
}

// Where friction acts (ContactBlock::spread): at the contact points, drawn in toward the centre of
// pressure of the remembered impulses.
struct Patch {
    bool is_spread;
    Lanes spread;
    Vector middle_a, middle_b; // centre of pressure times (1 - spread)

    HWY_INLINE Vector arm_a(const Vector &r_a) const {
        return is_spread ? plus(times(spread, r_a), middle_a) : r_a;
    }
    HWY_INLINE Vector arm_b(const Vector &r_b) const {
        return is_spread ? plus(times(spread, r_b), middle_b) : r_b;
    }
};
HWY_INLINE Patch patch_of(const ContactBlock &block, std::size_t lane) {
    const Lanes zero = hn::Zero(tag);
    const Lanes one = all(Real(1));
    Patch patch{block.spins, one, zeros(), zeros()};
    if (!patch.is_spread)
        return patch;
    Lanes sum = zero;
    Vector sum_a = zeros();
    Vector sum_b = zeros();
    for (int k = 0; k < block.points_used; ++k) {
        const ContactBlock::Point &point = block.points[k];
        const Lanes borne = load(point.remembered.x, lane);
        sum = hn::Add(sum, borne);
        sum_a = plus(sum_a, times(borne, load(point.r_a, lane)));
        sum_b = plus(sum_b, times(borne, load(point.r_b, lane)));
    }
    // Without a load there is no centre of pressure yet.
    patch.spread = hn::IfThenElse(hn::Gt(sum, zero), load(block.spread, lane), one);
    const Lanes rest = hn::Mul(hn::Sub(one, patch.spread), inverse(sum));
    patch.middle_a = times(rest, sum_a);
    patch.middle_b = times(rest, sum_b);
    return patch;
}

void finish_block_impl(ContactBlock &block) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Patch patch = patch_of(block, lane);
        const Vector n = load(block.normal, lane);
        const Vector t1 = load(block.t1, lane);
        const Vector t2 = cross(n, t1);
        const Vector inv_mass = plus(load(block.inv_mass_a, lane), load(block.inv_mass_b, lane));
        const Symmetric inertia_a = load(block.inv_inertia_a, lane);
        const Symmetric inertia_b = load(block.inv_inertia_b, lane);
        for (int k = 0; k < block.points_used; ++k) {
            ContactBlock::Point &point = block.points[k];
            const Vector r_a = load(point.r_a, lane);
            const Vector r_b = load(point.r_b, lane);
            const Turns of_n = turns(r_a, r_b, n);
            const Vector rubs_a = patch.arm_a(r_a);
            const Vector rubs_b = patch.arm_b(r_b);
            const Turns of_1 = turns(rubs_a, rubs_b, t1);
            const Turns of_2 = turns(rubs_a, rubs_b, t2);
            const auto coupling = [&](const Vector &u, const Turns &of_u, const Vector &v,
                                      const Turns &of_v) HWY_ATTR {
                const Lanes linear = dot(u, times(inv_mass, v));
                const Lanes angular_a = dot(times(inertia_a, of_u.a), of_v.a);
                const Lanes angular_b = dot(times(inertia_b, of_u.b), of_v.b);
                return hn::Add(linear, hn::Add(angular_a, angular_b));
            };
            const Lanes k_11 = coupling(t1, of_1, t1, of_1);
            const Lanes k_12 = coupling(t1, of_1, t2, of_2);
            const Lanes k_22 = coupling(t2, of_2, t2, of_2);
            const Lanes half = all(Real(0.5));
            const Lanes half_difference = hn::Mul(half, hn::Sub(k_11, k_22));
            const Lanes largest = hn::Add(
                hn::Mul(half, hn::Add(k_11, k_22)),
                hn::Sqrt(hn::Add(hn::Mul(half_difference, half_difference), hn::Mul(k_12, k_12))));
            store(inverse(coupling(n, of_n, n, of_n)), point.normal_mass, lane);
            store(inverse(largest), point.tangent_mass, lane);
        }
    }
}

// Gathers a symmetric matrix that is stored as three Vec3 columns.
HWY_INLINE void reload(ColumnsSymmetric &to, const BodyReals &bodies, const IndexColumn &index,
                       std::size_t lane) {
    const Vector first = gather_rows(bodies.bodies, bodies.inv_inertia, index, lane);
    const Vector second = gather_rows(bodies.bodies, bodies.inv_inertia + 3, index, lane);
    const Vector third = gather_rows(bodies.bodies, bodies.inv_inertia + 6, index, lane);
    store(first.x, to.xx, lane);
    store(second.y, to.yy, lane);
    store(third.z, to.zz, lane);
    store(second.x, to.xy, lane);
    store(third.x, to.xz, lane);
    store(third.y, to.yz, lane);
}

void warm_start_impl(ContactBlock &block, const BodyReals &bodies, Real share, bool remember_first,
                     Real again) {
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        if (block.inertia_turns) {
            reload(block.inv_inertia_a, bodies, block.body_a, lane);
            reload(block.inv_inertia_b, bodies, block.body_b, lane);
        }
        Pair pair = load_pair(block, bodies, lane);
        const Vector n = load(block.normal, lane);
        const Vector t1 = load(block.t1, lane);
        const Vector t2 = cross(n, t1);
        Lanes kept = all(Real(1));
        if (remember_first) {
            Lanes sum = hn::Zero(tag);
            for (int k = 0; k < block.points_used; ++k)
                sum = hn::Add(sum, load(block.points[k].impulse.x, lane));
            const Lanes most = max(hn::Mul(all(remembered_blow), sum),
                                   hn::Mul(all(growing_blow), load(block.began, lane)));
            const auto forgets = hn::And(
                hn::Gt(load(block.struck, lane), load(block.pressed, lane)), hn::Gt(sum, most));
            kept = hn::IfThenElse(forgets, hn::Div(most, hn::IfThenElse(forgets, sum, kept)), kept);
            store(hn::Mul(kept, sum), block.began, lane);
        }
        Vector starts[4]; // NOLINT(modernize-avoid-c-arrays): of a type without a size
        for (int k = 0; k < block.points_used; ++k) {
            ContactBlock::Point &point = block.points[k];
            Vector before = load(point.impulse, lane);
            if (remember_first) {
                const Lanes relaxed =
                    hn::Mul(all(again), hn::Sub(before.x, load(point.remembered.x, lane)));
                before = times(kept, before);
                const Lanes most = hn::Mul(all(relaxed_share), before.x);
                before.x = hn::Add(before.x, max(min(relaxed, most), hn::Neg(most)));
                store(before, point.remembered, lane);
                starts[k] = times(all(share), before);
                store(starts[k], point.impulse, lane);
            } else {
                starts[k] = times(all(share), load(point.remembered, lane));
                const Vector sum = plus(before, starts[k]);
                store(sum, point.impulse, lane);
                store(sum, point.remembered, lane);
            }
        }
        const Patch patch = patch_of(block, lane);
        for (int k = 0; k < block.points_used; ++k) {
            const ContactBlock::Point &point = block.points[k];
            const Vector r_a = load(point.r_a, lane);
            const Vector r_b = load(point.r_b, lane);
            const Vector normal = times(starts[k].x, n);
            const Vector along_1 = times(starts[k].y, t1);
            const Vector along_2 = times(starts[k].z, t2);
            const Vector whole = plus(plus(normal, along_1), along_2);
            if (!patch.is_spread) {
                pair.apply(whole, r_a, r_b);
                continue;
            }
            // Lanes that do not spin get the same bits as in a block where none does (but for the
            // sign of a zero).
            const auto spins = hn::Lt(patch.spread, all(Real(1)));
            pair.apply(choose(spins, normal, whole), r_a, r_b);
            pair.apply(choose(spins, plus(along_1, along_2), zeros()), patch.arm_a(r_a),
                       patch.arm_b(r_b));
        }
        store_pair(pair, block, bodies, lane);
    }
}

// How a body turned since the step began.
struct Turned {
    Vector turn;         // the rotation vector
    Lanes along;         // along n
    Lanes squared;       // squared length
    Lanes first, second; // sin(x) / x and (1 - cos(x)) / x^2 of its length
};

// Beyond the limit of has_turned_far, series that are accurate to rounding for turns of up to two
// radians; within it, what separations need, whether or not another body turns far (`any_far`).
HWY_INLINE Turned turned_by(const Vector &turn, const Vector &n, bool any_far) {
    const Lanes x = dot(turn, turn);
    Turned out{turn, dot(turn, n), x, all(Real(1)), all(Real(0.5))};
    if (!any_far)
        return out;
    const auto series = [&](Real a, Real b, Real c, Real d, Real e) HWY_ATTR {
        Lanes sum = hn::Sub(all(d), hn::Mul(x, all(e)));
        sum = hn::Sub(all(c), hn::Mul(x, sum));
        sum = hn::Sub(all(b), hn::Mul(x, sum));
        return hn::Sub(all(a), hn::Mul(x, sum));
    };
    const auto far = hn::Gt(x, all(far_turn * far_turn));
    out.first = hn::IfThenElse(
        far, series(Real(1), Real(1) / 6, Real(1) / 120, Real(1) / 5040, Real(1) / 362880),
        out.first);
    out.second = hn::IfThenElse(
        far, series(Real(1) / 2, Real(1) / 24, Real(1) / 720, Real(1) / 40320, Real(1) / 3628800),
        out.second);
    return out;
}

// How far an arm's end moves along n when the arm turns (Rodrigues): with the core, the arm less
// its rounding along n, it is n . (first turn x r + second turn x (turn x core)).
HWY_INLINE Lanes way_along(const Vector &n, const Turned &by, const Vector &r, Lanes rounding) {
    const Lanes core_n = hn::Sub(dot(r, n), rounding);
    const Lanes core_turn = hn::Sub(dot(r, by.turn), hn::Mul(rounding, by.along));
    const Lanes second = hn::Sub(hn::Mul(by.along, core_turn), hn::Mul(by.squared, core_n));
    return hn::Add(hn::Mul(by.first, dot(n, cross(by.turn, r))), hn::Mul(by.second, second));
}

// Static and kinematic bodies, and those with all translations locked.
HWY_INLINE Mask does_not_move(const Vector &inv_mass) {
    return hn::Eq(hn::Add(inv_mass.x, hn::Add(inv_mass.y, inv_mass.z)), hn::Zero(tag));
}

// Whether either body keeps moving whatever the other does: a kinematic body.
HWY_INLINE Mask is_driven(const Pair &pair) {
    const auto drives = [](const Velocity &v, const Vector &inv_mass) HWY_ATTR {
        const Lanes squared = hn::Add(dot(v.linear, v.linear), dot(v.angular, v.angular));
        return hn::And(does_not_move(inv_mass), hn::Gt(squared, hn::Zero(tag)));
    };
    return hn::Or(drives(pair.a, pair.inv_mass_a), drives(pair.b, pair.inv_mass_b));
}

// Whether the impulse needed to stop a point is an impact, compared with the load it carries. A
// body that is driven by a kinematic one and carries far more is squeezed against something that
// does not move either. Rigid loads would grow without bound in each pass and shoot it away at
// thousands of m/s; those of springs give way.
HWY_INLINE Mask is_blow(Mask driven, Lanes borne, Lanes needed) {
    constexpr Real much = Real(0.25);
    return hn::Or(hn::Not(driven), hn::Lt(hn::Mul(all(much), borne), needed));
}

// One impulse for all points of a contact together, just as much as the point that needs least:
// otherwise the first corner of a body that lands flat would take most of the impact, and tilt it.
// Returns which of `fast` land flat. They are stopped rigidly, since of corners a hair deep and a
// hair apart some would be springs and some not.
template <typename SeparationAt, typename TargetOf>
HWY_INLINE Mask solve_evenly(ContactBlock &block, std::size_t lane, Pair &pair, const Vector &n,
                             Mask chosen, Mask fast, Mask driven, bool loaded_only, Lanes soft_mass,
                             Lanes soft_impulse, const SeparationAt &separation_at,
                             const TargetOf &target_of, Lanes &corrected) {
    const Lanes zero = hn::Zero(tag);
    const Lanes one = all(Real(1));
    const Lanes huge = all(std::numeric_limits<Real>::max());
    Vector r_a{zero, zero, zero}; // the mean of the points
    Vector r_b{zero, zero, zero};
    Lanes count = zero;
    Lanes softest = zero;
    Lanes least_rigid = huge;
    Lanes least_need = huge;
    Lanes most_need = hn::Neg(huge);
    Lanes least_load = huge;
    for (int k = 0; k < block.points_used; ++k) {
        const ContactBlock::Point &point = block.points[k];
        const Lanes mass = load(point.normal_mass, lane);
        const auto there = hn::Gt(mass, zero);
        const Lanes share = hn::IfThenElseZero(there, one);
        const Vector point_a = load(point.r_a, lane);
        const Vector point_b = load(point.r_b, lane);
        count = hn::Add(count, share);
        r_a = plus(r_a, times(share, point_a));
        r_b = plus(r_b, times(share, point_b));
        // How much a soft point yields to an impulse (1 / kg): where all points are alike, nothing
        // is left over for them one by one.
        const Lanes separation = separation_at(k);
        const auto is_soft = hn::And(there, hn::Le(separation, zero));
        const Lanes yielding = hn::IfThenElseZero(
            is_soft, hn::Div(soft_impulse, hn::Mul(soft_mass, hn::IfThenElse(there, mass, one))));
        const Lanes load_before = load(point.impulse.x, lane);
        const Lanes speed = dot(pair.velocity_at(point_a, point_b), n);
        const Lanes rigid_need = hn::Neg(hn::Add(speed, target_of(separation)));
        const Lanes need = hn::Sub(rigid_need, hn::Mul(yielding, load_before));
        softest = max(softest, yielding);
        least_rigid = hn::IfThenElse(there, min(least_rigid, rigid_need), least_rigid);
        least_need = hn::IfThenElse(there, min(least_need, need), least_need);
        most_need = hn::IfThenElse(there, max(most_need, need), most_need);
        least_load = hn::IfThenElse(there, min(least_load, load_before), least_load);
    }
    const Lanes share = hn::Div(one, max(count, one));
    r_a = times(share, r_a);
    r_b = times(share, r_b);
    const Turns of_n = turns(r_a, r_b, n);
    const Vector inv_mass = plus(pair.inv_mass_a, pair.inv_mass_b);
    const Lanes k_n = hn::Add(dot(n, times(inv_mass, n)),
                              hn::Add(dot(times(pair.inv_inertia_a, of_n.a), of_n.a),
                                      dot(times(pair.inv_inertia_b, of_n.b), of_n.b)));
    auto evenly = hn::And(chosen, hn::Gt(count, one));
    if (loaded_only)
        evenly = hn::And(evenly, hn::Gt(least_load, zero));
    const auto stops =
        hn::And(hn::And(evenly, fast),
                hn::And(hn::Gt(least_rigid, zero), is_blow(driven, hn::Mul(count, least_load),
                                                           hn::Mul(least_rigid, inverse(k_n)))));
    // Zero where the points disagree.
    const Lanes soft_need = max(least_need, min(most_need, zero));
    const Lanes need = hn::IfThenElse(stops, least_rigid, soft_need);
    const Lanes yielding = hn::IfThenZeroElse(stops, hn::Mul(share, softest));
    const Lanes sum = hn::Mul(need, inverse(hn::Add(k_n, yielding)));
    const Lanes each = hn::IfThenElseZero(evenly, max(hn::Mul(share, sum), hn::Neg(least_load)));
    corrected = hn::IfThenZeroElse(hn::Eq(each, zero), hn::Abs(need));
    pair.apply(times(hn::Mul(count, each), n), r_a, r_b);
    for (int k = 0; k < block.points_used; ++k) {
        ContactBlock::Point &point = block.points[k];
        const auto there = hn::Gt(load(point.normal_mass, lane), zero);
        store(hn::Add(load(point.impulse.x, lane), hn::IfThenElseZero(there, each)),
              point.impulse.x, lane);
    }
    return stops;
}

// Friction at each point. Returns where some points slide while others hold: the latter then carry
// more, which the points before them did not know.
HWY_INLINE Mask solve_friction(ContactBlock &block, std::size_t lane, Pair &pair,
                               const Patch &patch, const Vector &t1, const Vector &t2,
                               Lanes friction, Mask chosen, bool backwards) {
    const Lanes one = all(Real(1));
    auto any_slides = hn::FirstN(tag, 0);
    auto any_holds = hn::FirstN(tag, 0);
    for (int i = 0; i < block.points_used; ++i) {
        ContactBlock::Point &point = block.points[backwards ? block.points_used - 1 - i : i];
        const Vector r_a = patch.arm_a(load(point.r_a, lane));
        const Vector r_b = patch.arm_b(load(point.r_b, lane));
        const Vector v = pair.velocity_at(r_a, r_b);
        const Lanes before_1 = load(point.impulse.y, lane);
        const Lanes before_2 = load(point.impulse.z, lane);
        const Lanes mass = load(point.tangent_mass, lane);
        const Lanes new_1 = hn::Sub(before_1, hn::Mul(mass, dot(v, t1)));
        const Lanes new_2 = hn::Sub(before_2, hn::Mul(mass, dot(v, t2)));
        const Lanes length = hn::Sqrt(hn::Add(hn::Mul(new_1, new_1), hn::Mul(new_2, new_2)));
        const Lanes limit = hn::Mul(friction, load(point.impulse.x, lane));
        const auto slides = hn::Gt(length, limit);
        const Lanes scale =
            hn::IfThenElse(slides, hn::Div(limit, hn::IfThenElse(slides, length, one)), one);
        const Lanes after_1 = hn::IfThenElse(chosen, hn::Mul(scale, new_1), before_1);
        const Lanes after_2 = hn::IfThenElse(chosen, hn::Mul(scale, new_2), before_2);
        any_slides = hn::Or(any_slides, hn::And(slides, hn::Gt(limit, hn::Zero(tag))));
        any_holds = hn::Or(any_holds, hn::Lt(length, limit));
        pair.apply(
            plus(times(hn::Sub(after_1, before_1), t1), times(hn::Sub(after_2, before_2), t2)), r_a,
            r_b);
        store(after_1, point.impulse.y, lane);
        store(after_2, point.impulse.z, lane);
    }
    return hn::And(any_slides, any_holds);
}

void solve_impl(ContactBlock &block, const StartArms *start_arms, const BodyReals &bodies,
                const ContactBias &bias, Real inv_h, bool any_far) {
    const Lanes zero = hn::Zero(tag);
    const Lanes slop = all(bias.slop);
    const Lanes least = all(-bias.push_velocity);
    const bool pushes = bias.push_velocity > Real(0);
    const Lanes one = all(Real(1));
    // Without remembered impulses, friction tips a body before the normal impulses respond to it;
    // without further sweeps a body that slides off immediately would keep what it gains by that.
    const bool sweeps_all = block.is_new && !pushes;
    const Lanes struck_speed = all(-bias.struck_speed);
    const Lanes even_speed = all(even_share * bias.struck_speed);
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        Pair pair = load_pair(block, bodies, lane);
        const Patch patch = patch_of(block, lane);
        const auto driven = is_driven(pair);
        const auto on_static =
            hn::Or(does_not_move(pair.inv_mass_a), does_not_move(pair.inv_mass_b));
        const auto softness = [&](Real Softness::*member) HWY_ATTR {
            return hn::IfThenElse(on_static, all(bias.stiff.*member), all(bias.softness.*member));
        };
        const Lanes rate = softness(&Softness::bias_rate);
        const Lanes soft_mass = pushes ? softness(&Softness::mass_scale) : one;
        const Lanes soft_impulse = pushes ? softness(&Softness::impulse_scale) : zero;
        const Vector moved = minus(gather_rows(bodies.bodies, bodies.moved, block.body_b, lane),
                                   gather_rows(bodies.bodies, bodies.moved, block.body_a, lane));
        const Vector n = load(block.normal, lane);
        const Lanes way = dot(n, moved);
        const Turned turned_a =
            turned_by(gather_rows(bodies.bodies, bodies.turned, block.body_a, lane), n, any_far);
        const Turned turned_b =
            turned_by(gather_rows(bodies.bodies, bodies.turned, block.body_b, lane), n, any_far);
        // The normal points at b: its surface is on the other side of its core.
        const Lanes rounding_a = start_arms ? zero : load(block.rounding_a, lane);
        const Lanes rounding_b = start_arms ? zero : hn::Neg(load(block.rounding_b, lane));
        const Vector t1 = load(block.t1, lane);
        const Vector t2 = cross(n, t1);
        const Lanes friction = load(block.friction, lane);
        const auto bounces = hn::Gt(load(block.bounces, lane), zero);
        const auto separation_at = [&](int k) HWY_ATTR {
            const ContactBlock::Point &point = block.points[k];
            const Lanes way_a = way_along(n, turned_a,
                                          start_arms ? load(start_arms->points[k].core_a, lane)
                                                     : load(point.r_a, lane),
                                          rounding_a);
            const Lanes way_b = way_along(n, turned_b,
                                          start_arms ? load(start_arms->points[k].core_b, lane)
                                                     : load(point.r_b, lane),
                                          rounding_b);
            return hn::Add(load(point.separation, lane), hn::Add(way, hn::Sub(way_b, way_a)));
        };
        // The velocity added to a point's normal speed (m/s).
        const auto target_of = [&](Lanes separation) HWY_ATTR {
            const Lanes depth = min(hn::Add(separation, slop), zero);
            const Lanes push = pushes ? max(hn::Mul(rate, depth), least) : zero;
            return hn::IfThenElse(hn::Gt(separation, zero), hn::Mul(separation, all(inv_h)), push);
        };
        Lanes hard_load = zero; // N s
        if (bias.hardens)
            for (int k = 0; k < block.points_used; ++k)
                hard_load = hn::Add(hard_load, load(block.points[k].remembered.x, lane));
        hard_load = hn::Mul(all(hard_share), hard_load);
        // Judged by one point: when a body lands flat they are all alike.
        const Lanes first_speed = dot(
            pair.velocity_at(load(block.points[0].r_a, lane), load(block.points[0].r_b, lane)), n);
        auto struck = hn::Lt(first_speed, struck_speed);
        const auto even = hn::Gt(hn::Abs(first_speed), even_speed);
        auto stops = hn::FirstN(tag, 0);
        Lanes corrected = zero;
        if (block.points_used > 1 && !hn::AllFalse(tag, even))
            stops = solve_evenly(block, lane, pair, n, even, struck, driven, bias.loaded_only,
                                 soft_mass, soft_impulse, separation_at, target_of, corrected);
        // Struck contacts are swept again, too: otherwise the first of their corners would take
        // most of the impact, and tilt the body. (Zeros are lanes without a point.)
        auto again = hn::FirstN(tag, column_lanes);
        Lanes changed = zero; // the most that the last sweep changed a normal impulse
        Lanes most = zero;    // normal impulse
        for (int sweep = 0; sweep < most_sweeps; ++sweep) {
            if (sweep == 1 && !sweeps_all)
                again = struck;
            if (sweep > 0)
                again = hn::And(again, block.points_used <= few_points
                                           ? hn::Gt(changed, hn::Mul(all(swept_share), most))
                                           : hn::Gt(most, zero));
            if (hn::AllFalse(tag, again))
                break;
            const bool is_first = sweep == 0;
            changed = most = zero;
            for (int i = 0; i < block.points_used; ++i) {
                const int k = bias.backwards ? block.points_used - 1 - i : i;
                ContactBlock::Point &point = block.points[k];
                const Vector r_a = load(point.r_a, lane);
                const Vector r_b = load(point.r_b, lane);
                const Lanes separation = separation_at(k);
                const Lanes before = load(point.impulse.x, lane);
                const auto apart = hn::Gt(separation, zero);
                Lanes target = target_of(separation);
                Lanes own_mass = soft_mass;
                Lanes own_impulse = soft_impulse;
                if (bias.hardens) {
                    const Lanes beyond = load(block.hard_depth, lane);
                    const auto bears_most =
                        hn::AndNot(on_static, hn::Gt(load(point.remembered.x, lane), hard_load));
                    const auto is_hard = hn::And(bears_most, hn::Lt(separation, hn::Neg(beyond)));
                    // Four times as stiff from there on, where both push alike.
                    const Lanes depth = hn::Add(separation, hn::Mul(all(Real(0.75)), beyond));
                    const Lanes push = max(hn::Mul(all(bias.stiff.bias_rate), depth), least);
                    target = hn::IfThenElse(is_hard, push, target);
                    own_mass = hn::IfThenElse(is_hard, all(bias.stiff.mass_scale), own_mass);
                    own_impulse =
                        hn::IfThenElse(is_hard, all(bias.stiff.impulse_scale), own_impulse);
                }
                const Lanes speed = dot(pair.velocity_at(r_a, r_b), n);
                if (is_first)
                    struck = hn::Or(struck, hn::Lt(speed, struck_speed));
                // A point that comes in faster than anything is pushed out is stopped immediately:
                // as a spring it would be through a thin wall before it turned round.
                const auto breaks_in =
                    hn::And(hn::Lt(speed, least),
                            is_blow(driven, before,
                                    hn::Neg(hn::Mul(load(point.normal_mass, lane), speed))));
                const auto rigid = hn::Or(apart, hn::Or(stops, breaks_in));
                const Lanes mass_scale = hn::IfThenElse(rigid, one, own_mass);
                const Lanes impulse_scale = hn::IfThenElse(rigid, zero, own_impulse);
                const Lanes change =
                    hn::Sub(hn::Neg(hn::Mul(hn::Mul(load(point.normal_mass, lane), mass_scale),
                                            hn::Add(speed, target))),
                            hn::Mul(impulse_scale, before));
                Lanes total = max(hn::Add(before, change), zero);
                if (bias.loaded_only)
                    // Bouncing points that are a hair too deep are left to the next impacts.
                    total = hn::IfThenElse(hn::And(hn::Or(apart, bounces), hn::Eq(before, zero)),
                                           before, total);
                if (!is_first)
                    total = hn::IfThenElse(again, total, before);
                changed = max(changed, hn::Abs(hn::Sub(total, before)));
                most = max(most, total);
                corrected = max(corrected, hn::IfThenZeroElse(hn::Eq(total, before),
                                                              hn::Abs(hn::Add(speed, target))));
                pair.apply(times(hn::Sub(total, before), n), r_a, r_b);
                store(total, point.impulse.x, lane);
            }
            auto sliding = again;
            for (int pass = 0;
                 pass < (pushes ? most_friction_passes : 1) && !hn::AllFalse(tag, sliding); ++pass)
                sliding = hn::And(sliding, solve_friction(block, lane, pair, patch, t1, t2,
                                                          friction, sliding, bias.backwards));
        }
        store_pair(pair, block, bodies, lane);
        const Lanes before = pushes ? zero : load(block.struck, lane);
        store(hn::IfThenElse(struck, one, before), block.struck, lane);
        store(corrected, block.corrected, lane);
    }
    block.is_new = block.is_new && pushes;
}

} // namespace

void finish_blocks(std::span<ContactBlock> blocks) {
    for (ContactBlock &block : blocks)
        finish_block_impl(block);
}
void warm_start_blocks(std::span<ContactBlock> blocks, const BodyReals &bodies, Real share,
                       bool remember_first, Real again) {
    for (ContactBlock &block : blocks)
        warm_start_impl(block, bodies, share, remember_first, again);
}
void solve_blocks(std::span<ContactBlock> blocks, std::span<const StartArms> start_arms,
                  const BodyReals &bodies, const ContactBias &bias, Real inv_h, bool any_far) {
    for (ContactBlock &block : blocks)
        solve_impl(block, block.ahead == ContactBlock::none ? nullptr : &start_arms[block.ahead],
                   bodies, bias, inv_h, any_far);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(finish_blocks);
HWY_EXPORT(warm_start_blocks);
HWY_EXPORT(solve_blocks);

void finish(std::span<ContactBlock> blocks) {
    HWY_DYNAMIC_DISPATCH(finish_blocks)(blocks);
}
void warm_start(std::span<ContactBlock> blocks, const BodyReals &bodies, Real share,
                bool remember_first, Real again) {
    HWY_DYNAMIC_DISPATCH(warm_start_blocks)(blocks, bodies, share, remember_first, again);
}
void solve(std::span<ContactBlock> blocks, std::span<const StartArms> start_arms,
           const BodyReals &bodies, const ContactBias &bias, Real inv_h, bool any_far) {
    HWY_DYNAMIC_DISPATCH(solve_blocks)(blocks, start_arms, bodies, bias, inv_h, any_far);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
