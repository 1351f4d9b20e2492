// Compiled once per instruction set, by including itself.
#include "engine/geometry/batch_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/geometric.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/geometry/batch_kernels.cpp"
// Vectors of unknown size cannot be array elements.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// After foreach_target.h, which must choose the target first.
#include <hwy/highway.h>

#include "engine/math/wide_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<Real>;
using Lanes = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using Vector = wide::HWY_NAMESPACE::Vector<Lanes>;
using wide::HWY_NAMESPACE::cross;
using wide::HWY_NAMESPACE::dot;
using wide::HWY_NAMESPACE::max;
using wide::HWY_NAMESPACE::min;
using wide::HWY_NAMESPACE::minus;
using wide::HWY_NAMESPACE::plus;
using wide::HWY_NAMESPACE::times;

constexpr Tag tag{};
constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr Real epsilon = std::numeric_limits<Real>::epsilon();

HWY_INLINE Lanes all(Real x) {
    return hn::Set(tag, x);
}

HWY_INLINE Mask none() {
    return hn::Lt(hn::Zero(tag), hn::Zero(tag));
}
HWY_INLINE Mask is_number(Lanes x) {
    return hn::Eq(x, x);
}
HWY_INLINE Mask is_finite(Lanes x) {
    return hn::Le(hn::Abs(x), all(std::numeric_limits<Real>::max()));
}

HWY_INLINE Vector all(const Vec3 &v) {
    return {all(v.x), all(v.y), all(v.z)};
}
HWY_INLINE Mask is_finite(const Vector &v) {
    return hn::And(hn::And(is_finite(v.x), is_finite(v.y)), is_finite(v.z));
}

HWY_INLINE std::uint64_t bits_of(Mask mask) {
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    // Load no more bytes than were stored: a load spanning two stores stalls.
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, (hn::MaxLanes(tag) + 7) / 8);
    return bits;
}

// The answers for one block; at least one of each kind, since arrays cannot be empty.
template <std::size_t Bits, std::size_t Reals> struct Answers {
    Mask bits[Bits];
    Lanes reals[Reals];
    Mask is_valid;
};

// Calls ask(columns) for each block of elements; the last block is padded with copies of the last
// element. Vector sizes divide 64, so a block's bits never straddle two words.
template <std::size_t In, std::size_t Bits, std::size_t Reals, typename Ask>
HWY_INLINE bool for_each_block(const Real *const (&in)[In], std::size_t count,
                               std::uint64_t *const (&bits)[Bits], Real *const (&reals)[Reals],
                               const Ask &ask) {
    constexpr std::size_t size = hn::MaxLanes(tag);
    Mask is_valid = hn::Not(none());
    const auto keep_bits = [&](std::size_t i, const Mask(&answers)[Bits],
                               std::uint64_t wanted) HWY_ATTR {
        for (std::size_t k = 0; k < Bits; ++k) {
            const std::uint64_t others = i % 64 == 0 ? 0 : bits[k][i / 64];
            bits[k][i / 64] = others | ((bits_of(answers[k]) & wanted) << (i % 64));
        }
    };
    std::size_t i = 0;
    for (; i + size <= count; i += size) {
        Lanes columns[In];
        for (std::size_t k = 0; k < In; ++k)
            columns[k] = hn::LoadU(tag, in[k] + i);
        const Answers<Bits, Reals> answers = ask(columns);
        is_valid = hn::And(is_valid, answers.is_valid);
        keep_bits(i, answers.bits, ~std::uint64_t(0));
        for (std::size_t k = 0; k < Reals; ++k)
            if (reals[k] != nullptr)
                hn::StoreU(answers.reals[k], tag, reals[k] + i);
    }
    if (i < count) {
        HWY_ALIGN Real block[size];
        Lanes columns[In];
        for (std::size_t k = 0; k < In; ++k) {
            for (std::size_t j = 0; j < size; ++j)
                block[j] = in[k][std::min(i + j, count - 1)];
            columns[k] = hn::Load(tag, block);
        }
        const Answers<Bits, Reals> answers = ask(columns);
        is_valid = hn::And(is_valid, answers.is_valid);
        keep_bits(i, answers.bits, (std::uint64_t(1) << (count - i)) - 1);
        for (std::size_t k = 0; k < Reals; ++k) {
            if (reals[k] == nullptr)
                continue;
            hn::Store(answers.reals[k], tag, block);
            std::copy(block, block + (count - i), reals[k] + i);
        }
    }
    return hn::AllTrue(tag, is_valid);
}

// Bits only.
template <std::size_t In, typename Ask>
HWY_INLINE bool for_each_block(const Real *const (&in)[In], std::size_t count, std::uint64_t *bits,
                               const Ask &ask) {
    std::uint64_t *const bit_columns[1] = {bits};
    Real *const no_reals[1] = {nullptr};
    return for_each_block(in, count, bit_columns, no_reals,
                          [&](const Lanes(&columns)[In]) HWY_ATTR {
                              Answers<1, 1> answers{{none()}, {hn::Zero(tag)}, none()};
                              ask(columns, answers.bits[0], answers.is_valid);
                              return answers;
                          });
}

// The interval where `met`, zeros elsewhere.
HWY_INLINE Answers<1, 2> interval(Mask met, Lanes enter, Lanes exit, Mask is_valid) {
    return {{met}, {hn::IfThenElseZero(met, enter), hn::IfThenElseZero(met, exit)}, is_valid};
}

// slab_interval (slab.h), with what ray_interval for an Aabb adds to it.
struct Slabs {
    Lanes enter, exit;
    Mask missed;

    HWY_INLINE Slabs() : enter(hn::Zero(tag)), exit(all(infinity)), missed(none()) {}
    HWY_INLINE void cut(Lanes to_low, Lanes to_high) {
        enter = max(enter, min(to_low, to_high));
        exit = min(exit, max(to_low, to_high));
    }
    HWY_INLINE Mask finish(Lanes max_t) {
        const Lanes slack = all(Real(1) + Real(4) * epsilon);
        const Lanes least = all(std::numeric_limits<Real>::min());
        missed = hn::Or(missed, hn::Lt(exit, hn::Zero(tag)));
        missed = hn::Or(missed, hn::Gt(enter, hn::Add(hn::Mul(exit, slack), least)));
        missed = hn::Or(missed, hn::Gt(enter, hn::Mul(max_t, slack)));
        enter = min(enter, max_t);
        exit = min(max(exit, enter), max_t);
        return hn::AndNot(hn::Or(missed, hn::Eq(enter, all(infinity))), hn::Ge(exit, enter));
    }
};

HWY_ATTR bool ray_against_aabbs(const AabbBatch &boxes, const Ray &ray, const IntervalBatch &out) {
    const Real *const in[6] = {boxes.min_x.data(), boxes.min_y.data(), boxes.min_z.data(),
                               boxes.max_x.data(), boxes.max_y.data(), boxes.max_z.data()};
    std::uint64_t *const bits[1] = {out.is_met.data()};
    Real *const reals[2] = {out.t_enter.data(), out.t_exit.data()};
    const SlabRay prepared(ray);
    return for_each_block(in, boxes.min_x.size(), bits, reals, [&](const Lanes(&box)[6]) HWY_ATTR {
        Slabs slabs;
        Mask is_valid = hn::Not(none());
        for (std::size_t k = 0; k < 3; ++k) {
            const Lanes low = box[k];
            const Lanes high = box[k + 3];
            is_valid = hn::And(is_valid, hn::And(is_finite(low), is_finite(high)));
            const int axis = static_cast<int>(k);
            const Lanes origin = all(ray.origin[axis]);
            slabs.missed = hn::Or(slabs.missed, hn::Gt(low, high));
            if (ray.direction[axis] == Real(0)) {
                slabs.missed =
                    hn::Or(slabs.missed, hn::Or(hn::Lt(origin, low), hn::Gt(origin, high)));
                continue;
            }
            const Lanes to_low = hn::Sub(low, origin);
            const Lanes to_high = hn::Sub(high, origin);
            if (prepared.has_inverse) {
                const Lanes inverse = all(prepared.inverse[axis]);
                slabs.cut(hn::Mul(to_low, inverse), hn::Mul(to_high, inverse));
            } else {
                const Lanes direction = all(ray.direction[axis]);
                slabs.cut(hn::Div(to_low, direction), hn::Div(to_high, direction));
            }
        }
        const Mask met = slabs.finish(all(ray.max_t));
        return interval(met, slabs.enter, slabs.exit, is_valid);
    });
}

HWY_ATTR bool rays_against_aabb(const Aabb &box, const RayBatch &rays, const IntervalBatch &out) {
    const Real *const in[7] = {rays.origin_x.data(),    rays.origin_y.data(),
                               rays.origin_z.data(),    rays.direction_x.data(),
                               rays.direction_y.data(), rays.direction_z.data(),
                               rays.max_t.data()};
    std::uint64_t *const bits[1] = {out.is_met.data()};
    Real *const reals[2] = {out.t_enter.data(), out.t_exit.data()};
    const bool is_empty = box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
    return for_each_block(in, rays.max_t.size(), bits, reals, [&](const Lanes(&ray)[7]) HWY_ATTR {
        const Lanes zero = hn::Zero(tag);
        const Lanes max_t = ray[6];
        Slabs slabs;
        Mask is_valid = is_number(max_t);
        Mask has_direction = none();
        for (std::size_t k = 0; k < 3; ++k) {
            const Lanes origin = ray[k];
            const Lanes direction = ray[k + 3];
            is_valid = hn::And(is_valid, hn::And(is_finite(origin), is_finite(direction)));
            const int axis = static_cast<int>(k);
            const Lanes low = all(box.min[axis]);
            const Lanes high = all(box.max[axis]);
            const Mask is_zero = hn::Eq(direction, zero);
            has_direction = hn::Or(has_direction, hn::Not(is_zero));
            const Mask outside = hn::Or(hn::Lt(origin, low), hn::Gt(origin, high));
            slabs.missed = hn::Or(slabs.missed, hn::And(is_zero, outside));
            // A direction of 0 clips nothing.
            const Lanes divisor = hn::IfThenElse(is_zero, all(Real(1)), direction);
            Slabs cut = slabs;
            cut.cut(hn::Div(hn::Sub(low, origin), divisor),
                    hn::Div(hn::Sub(high, origin), divisor));
            slabs.enter = hn::IfThenElse(is_zero, slabs.enter, cut.enter);
            slabs.exit = hn::IfThenElse(is_zero, slabs.exit, cut.exit);
        }
        Mask met = slabs.finish(max_t);
        if (is_empty)
            met = none();
        return interval(met, slabs.enter, slabs.exit, hn::And(is_valid, has_direction));
    });
}

// Error bound for the origin's depth in a sphere (raycast.cpp); `reach` is the radius squared.
HWY_INLINE Lanes depth_doubt(Lanes reach, Lanes away) {
    return hn::Add(hn::Mul(all(Real(4) * epsilon), hn::Add(reach, away)),
                   all(std::numeric_limits<Real>::min()));
}

// The fast path of ray_interval for a sphere (raycast.cpp).
HWY_ATTR bool ray_against_spheres(const SphereBatch &spheres, const Ray &ray,
                                  const IntervalBatch &out, std::uint64_t *unsure) {
    const Real *const in[4] = {spheres.x.data(), spheres.y.data(), spheres.z.data(),
                               spheres.radius.data()};
    std::uint64_t *const bits[2] = {out.is_met.data(), unsure};
    Real *const reals[2] = {out.t_enter.data(), out.t_exit.data()};
    // Scale the direction by the power of two in its largest component.
    const Real largest_component =
        std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    const Real power = std::max(std::scalbn(Real(1), std::ilogb(largest_component)),
                                std::numeric_limits<Real>::min());
    const Vec3 direction = ray.direction * (Real(1) / power);
    const Real direction_squared = glm::dot(direction, direction);
    return for_each_block(in, spheres.x.size(), bits, reals, [&](const Lanes(&sphere)[4]) HWY_ATTR {
        const Lanes zero = hn::Zero(tag);
        const Lanes scale = all(power);
        const Lanes squared = all(direction_squared);
        const Lanes max_t = all(ray.max_t);
        const Lanes radius = sphere[3];
        const Vector d = all(direction);
        const Vector center{sphere[0], sphere[1], sphere[2]};
        const Mask is_valid =
            hn::And(is_finite(center), hn::And(is_finite(radius), hn::Ge(radius, zero)));

        const Vector m = minus(center, all(ray.origin));
        const Vector moment = cross(m, d);
        const Lanes reach = hn::Mul(radius, radius);
        const Lanes away = dot(m, m);
        const Lanes rest = hn::Sub(hn::Mul(reach, squared), dot(moment, moment));
        const Lanes one_norm = hn::Add(hn::Add(hn::Abs(m.x), hn::Abs(m.y)), hn::Abs(m.z));
        const Lanes e = hn::Mul(all(Real(4) * epsilon), hn::Add(one_norm, radius));
        const Lanes doubt =
            hn::Add(hn::Mul(squared, hn::Mul(e, hn::Add(hn::Mul(all(Real(2)), radius), e))),
                    all(std::numeric_limits<Real>::min()));
        const Mask is_sure =
            hn::And(hn::Gt(hn::Abs(rest), doubt),
                    hn::Gt(hn::Abs(hn::Sub(reach, away)), depth_doubt(reach, away)));

        const Lanes half = hn::Sqrt(rest);
        const Lanes middle = dot(m, d);
        const Lanes enter = hn::Div(hn::Sub(middle, half), squared);
        const Lanes exit = hn::Div(hn::Add(middle, half), squared);

        // From inside.
        const Mask starts_inside = hn::Lt(away, reach);
        const Lanes exit_inside = hn::Div(exit, scale);
        const Lanes clamped =
            hn::IfThenElse(hn::Lt(exit_inside, zero), zero,
                           hn::IfThenElse(hn::Lt(max_t, exit_inside), max_t, exit_inside));
        const Mask met_inside = hn::And(starts_inside, hn::Ge(max_t, zero));

        // From outside.
        const Lanes t_enter = max(hn::Div(enter, scale), zero);
        const Lanes t_exit = min(max(hn::Div(exit, scale), t_enter), max_t);
        Mask met_outside = hn::AndNot(starts_inside, hn::Ge(rest, zero));
        met_outside = hn::And(met_outside, hn::Ge(middle, zero));
        met_outside = hn::And(met_outside, hn::Le(t_enter, max_t));
        met_outside = hn::AndNot(hn::Eq(t_enter, all(infinity)), met_outside);

        const Mask met = hn::Or(met_inside, met_outside);
        const Lanes met_enter = hn::IfThenElse(starts_inside, zero, t_enter);
        const Lanes met_exit = hn::IfThenElse(starts_inside, clamped, t_exit);
        return Answers<2, 2>{
            {met, hn::Not(is_sure)},
            {hn::IfThenElseZero(met, met_enter), hn::IfThenElseZero(met, met_exit)},
            is_valid};
    });
}

// For finite boxes, empty ones included.
HWY_INLINE Mask boxes_overlap(const Lanes *a_min, const Lanes *a_max, const Lanes *b_min,
                              const Lanes *b_max, Mask &is_valid) {
    Mask overlap = hn::Not(none());
    for (std::size_t k = 0; k < 3; ++k) {
        is_valid = hn::And(is_valid, hn::And(is_finite(b_min[k]), is_finite(b_max[k])));
        overlap = hn::And(overlap, hn::And(hn::Le(a_min[k], b_max[k]), hn::Le(b_min[k], a_max[k])));
        // An empty box overlaps nothing.
        overlap = hn::And(overlap, hn::And(hn::Le(a_min[k], a_max[k]), hn::Le(b_min[k], b_max[k])));
    }
    return overlap;
}

HWY_ATTR bool aabb_pairs(const AabbBatch &a, const AabbBatch &b, std::uint64_t *answers) {
    const Real *const in[12] = {a.min_x.data(), a.min_y.data(), a.min_z.data(), a.max_x.data(),
                                a.max_y.data(), a.max_z.data(), b.min_x.data(), b.min_y.data(),
                                b.min_z.data(), b.max_x.data(), b.max_y.data(), b.max_z.data()};
    return for_each_block(in, a.min_x.size(), answers,
                          [&](const Lanes(&box)[12], Mask &answer, Mask &is_valid) HWY_ATTR {
                              is_valid = hn::Not(none());
                              for (std::size_t k = 0; k < 6; ++k)
                                  is_valid = hn::And(is_valid, is_finite(box[k]));
                              answer = boxes_overlap(box, box + 3, box + 6, box + 9, is_valid);
                          });
}

HWY_ATTR bool aabb_against_aabbs(const Aabb &one, const AabbBatch &boxes, std::uint64_t *answers) {
    const Real *const in[6] = {boxes.min_x.data(), boxes.min_y.data(), boxes.min_z.data(),
                               boxes.max_x.data(), boxes.max_y.data(), boxes.max_z.data()};
    return for_each_block(
        in, boxes.min_x.size(), answers,
        [&](const Lanes(&box)[6], Mask &answer, Mask &is_valid) HWY_ATTR {
            const Lanes low[3] = {all(one.min.x), all(one.min.y), all(one.min.z)};
            const Lanes high[3] = {all(one.max.x), all(one.max.y), all(one.max.z)};
            is_valid = hn::Not(none());
            answer = boxes_overlap(low, high, box, box + 3, is_valid);
        });
}

HWY_ATTR bool sphere_against_spheres(const Sphere &one, const SphereBatch &spheres,
                                     std::uint64_t *answers) {
    const Real *const in[4] = {spheres.x.data(), spheres.y.data(), spheres.z.data(),
                               spheres.radius.data()};
    return for_each_block(in, spheres.x.size(), answers,
                          [&](const Lanes(&sphere)[4], Mask &answer, Mask &is_valid) HWY_ATTR {
                              const Vector center{sphere[0], sphere[1], sphere[2]};
                              const Lanes radius = sphere[3];
                              is_valid = hn::And(
                                  is_finite(center),
                                  hn::And(is_finite(radius), hn::Ge(radius, hn::Zero(tag))));
                              const Vector apart = minus(center, all(one.center));
                              const Lanes reach = hn::Add(all(one.radius), radius);
                              answer = hn::Le(dot(apart, apart), hn::Mul(reach, reach));
                          });
}

HWY_ATTR bool points_in_sphere(const Sphere &sphere, const PointBatch &points,
                               std::uint64_t *answers, std::uint64_t *unsure) {
    const Real *const in[3] = {points.x.data(), points.y.data(), points.z.data()};
    std::uint64_t *const bits[2] = {answers, unsure};
    Real *const no_reals[1] = {nullptr};
    return for_each_block(in, points.x.size(), bits, no_reals, [&](const Lanes(&p)[3]) HWY_ATTR {
        const Vector point{p[0], p[1], p[2]};
        const Vector d = minus(point, all(sphere.center));
        const Lanes away = dot(d, d);
        const Lanes reach = all(sphere.radius * sphere.radius);
        const Mask is_sure = hn::Gt(hn::Abs(hn::Sub(reach, away)), depth_doubt(reach, away));
        return Answers<2, 1>{
            {hn::Lt(away, reach), hn::Not(is_sure)}, {hn::Zero(tag)}, is_finite(point)};
    });
}

HWY_ATTR bool points_in_aabb(const Aabb &box, const PointBatch &points, std::uint64_t *answers) {
    const Real *const in[3] = {points.x.data(), points.y.data(), points.z.data()};
    return for_each_block(in, points.x.size(), answers,
                          [&](const Lanes(&p)[3], Mask &answer, Mask &is_valid) HWY_ATTR {
                              is_valid = hn::Not(none());
                              answer = hn::Not(none());
                              for (std::size_t k = 0; k < 3; ++k) {
                                  const int axis = static_cast<int>(k);
                                  is_valid = hn::And(is_valid, is_finite(p[k]));
                                  answer = hn::And(answer, hn::Ge(p[k], all(box.min[axis])));
                                  answer = hn::And(answer, hn::Le(p[k], all(box.max[axis])));
                              }
                          });
}

// A box with rotation: `rotated` of engine/math/types.h by the conjugate.
HWY_ATTR bool points_in_box(const Box &box, const PointBatch &points, std::uint64_t *answers) {
    const Real *const in[3] = {points.x.data(), points.y.data(), points.z.data()};
    const Quat inverse = glm::conjugate(box.rotation);
    const Real double_inverse_square = Real(2) / glm::dot(inverse, inverse);
    return for_each_block(
        in, points.x.size(), answers,
        [&](const Lanes(&p)[3], Mask &answer, Mask &is_valid) HWY_ATTR {
            const Vector point{p[0], p[1], p[2]};
            is_valid = is_finite(point);
            const Vector v = minus(point, all(box.center));
            const Vector axis = all(Vec3{inverse.x, inverse.y, inverse.z});
            const Vector turn = cross(axis, plus(cross(axis, v), times(all(inverse.w), v)));
            const Vector local = plus(v, times(all(double_inverse_square), turn));
            answer = hn::And(hn::And(hn::Le(hn::Abs(local.x), all(box.half_extents.x)),
                                     hn::Le(hn::Abs(local.y), all(box.half_extents.y))),
                             hn::Le(hn::Abs(local.z), all(box.half_extents.z)));
        });
}

// Tests a shape with its centre at `height` above a plane and extent `reach` along the plane's
// normal: in front of one plane it is outside, behind all planes inside. Closer than `doubt` to
// touching a plane, the scalar function must decide; its own roundings are at most 8 epsilon times
// the largest coordinate or size (frustum.h), ours are less.
struct FrustumSides {
    Mask outside, inside, unsure;

    HWY_INLINE FrustumSides() : outside(none()), inside(hn::Not(none())), unsure(none()) {}
    HWY_INLINE void test(Lanes height, Lanes reach, Lanes doubt) {
        const Lanes nearest = hn::Sub(height, reach);
        const Lanes farthest = hn::Add(height, reach);
        outside = hn::Or(outside, hn::Gt(nearest, doubt));
        inside = hn::And(inside, hn::Lt(farthest, hn::Zero(tag)));
        // Written so that NaN from an overflow is unsure.
        unsure = hn::Or(unsure, hn::Not(hn::Gt(hn::Abs(nearest), doubt)));
        unsure = hn::Or(unsure, hn::Not(hn::Gt(hn::Abs(farthest), doubt)));
    }
    HWY_INLINE Answers<3, 1> finish(Mask is_valid) const {
        return {{hn::Not(outside), hn::AndNot(outside, inside), hn::AndNot(outside, unsure)},
                {hn::Zero(tag)},
                is_valid};
    }
};

HWY_INLINE Lanes largest(const Vector &v) {
    return hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

constexpr Real doubt_factor = Real(64) * epsilon;

HWY_ATTR bool points_in_frustum(const Frustum &frustum, const PointBatch &points,
                                const Verdicts &out) {
    const Real *const in[3] = {points.x.data(), points.y.data(), points.z.data()};
    std::uint64_t *const bits[3] = {out.not_outside, out.inside, out.unsure};
    Real *const no_reals[1] = {nullptr};
    return for_each_block(in, points.x.size(), bits, no_reals, [&](const Lanes(&p)[3]) HWY_ATTR {
        const Vector point{p[0], p[1], p[2]};
        const Lanes size = largest(point);
        FrustumSides sides;
        for (const Plane &plane : frustum.planes) {
            const Lanes offset = all(plane.offset);
            sides.test(hn::Sub(dot(all(plane.normal), point), offset), hn::Zero(tag),
                       hn::Mul(all(doubt_factor), hn::Max(size, hn::Abs(offset))));
        }
        return sides.finish(is_finite(point));
    });
}

HWY_ATTR bool spheres_in_frustum(const Frustum &frustum, const SphereBatch &spheres,
                                 const Verdicts &out) {
    const Real *const in[4] = {spheres.x.data(), spheres.y.data(), spheres.z.data(),
                               spheres.radius.data()};
    std::uint64_t *const bits[3] = {out.not_outside, out.inside, out.unsure};
    Real *const no_reals[1] = {nullptr};
    return for_each_block(
        in, spheres.x.size(), bits, no_reals, [&](const Lanes(&sphere)[4]) HWY_ATTR {
            const Vector center{sphere[0], sphere[1], sphere[2]};
            const Lanes radius = sphere[3];
            const Lanes size = hn::Max(largest(center), radius);
            FrustumSides sides;
            for (const Plane &plane : frustum.planes) {
                const Lanes offset = all(plane.offset);
                const Lanes height = hn::Sub(dot(all(plane.normal), center), offset);
                sides.test(height, radius,
                           hn::Mul(all(doubt_factor), hn::Max(size, hn::Abs(offset))));
            }
            return sides.finish(hn::And(is_finite(center),
                                        hn::And(is_finite(radius), hn::Ge(radius, hn::Zero(tag)))));
        });
}

HWY_ATTR bool aabbs_in_frustum(const Frustum &frustum, const AabbBatch &boxes,
                               const Verdicts &out) {
    const Real *const in[6] = {boxes.min_x.data(), boxes.min_y.data(), boxes.min_z.data(),
                               boxes.max_x.data(), boxes.max_y.data(), boxes.max_z.data()};
    std::uint64_t *const bits[3] = {out.not_outside, out.inside, out.unsure};
    Real *const no_reals[1] = {nullptr};
    return for_each_block(
        in, boxes.min_x.size(), bits, no_reals, [&](const Lanes(&box)[6]) HWY_ATTR {
            const Lanes half = all(Real(0.5));
            const Vector low{box[0], box[1], box[2]};
            const Vector high{box[3], box[4], box[5]};
            const Vector center = times(half, plus(low, high));
            const Vector extents = times(half, minus(high, low));
            const Lanes size = hn::Max(largest(low), largest(high));
            FrustumSides sides;
            for (const Plane &plane : frustum.planes) {
                const Lanes offset = all(plane.offset);
                const Lanes height = hn::Sub(dot(all(plane.normal), center), offset);
                const Lanes reach = dot(all(glm::abs(plane.normal)), extents);
                sides.test(height, reach,
                           hn::Mul(all(doubt_factor), hn::Max(size, hn::Abs(offset))));
            }
            // Leave empty boxes to the scalar function.
            const Mask is_empty =
                hn::Or(hn::Or(hn::Gt(low.x, high.x), hn::Gt(low.y, high.y)), hn::Gt(low.z, high.z));
            Answers<3, 1> answers = sides.finish(hn::And(is_finite(low), is_finite(high)));
            answers.bits[2] = hn::Or(answers.bits[2], is_empty);
            return answers;
        });
}

// The ray's line certainly misses a triangle if it passes one edge on the left and another on the
// right, by the signs of triple products. Each is off by less than 7 u (1 + 8 u) times its
// permanent, where u is half an epsilon (Shewchuk 1997, section 4.3, bound A of orient3d) and the
// permanent is at most six products of the largest components.
HWY_ATTR bool may_meet_triangles(const TriangleBatch &triangles, const Ray &ray,
                                 std::uint64_t *answers) {
    const Real *const in[9] = {triangles.ax.data(), triangles.ay.data(), triangles.az.data(),
                               triangles.bx.data(), triangles.by.data(), triangles.bz.data(),
                               triangles.cx.data(), triangles.cy.data(), triangles.cz.data()};
    const Real direction_size =
        std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    return for_each_block(in, triangles.ax.size(), answers,
                          [&](const Lanes(&corner)[9], Mask &answer, Mask &is_valid) HWY_ATTR {
                              const Vector origin = all(ray.origin);
                              const Vector direction = all(ray.direction);
                              const Vector corners[3] = {{corner[0], corner[1], corner[2]},
                                                         {corner[3], corner[4], corner[5]},
                                                         {corner[6], corner[7], corner[8]}};
                              Vector from[3];
                              Lanes size[3];
                              is_valid = hn::Not(none());
                              for (std::size_t k = 0; k < 3; ++k) {
                                  is_valid = hn::And(is_valid, is_finite(corners[k]));
                                  from[k] = minus(corners[k], origin);
                                  size[k] = largest(from[k]);
                              }
                              // 22 epsilon > 6 * 7 u; where products underflow the error is
                              // absolute.
                              const Lanes doubt = all(Real(22) * epsilon * direction_size);
                              const Lanes floor = all(std::numeric_limits<Real>::min());
                              Mask left = none();
                              Mask right = none();
                              for (std::size_t k = 0; k < 3; ++k) {
                                  const std::size_t next = (k + 1) % 3;
                                  const Lanes side = dot(direction, cross(from[k], from[next]));
                                  const Lanes bound =
                                      hn::Add(hn::Mul(hn::Mul(doubt, size[k]), size[next]), floor);
                                  left = hn::Or(left, hn::Gt(side, bound));
                                  right = hn::Or(right, hn::Gt(hn::Neg(side), bound));
                              }
                              answer = hn::Not(hn::And(left, right));
                          });
}

} // namespace
} // namespace kernels::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::inline PLUMB_PRECISION {
namespace kernels {

HWY_EXPORT(ray_against_aabbs);
HWY_EXPORT(rays_against_aabb);
HWY_EXPORT(ray_against_spheres);
HWY_EXPORT(aabb_pairs);
HWY_EXPORT(aabb_against_aabbs);
HWY_EXPORT(sphere_against_spheres);
HWY_EXPORT(points_in_sphere);
HWY_EXPORT(points_in_aabb);
HWY_EXPORT(points_in_box);
HWY_EXPORT(points_in_frustum);
HWY_EXPORT(spheres_in_frustum);
HWY_EXPORT(aabbs_in_frustum);
HWY_EXPORT(may_meet_triangles);

bool ray_interval(const AabbBatch &boxes, const Ray &ray, const IntervalBatch &out) {
    return HWY_DYNAMIC_DISPATCH(ray_against_aabbs)(boxes, ray, out);
}
bool ray_interval(const Aabb &box, const RayBatch &rays, const IntervalBatch &out) {
    return HWY_DYNAMIC_DISPATCH(rays_against_aabb)(box, rays, out);
}
bool ray_interval(const SphereBatch &spheres, const Ray &ray, const IntervalBatch &out,
                  std::uint64_t *unsure) {
    return HWY_DYNAMIC_DISPATCH(ray_against_spheres)(spheres, ray, out, unsure);
}
bool overlaps(const AabbBatch &a, const AabbBatch &b, std::uint64_t *answers) {
    return HWY_DYNAMIC_DISPATCH(aabb_pairs)(a, b, answers);
}
bool overlaps(const Aabb &box, const AabbBatch &boxes, std::uint64_t *answers) {
    return HWY_DYNAMIC_DISPATCH(aabb_against_aabbs)(box, boxes, answers);
}
bool overlaps(const Sphere &sphere, const SphereBatch &spheres, std::uint64_t *answers) {
    return HWY_DYNAMIC_DISPATCH(sphere_against_spheres)(sphere, spheres, answers);
}
bool contains(const Sphere &sphere, const PointBatch &points, std::uint64_t *answers,
              std::uint64_t *unsure) {
    return HWY_DYNAMIC_DISPATCH(points_in_sphere)(sphere, points, answers, unsure);
}
bool contains(const Aabb &box, const PointBatch &points, std::uint64_t *answers) {
    return HWY_DYNAMIC_DISPATCH(points_in_aabb)(box, points, answers);
}
bool contains(const Box &box, const PointBatch &points, std::uint64_t *answers) {
    // As in the scalar function: without rotation the faces are where the caller would compute
    // them.
    if (box.rotation.x == Real(0) && box.rotation.y == Real(0) && box.rotation.z == Real(0))
        return contains(Aabb{box.center - box.half_extents, box.center + box.half_extents}, points,
                        answers);
    return HWY_DYNAMIC_DISPATCH(points_in_box)(box, points, answers);
}
bool classify(const Frustum &frustum, const PointBatch &points, const Verdicts &out) {
    return HWY_DYNAMIC_DISPATCH(points_in_frustum)(frustum, points, out);
}
bool classify(const Frustum &frustum, const SphereBatch &spheres, const Verdicts &out) {
    return HWY_DYNAMIC_DISPATCH(spheres_in_frustum)(frustum, spheres, out);
}
bool classify(const Frustum &frustum, const AabbBatch &boxes, const Verdicts &out) {
    return HWY_DYNAMIC_DISPATCH(aabbs_in_frustum)(frustum, boxes, out);
}
bool may_meet(const TriangleBatch &triangles, const Ray &ray, std::uint64_t *answers) {
    return HWY_DYNAMIC_DISPATCH(may_meet_triangles)(triangles, ray, answers);
}

} // namespace kernels
} // namespace plumb::inline PLUMB_PRECISION
#endif
