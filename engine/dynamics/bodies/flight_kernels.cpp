// What soft_step does with a block of flights. Compiled once per instruction set, by including
// itself. Each lane sees the operations of the functions in motion.cpp that its comments name.
#include "engine/dynamics/bodies/flight_columns.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/bodies/flight_kernels.cpp"
// Vectors of unknown size cannot be members.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
#include <limits>
#include <type_traits>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/dynamics/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace columns::HWY_NAMESPACE; // NOLINT(google-build-using-namespace)
constexpr Real epsilon = std::numeric_limits<Real>::epsilon();

HWY_INLINE Vector over(const Vector &v, Lanes s) {
    return {hn::Div(v.x, s), hn::Div(v.y, s), hn::Div(v.z, s)};
}

// A quaternion.
template <typename AnyLanes> struct Rotation {
    wide::HWY_NAMESPACE::Vector<AnyLanes> axis;
    AnyLanes w;
};

template <typename AnyLanes> HWY_INLINE AnyLanes squared(const Rotation<AnyLanes> &q) {
    return hn::Add(hn::Add(hn::Mul(q.w, q.w), hn::Mul(q.axis.x, q.axis.x)),
                   hn::Add(hn::Mul(q.axis.y, q.axis.y), hn::Mul(q.axis.z, q.axis.z)));
}

HWY_INLINE Rotation<Lanes> conjugate(const Rotation<Lanes> &q) {
    return {{hn::Neg(q.axis.x), hn::Neg(q.axis.y), hn::Neg(q.axis.z)}, q.w};
}

HWY_INLINE Rotation<Lanes> product(const Rotation<Lanes> &p, const Rotation<Lanes> &q) {
    const auto row = [](Lanes a, Lanes b, Lanes c, Lanes d, Lanes e, Lanes f, Lanes g,
                        Lanes h) HWY_ATTR {
        return hn::Sub(hn::Add(hn::Add(hn::Mul(a, b), hn::Mul(c, d)), hn::Mul(e, f)),
                       hn::Mul(g, h));
    };
    const Lanes w = hn::Sub(hn::Sub(hn::Sub(hn::Mul(p.w, q.w), hn::Mul(p.axis.x, q.axis.x)),
                                    hn::Mul(p.axis.y, q.axis.y)),
                            hn::Mul(p.axis.z, q.axis.z));
    return {{row(p.w, q.axis.x, p.axis.x, q.w, p.axis.y, q.axis.z, p.axis.z, q.axis.y),
             row(p.w, q.axis.y, p.axis.y, q.w, p.axis.z, q.axis.x, p.axis.x, q.axis.z),
             row(p.w, q.axis.z, p.axis.z, q.w, p.axis.x, q.axis.y, p.axis.y, q.axis.x)},
            w};
}

HWY_INLINE Rotation<Lanes> normalized(const Rotation<Lanes> &q) {
    const Lanes inverse = hn::Div(all(Real(1)), hn::Sqrt(squared(q)));
    return {times(inverse, q.axis), hn::Mul(q.w, inverse)};
}

HWY_INLINE Rotation<Lanes> select(Mask which, const Rotation<Lanes> &yes,
                                  const Rotation<Lanes> &no) {
    return {choose(which, yes.axis, no.axis), hn::IfThenElse(which, yes.w, no.w)};
}

template <typename Change>
HWY_INLINE Rotation<Lanes> each(const Rotation<Lanes> &p, const Rotation<Lanes> &q,
                                const Change &change) {
    return {{change(p.axis.x, q.axis.x), change(p.axis.y, q.axis.y), change(p.axis.z, q.axis.z)},
            change(p.w, q.w)};
}
HWY_INLINE Rotation<Lanes> sum(const Rotation<Lanes> &p, const Rotation<Lanes> &q) {
    return each(p, q, [](Lanes a, Lanes b) HWY_ATTR { return hn::Add(a, b); });
}
HWY_INLINE Rotation<Lanes> difference(const Rotation<Lanes> &p, const Rotation<Lanes> &q) {
    return each(p, q, [](Lanes a, Lanes b) HWY_ATTR { return hn::Sub(a, b); });
}

// rotated (types.h).
HWY_INLINE Vector rotated(const Rotation<Lanes> &q, const Vector &v) {
    const Lanes scale = hn::Div(all(Real(2)), squared(q));
    const Vector once = plus(cross(q.axis, v), times(q.w, v));
    return plus(v, times(scale, cross(q.axis, once)));
}

template <typename D> using VectorOf = wide::HWY_NAMESPACE::Vector<hn::Vec<D>>;
template <typename D> using RotationOf = Rotation<hn::Vec<D>>;

// turned_to_rounding, in lanes of doubles ...
template <typename D>
HWY_INLINE VectorOf<D> turned_in_double(D d, const RotationOf<D> &q, const VectorOf<D> &v) {
    const auto aside = cross(q.axis, v);
    const auto scale = hn::Div(hn::Set(d, 2.0), squared(q));
    return plus(v, times(scale, plus(times(q.w, aside), cross(q.axis, aside))));
}

// ... and for `from`, lanes of floats, as many.
template <typename From>
HWY_INLINE VectorOf<From> turned_wider(From from, const RotationOf<From> &q,
                                       const VectorOf<From> &v) {
    constexpr hn::Rebind<double, From> d{};
    const auto up = [&](auto x) HWY_ATTR { return hn::PromoteTo(d, x); };
    const auto down = [&](auto x) HWY_ATTR { return hn::DemoteTo(from, x); };
    const auto out = turned_in_double(
        d, RotationOf<decltype(d)>{{up(q.axis.x), up(q.axis.y), up(q.axis.z)}, up(q.w)},
        {up(v.x), up(v.y), up(v.z)});
    return {down(out.x), down(out.y), down(out.z)};
}

template <typename D = Tag>
HWY_INLINE VectorOf<D> turned_to_rounding(const RotationOf<D> &q, const VectorOf<D> &v) {
    constexpr D d{};
    if constexpr (std::is_same_v<hn::TFromD<D>, double>) {
        return turned_in_double(d, q, v);
    } else {
#if HWY_TARGET == HWY_SCALAR
        return turned_wider(d, q, v);
#else
        constexpr hn::Half<D> half{};
        const auto part = [&](auto take) HWY_ATTR {
            return turned_wider(half,
                                RotationOf<decltype(half)>{
                                    {take(q.axis.x), take(q.axis.y), take(q.axis.z)}, take(q.w)},
                                VectorOf<decltype(half)>{take(v.x), take(v.y), take(v.z)});
        };
        const auto low = part([&](auto x) HWY_ATTR { return hn::LowerHalf(half, x); });
        const auto high = part([&](auto x) HWY_ATTR { return hn::UpperHalf(half, x); });
        return {hn::Combine(d, high.x, low.x), hn::Combine(d, high.y, low.y),
                hn::Combine(d, high.z, low.z)};
#endif
    }
}

HWY_INLINE Vector turned_back(const Rotation<Lanes> &q, const Vector &v) {
    if constexpr (std::is_same_v<Real, double>)
        return rotated(q, v);
    else
        return turned_to_rounding<>(q, v);
}

struct FreeSpin {
    Vector end, mean; // damped
    Mask is_lost;     // gyroscopic_spin did not converge
};

// symmetric_spin, about each lane's axis.
HWY_INLINE Vector symmetric_spin(const FlightBlock &block, const Vector &spin, std::size_t lane) {
    const Lanes axis = load(block.symmetry_axis, lane);
    const Mask about_x = hn::Eq(axis, all(Real(0)));
    const Mask about_y = hn::Eq(axis, all(Real(1)));
    const auto pick = [&](Lanes x, Lanes y, Lanes z) HWY_ATTR {
        return hn::IfThenElse(about_x, x, hn::IfThenElse(about_y, y, z));
    };
    const Lanes i = pick(spin.y, spin.z, spin.x);
    const Lanes j = pick(spin.z, spin.x, spin.y);
    const Lanes k = pick(spin.x, spin.y, spin.z);
    const Lanes c = hn::Mul(load(block.precession, lane), k);
    const Lanes turn = hn::Div(hn::Mul(all(Real(2)), c), hn::Add(all(Real(1)), hn::Mul(c, c)));
    const Lanes end_i = hn::Add(i, hn::Mul(turn, hn::Sub(j, hn::Mul(c, i))));
    const Lanes end_j = hn::Sub(j, hn::Mul(turn, hn::Add(i, hn::Mul(c, j))));
    return {pick(k, end_j, end_i), pick(end_i, k, end_j), pick(end_j, end_i, k)};
}

// The Newton iteration of gyroscopic_spin, for the lanes in `which`.
HWY_INLINE Vector newton_spin(const Vector &inertia, const Vector &spin, Real h, int iterations,
                              Mask which, Mask &is_lost) {
    const Vector torque =
        times(all(h), Vector{hn::Sub(inertia.z, inertia.y), hn::Sub(inertia.x, inertia.z),
                             hn::Sub(inertia.y, inertia.x)});
    const Lanes a_half = all(Real(0.5));
    const Vector half = times(a_half, torque);
    const Lanes enough = hn::Mul(all(epsilon / Real(8)), dot(spin, spin));
    Vector change = zeros();
    Mask goes_on = which;
    for (int i = 0; i < iterations && !hn::AllFalse(tag, goes_on); ++i) {
        const Vector mid = plus(spin, times(a_half, change));
        const Vector crossed{hn::Mul(mid.y, mid.z), hn::Mul(mid.z, mid.x), hn::Mul(mid.x, mid.y)};
        const Vector residual = plus(times(inertia, change), times(torque, crossed));
        const Vector x{inertia.x, hn::Mul(half.x, mid.z), hn::Mul(half.x, mid.y)};
        const Vector y{hn::Mul(half.y, mid.z), inertia.y, hn::Mul(half.y, mid.x)};
        const Vector z{hn::Mul(half.z, mid.y), hn::Mul(half.z, mid.x), inertia.z};
        const Vector yz = cross(y, z);
        const Vector sum = plus(plus(times(residual.x, yz), times(residual.y, cross(z, x))),
                                times(residual.z, cross(x, y)));
        const Vector step = over(sum, dot(x, yz));
        change = choose(goes_on, minus(change, step), change);
        goes_on = hn::AndNot(hn::Le(dot(step, step), enough), goes_on);
    }
    const Vector end = plus(spin, change);
    const Lanes before = dot(times(inertia, spin), spin);
    const Lanes after = dot(times(inertia, end), end);
    const Mask is_kept =
        hn::Le(hn::Abs(hn::Sub(after, before)), hn::Mul(all(Real(32) * epsilon), before));
    is_lost = hn::AndNot(is_kept, which);
    return end;
}

// turn_freely.
HWY_INLINE FreeSpin turn_freely(const FlightBlock &block, const Vector &start, Real h,
                                int iterations, Mask which, std::size_t lane) {
    FreeSpin out;
    out.is_lost = hn::FirstN(tag, 0);
    const Mask is_symmetric = hn::And(which, hn::Lt(load(block.symmetry_axis, lane), all(Real(3))));
    const Mask is_general = hn::AndNot(is_symmetric, which);
    Vector undamped = start;
    if (!hn::AllFalse(tag, is_general))
        undamped =
            newton_spin(load(block.inertia, lane), start, h, iterations, is_general, out.is_lost);
    if (!hn::AllFalse(tag, is_symmetric))
        undamped = choose(is_symmetric, symmetric_spin(block, start, lane), undamped);
    out.end = times(load(block.spin_kept, lane), undamped);
    out.mean =
        times(load(block.mean_spin_kept, lane), times(all(Real(0.5)), plus(start, undamped)));
    return out;
}

HWY_INLINE Rotation<Lanes> gather_rotation(const Real *first, int axis, int w,
                                           const IndexColumn &index, std::size_t lane) {
    return {gather_rows(first, axis, index, lane),
            hn::GatherIndex(tag, first + w, load(index, lane))};
}

HWY_INLINE void scatter_one(Lanes x, Real *first, int offset, const IndexColumn &index,
                            unsigned writes, std::size_t lane) {
    HWY_ALIGN Real out[column_lanes];
    hn::Store(x, tag, out);
    for (std::size_t k = 0; k < hn::Lanes(tag); ++k)
        if (((writes >> (lane + k)) & 1U) != 0)
            first[index.lanes[lane + k] + offset] = out[k];
}

// begin_flight.
void begin_impl(FlightBlock &block, const BodyReals &bodies, Real h, int iterations) {
    block.left = 0;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        const Vector velocity = gather_rows(bodies.bodies, bodies.velocity, block.body, lane);
        const Vector angular =
            gather_rows(bodies.bodies, bodies.angular_velocity, block.body, lane);
        const Vector mean =
            plus(times(load(block.mean_kept, lane), velocity), load(block.mean_gain, lane));
        store(mean, block.mean_velocity, lane);
        store(mean, block.velocity, lane);
        store(plus(times(load(block.late_kept, lane), velocity), load(block.late_gain, lane)),
              block.late_velocity, lane);
        Vector spin = angular;
        Vector late_spin = zeros();
        const Mask is_damped = lanes_of(block.spin_damped, lane);
        const Mask is_gyroscopic = lanes_of(block.gyroscopic, lane);
        if (!hn::AllFalse(tag, is_damped)) {
            const Lanes kept = load(block.mean_spin_kept, lane);
            spin = choose(is_damped, times(kept, spin), spin);
            late_spin =
                choose(hn::AndNot(is_gyroscopic, is_damped),
                       times(hn::Sub(load(block.spin_kept, lane), kept), angular), late_spin);
        }
        if (!hn::AllFalse(tag, is_gyroscopic)) {
            const Rotation<Lanes> rotation = gather_rotation(bodies.bodies, bodies.rotation,
                                                             bodies.rotation_w, block.body, lane);
            const Vector start = turned_to_rounding(conjugate(rotation), angular);
            const FreeSpin free = turn_freely(block, start, h, iterations, is_gyroscopic, lane);
            block.left = static_cast<std::uint16_t>(block.left | bits_of(free.is_lost, lane));
            store(start, block.start_spin, lane);
            store(free.mean, block.mean_spin, lane);
            store(free.end, block.end_spin, lane);
            spin = choose(is_gyroscopic, turned_back(rotation, free.mean), spin);
        }
        store(late_spin, block.late_spin, lane);
        store(spin, block.angular_velocity, lane);
        scatter_rows(mean, spin, bodies.bodies, bodies.velocity, block.body,
                     block.in_lanes & ~unsigned{block.left}, lane);
    }
}

HWY_INLINE Mask equal(const Vector &a, const Vector &b) {
    return hn::And(hn::And(hn::Eq(a.x, b.x), hn::Eq(a.y, b.y)), hn::Eq(a.z, b.z));
}

// The inverse inertia in world axes.
HWY_INLINE Symmetric inverse_inertia(const Rotation<Lanes> &q, const Vector &own) {
    const Lanes one = all(Real(1));
    const Lanes two = all(Real(2));
    const auto twice = [&](Lanes a) HWY_ATTR { return hn::Mul(two, a); };
    const Lanes xx = hn::Mul(q.axis.x, q.axis.x);
    const Lanes yy = hn::Mul(q.axis.y, q.axis.y);
    const Lanes zz = hn::Mul(q.axis.z, q.axis.z);
    const Lanes xz = hn::Mul(q.axis.x, q.axis.z);
    const Lanes xy = hn::Mul(q.axis.x, q.axis.y);
    const Lanes yz = hn::Mul(q.axis.y, q.axis.z);
    const Lanes wx = hn::Mul(q.w, q.axis.x);
    const Lanes wy = hn::Mul(q.w, q.axis.y);
    const Lanes wz = hn::Mul(q.w, q.axis.z);
    const Vector x{hn::Sub(one, twice(hn::Add(yy, zz))), twice(hn::Add(xy, wz)),
                   twice(hn::Sub(xz, wy))};
    const Vector y{twice(hn::Sub(xy, wz)), hn::Sub(one, twice(hn::Add(xx, zz))),
                   twice(hn::Add(yz, wx))};
    const Vector z{twice(hn::Add(xz, wy)), twice(hn::Sub(yz, wx)),
                   hn::Sub(one, twice(hn::Add(xx, yy)))};
    const Vector scaled_x = times(own.x, x);
    const Vector scaled_y = times(own.y, y);
    const Vector scaled_z = times(own.z, z);
    const auto entry = [](Lanes a, Lanes b, Lanes c, Lanes d, Lanes e, Lanes f) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(a, b), hn::Mul(c, d)), hn::Mul(e, f));
    };
    return {entry(scaled_x.x, x.x, scaled_y.x, y.x, scaled_z.x, z.x),
            entry(scaled_x.y, x.y, scaled_y.y, y.y, scaled_z.y, z.y),
            entry(scaled_x.z, x.z, scaled_y.z, y.z, scaled_z.z, z.z),
            entry(scaled_x.x, x.y, scaled_y.x, y.y, scaled_z.x, z.y),
            entry(scaled_x.x, x.z, scaled_y.x, y.z, scaled_z.x, z.z),
            entry(scaled_x.y, x.z, scaled_y.y, y.z, scaled_z.y, z.z)};
}

struct Turned {
    Rotation<Lanes> rotation;
    Rotation<Lanes> rounded_off;
    Mask is_far; // beyond the series
};

// turn (motion.h).
HWY_INLINE Turned turned(const Rotation<Lanes> &from, const Rotation<Lanes> &rounded_off,
                         const Vector &spin, Real h) {
    constexpr Real near = std::numeric_limits<Real>::digits > 24 ? Real(1e-5) : Real(1e-2);
    const Lanes squared_angle = hn::Mul(dot(spin, spin), all(h * h));
    const Lanes one = all(Real(1));
    const Lanes a_half = all(Real(0.5));
    const Lanes x = hn::Mul(all(Real(0.25)), squared_angle);
    const auto less_by = [&](Lanes from_what, Lanes what)
                             HWY_ATTR { return hn::Sub(from_what, hn::Mul(x, what)); };
    const Lanes sine = less_by(a_half, less_by(all(Real(1) / 12), all(Real(1) / 240)));
    const Lanes less = hn::Mul(x, less_by(a_half, less_by(all(Real(1) / 24), all(Real(1) / 720))));
    const Rotation<Lanes> way =
        product(Rotation<Lanes>{times(hn::Mul(sine, all(h)), spin), hn::Neg(less)}, from);
    const Rotation<Lanes> whole = sum(way, rounded_off);
    const Rotation<Lanes> to = sum(from, whole);
    const Rotation<Lanes> left_over = difference(whole, difference(to, from));
    const Mask is_off = hn::Gt(hn::Abs(hn::Sub(squared(to), one)), all(Real(8) * epsilon));
    const Rotation<Lanes> nothing{zeros(), hn::Zero(tag)};
    const Mask stays = hn::Eq(squared_angle, hn::Zero(tag));
    return {select(stays, from, select(is_off, normalized(to), to)),
            select(stays, rounded_off, select(is_off, nothing, left_over)),
            hn::Not(hn::Lt(squared_angle, all(near)))};
}

// move_held and end_flight.
void end_impl(FlightBlock &block, const BodyReals &bodies, Real *rounded_off, Real h,
              int iterations) {
    block.left = 0;
    block.far = 0;
    // A RoundedOff begins like a Motion.
    static_assert(offsetof(RoundedOff, position) == offsetof(Motion, position) &&
                  offsetof(RoundedOff, rotation) == offsetof(Motion, rotation));
    const int rounded_axis = bodies.rotation;
    const int rounded_w = bodies.rotation_w;
    for (std::size_t lane = 0; lane < block.used; lane += hn::Lanes(tag)) {
        Vector velocity = gather_rows(bodies.bodies, bodies.velocity, block.body, lane);
        Vector angular = gather_rows(bodies.bodies, bodies.angular_velocity, block.body, lane);
        const Vector given_spin = load(block.angular_velocity, lane);
        const Mask is_free =
            hn::And(equal(velocity, load(block.velocity, lane)), equal(angular, given_spin));
        const Rotation<Lanes> from =
            gather_rotation(bodies.bodies, bodies.rotation, bodies.rotation_w, block.body, lane);
        const Mask is_gyroscopic = lanes_of(block.gyroscopic, lane);
        Mask turns_by_mean = is_free;
        Mask is_lost = hn::FirstN(tag, 0);
        Vector mean_spin = zeros();
        Vector end_spin = zeros();
        if (!hn::AllFalse(tag, is_gyroscopic)) {
            mean_spin = load(block.mean_spin, lane);
            end_spin = load(block.end_spin, lane);
            const Vector start_spin = load(block.start_spin, lane);
            constexpr Real far = Real(1e-3); // turns_far
            const Mask turns_far =
                hn::Gt(hn::Mul(dot(start_spin, start_spin), all(h * h)), all(far * far));
            const Mask is_loaded = lanes_of(block.loaded, lane);
            const Mask is_jointed = lanes_of(block.jointed, lane);
            const Mask is_sprung = lanes_of(block.sprung, lane);
            const Mask is_held =
                hn::And(hn::AndNot(is_free, is_gyroscopic),
                        hn::Or(hn::Or(is_jointed, is_sprung), hn::And(is_loaded, turns_far)));
            if (!hn::AllFalse(tag, is_held)) {
                const Vector start =
                    plus(start_spin, rotated(conjugate(from), minus(angular, given_spin)));
                const FreeSpin free = turn_freely(block, start, h, iterations, is_held, lane);
                is_lost = free.is_lost;
                mean_spin = choose(is_held, free.mean, mean_spin);
                end_spin = choose(is_held, free.end, end_spin);
                angular = choose(is_held, turned_back(from, free.mean), angular);
                turns_by_mean =
                    hn::Or(turns_by_mean,
                           hn::And(is_held, hn::AndNot(hn::Or(is_jointed, is_loaded), is_sprung)));
            }
        }

        // move_along
        const Vector way =
            times(all(h), choose(is_free, load(block.mean_velocity, lane), velocity));
        const Vector position = gather_rows(bodies.bodies, bodies.position, block.body, lane);
        const Vector whole = plus(way, gather_rows(rounded_off, 0, block.rounded_off, lane));
        const Vector to = plus(position, whole);
        const Vector position_off = minus(whole, minus(to, position));
        const Vector moved = plus(gather_rows(bodies.bodies, bodies.moved, block.body, lane), way);
        const Vector turn = plus(gather_rows(bodies.bodies, bodies.turned, block.body, lane),
                                 times(all(h), angular));
        const Rotation<Lanes> off_before =
            gather_rotation(rounded_off, rounded_axis, rounded_w, block.rounded_off, lane);
        Turned end = turned(from, off_before, angular, h);
        const Mask by_mean = hn::And(is_gyroscopic, turns_by_mean);
        if (!hn::AllFalse(tag, by_mean)) {
            // cayley
            const Rotation<Lanes> by =
                normalized(Rotation<Lanes>{times(all(Real(0.5) * h), mean_spin), all(Real(1))});
            end.rotation = select(by_mean, normalized(product(from, by)), end.rotation);
            end.rounded_off = select(by_mean, off_before, end.rounded_off);
            end.is_far = hn::AndNot(by_mean, end.is_far);
        }
        block.left =
            static_cast<std::uint16_t>(block.left | bits_of(hn::Or(is_lost, end.is_far), lane));
        const unsigned writes = block.in_lanes & ~unsigned{block.left};
        block.far = static_cast<std::uint16_t>(
            block.far |
            (writes & bits_of(hn::Gt(dot(turn, turn), all(far_turn * far_turn)), lane)));

        // end_driven
        velocity = plus(velocity, load(block.late_velocity, lane));
        angular = plus(angular, load(block.late_spin, lane));
        if (!hn::AllFalse(tag, is_gyroscopic)) {
            const Mask flies = hn::And(is_gyroscopic, is_free);
            const Mask is_pushed = hn::AndNot(is_free, is_gyroscopic);
            if (!hn::AllFalse(tag, is_pushed))
                angular = choose(is_pushed,
                                 plus(angular, rotated(end.rotation, minus(end_spin, mean_spin))),
                                 angular);
            if (!hn::AllFalse(tag, flies))
                angular = choose(flies, turned_to_rounding(end.rotation, end_spin), angular);
            const Symmetric inverse = inverse_inertia(end.rotation, load(block.inv_inertia, lane));
            const unsigned turning = writes & block.gyroscopic;
            scatter_rows({inverse.xx, inverse.xy, inverse.xz}, {inverse.xy, inverse.yy, inverse.yz},
                         bodies.bodies, bodies.inv_inertia, block.body, turning, lane);
            scatter({inverse.xz, inverse.yz, inverse.zz}, bodies.bodies, bodies.inv_inertia + 6,
                    block.body, turning, lane);
        }
        scatter_rows(velocity, angular, bodies.bodies, bodies.velocity, block.body, writes, lane);
        scatter_rows(moved, turn, bodies.bodies, bodies.moved, block.body, writes, lane);
        scatter(to, bodies.bodies, bodies.position, block.body, writes, lane);
        scatter(end.rotation.axis, bodies.bodies, bodies.rotation, block.body, writes, lane);
        scatter_one(end.rotation.w, bodies.bodies, bodies.rotation_w, block.body, writes, lane);
        scatter(position_off, rounded_off, 0, block.rounded_off, writes, lane);
        scatter(end.rounded_off.axis, rounded_off, rounded_axis, block.rounded_off, writes, lane);
        scatter_one(end.rounded_off.w, rounded_off, rounded_w, block.rounded_off, writes, lane);
    }
}

} // namespace

void begin_flights(std::span<FlightBlock> blocks, const BodyReals &bodies, Real h, int iterations) {
    for (FlightBlock &block : blocks)
        begin_impl(block, bodies, h, iterations);
}
void end_flights(std::span<FlightBlock> blocks, const BodyReals &bodies, Real *rounded_off, Real h,
                 int iterations) {
    for (FlightBlock &block : blocks)
        end_impl(block, bodies, rounded_off, h, iterations);
}

} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(begin_flights);
HWY_EXPORT(end_flights);

void begin(std::span<FlightBlock> blocks, const BodyReals &bodies, Real h, int iterations) {
    HWY_DYNAMIC_DISPATCH(begin_flights)(blocks, bodies, h, iterations);
}
void end(std::span<FlightBlock> blocks, const BodyReals &bodies, Real *rounded_off, Real h,
         int iterations) {
    HWY_DYNAMIC_DISPATCH(end_flights)(blocks, bodies, rounded_off, h, iterations);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
