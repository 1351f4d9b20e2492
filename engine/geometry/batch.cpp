#include "engine/geometry/batch.h"

#include "engine/core/check.h"
#include "engine/geometry/batch_kernels.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/overlap.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Column = std::span<const Real>;

std::size_t count_of(std::initializer_list<Column> columns) {
    const std::size_t count = columns.begin()->size();
    for (const Column &column : columns)
        PLUMB_CHECK(column.size() == count, "the columns of a batch must have the same length, got "
                                                << count << " and " << column.size());
    return count;
}

std::size_t count_of(const PointBatch &points) {
    return count_of({points.x, points.y, points.z});
}
std::size_t count_of(const SphereBatch &spheres) {
    return count_of({spheres.x, spheres.y, spheres.z, spheres.radius});
}
std::size_t count_of(const AabbBatch &boxes) {
    return count_of({boxes.min_x, boxes.min_y, boxes.min_z, boxes.max_x, boxes.max_y, boxes.max_z});
}
std::size_t count_of(const TriangleBatch &all) {
    return count_of({all.ax, all.ay, all.az, all.bx, all.by, all.bz, all.cx, all.cy, all.cz});
}
std::size_t count_of(const RayBatch &rays) {
    return count_of({rays.origin_x, rays.origin_y, rays.origin_z, rays.direction_x,
                     rays.direction_y, rays.direction_z, rays.max_t});
}

Vec3 at(const PointBatch &points, std::size_t i) {
    return {points.x[i], points.y[i], points.z[i]};
}
Sphere at(const SphereBatch &spheres, std::size_t i) {
    return {{spheres.x[i], spheres.y[i], spheres.z[i]}, spheres.radius[i]};
}
Aabb at(const AabbBatch &boxes, std::size_t i) {
    return {{boxes.min_x[i], boxes.min_y[i], boxes.min_z[i]},
            {boxes.max_x[i], boxes.max_y[i], boxes.max_z[i]}};
}
Triangle at(const TriangleBatch &all, std::size_t i) {
    return {{all.ax[i], all.ay[i], all.az[i]},
            {all.bx[i], all.by[i], all.bz[i]},
            {all.cx[i], all.cy[i], all.cz[i]}};
}
Ray at(const RayBatch &rays, std::size_t i) {
    return {{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
            {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
            rays.max_t[i]};
}

void check_room(std::size_t room, std::size_t count) {
    PLUMB_CHECK(room >= bit_words(count), "the answers to " << count << " queries need "
                                                            << bit_words(count) << " words, got "
                                                            << room);
}

void check_room(const IntervalBatch &intervals, std::size_t count) {
    check_room(intervals.is_met.size(), count);
    const std::size_t room = std::min(intervals.t_enter.size(), intervals.t_exit.size());
    PLUMB_CHECK(room >= count, count << " intervals need as many elements, got " << room);
}

// The kernels only report that some number is invalid. To find out which, run the scalar function
// over the elements until it refuses one.
template <typename Ask> void refuse(std::size_t count, Ask &&ask) {
    for (std::size_t i = 0; i < count; ++i)
        ask(i);
    PLUMB_CHECK(false, "a batch of " << count << " contains an invalid number");
}

// Calls fix(i) for every set bit.
template <typename Fix>
void each_bit(std::span<const std::uint64_t> bits, std::size_t first, Fix &&fix) {
    for (std::size_t word = 0; word < bits.size(); ++word)
        for (std::uint64_t left = bits[word]; left != 0; left &= left - 1)
            fix(first + word * 64 + static_cast<std::size_t>(std::countr_zero(left)));
}

void put_bit(std::span<std::uint64_t> bits, std::size_t i, bool is_set) {
    const std::uint64_t bit = std::uint64_t(1) << (i % 64);
    bits[i / 64] = is_set ? bits[i / 64] | bit : bits[i / 64] & ~bit;
}

// Batches that need temporary bits are processed in pieces, so the bits fit on the stack.
constexpr std::size_t piece_size = 4096;
using PieceBits = std::array<std::uint64_t, bit_words(piece_size)>;

PointBatch piece(const PointBatch &all, std::size_t first, std::size_t size) {
    return {all.x.subspan(first, size), all.y.subspan(first, size), all.z.subspan(first, size)};
}
SphereBatch piece(const SphereBatch &all, std::size_t first, std::size_t size) {
    return {all.x.subspan(first, size), all.y.subspan(first, size), all.z.subspan(first, size),
            all.radius.subspan(first, size)};
}
AabbBatch piece(const AabbBatch &all, std::size_t first, std::size_t size) {
    return {all.min_x.subspan(first, size), all.min_y.subspan(first, size),
            all.min_z.subspan(first, size), all.max_x.subspan(first, size),
            all.max_y.subspan(first, size), all.max_z.subspan(first, size)};
}

TriangleBatch piece(const TriangleBatch &all, std::size_t first, std::size_t size) {
    return {all.ax.subspan(first, size), all.ay.subspan(first, size), all.az.subspan(first, size),
            all.bx.subspan(first, size), all.by.subspan(first, size), all.bz.subspan(first, size),
            all.cx.subspan(first, size), all.cy.subspan(first, size), all.cz.subspan(first, size)};
}

void check_valid_planes(const Frustum &frustum) {
    for (const Plane &plane : frustum.planes)
        check_valid(plane);
}

// Falls back to the scalar function where the kernel is unsure.
template <typename Batch>
void classify_all(const Frustum &frustum, const Batch &batch, const FrustumBits &answers) {
    const std::size_t count = count_of(batch);
    check_room(std::min(answers.not_outside.size(), answers.inside.size()), count);
    check_valid_planes(frustum);
    PieceBits unsure;
    for (std::size_t first = 0; first < count; first += piece_size) {
        const std::size_t size = std::min(piece_size, count - first);
        const Batch here = piece(batch, first, size);
        if (!kernels::classify(frustum, here,
                               {answers.not_outside.data() + first / 64,
                                answers.inside.data() + first / 64, unsure.data()}))
            refuse(size, [&](std::size_t i) { (void)classify(frustum, at(here, i)); });
        each_bit(std::span(unsure).first(bit_words(size)), first, [&](std::size_t i) {
            const FrustumSide side = classify(frustum, at(batch, i));
            put_bit(answers.not_outside, i, side != FrustumSide::outside);
            put_bit(answers.inside, i, side == FrustumSide::inside);
        });
    }
}

} // namespace

void ray_interval(const AabbBatch &boxes, const Ray &ray, const IntervalBatch &intervals) {
    const std::size_t count = count_of(boxes);
    check_room(intervals, count);
    (void)ray_interval(Aabb{Vec3{Real(0)}, Vec3{Real(0)}}, ray); // refuses a ray that is not valid
    if (!kernels::ray_interval(boxes, ray, intervals))
        refuse(count, [&](std::size_t i) { (void)ray_interval(at(boxes, i), ray); });
}

void ray_interval(const Aabb &box, const RayBatch &rays, const IntervalBatch &intervals) {
    const std::size_t count = count_of(rays);
    check_room(intervals, count);
    (void)ray_interval(box, Ray{}); // refuses a box that is not valid
    if (!kernels::ray_interval(box, rays, intervals))
        refuse(count, [&](std::size_t i) { (void)ray_interval(box, at(rays, i)); });
}

void ray_interval(const SphereBatch &spheres, const Ray &ray, const IntervalBatch &intervals) {
    const std::size_t count = count_of(spheres);
    check_room(intervals, count);
    (void)ray_interval(Sphere{}, ray);
    PieceBits unsure;
    for (std::size_t first = 0; first < count; first += piece_size) {
        const std::size_t size = std::min(piece_size, count - first);
        const SphereBatch here = piece(spheres, first, size);
        const IntervalBatch out{intervals.is_met.subspan(first / 64, bit_words(size)),
                                intervals.t_enter.subspan(first, size),
                                intervals.t_exit.subspan(first, size)};
        if (!kernels::ray_interval(here, ray, out, unsure.data()))
            refuse(size, [&](std::size_t i) { (void)ray_interval(at(here, i), ray); });
        each_bit(std::span(unsure).first(bit_words(size)), 0, [&](std::size_t i) {
            const std::optional<RayInterval> interval = ray_interval(at(here, i), ray);
            put_bit(out.is_met, i, interval.has_value());
            out.t_enter[i] = interval ? interval->t_enter : Real(0);
            out.t_exit[i] = interval ? interval->t_exit : Real(0);
        });
    }
}

std::optional<BatchHit> raycast(const TriangleBatch &triangles, const Ray &ray) {
    const std::size_t count = count_of(triangles);
    (void)raycast(Triangle{}, ray); // refuses a ray that is not valid
    std::optional<BatchHit> best;
    Ray left = ray;
    PieceBits may_meet;
    for (std::size_t first = 0; first < count; first += piece_size) {
        const std::size_t size = std::min(piece_size, count - first);
        const TriangleBatch here = piece(triangles, first, size);
        if (!kernels::may_meet(here, ray, may_meet.data()))
            refuse(size, [&](std::size_t i) { (void)raycast(at(here, i), ray); });
        each_bit(std::span(may_meet).first(bit_words(size)), first, [&](std::size_t i) {
            const std::optional<RayHit> hit = raycast(at(triangles, i), left);
            if (hit && (!best || hit->t < best->hit.t)) {
                best = BatchHit{i, *hit};
                left.max_t = hit->t;
            }
        });
    }
    return best;
}

void overlaps(const AabbBatch &a, const AabbBatch &b, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(a);
    PLUMB_CHECK(count_of(b) == count, "pairs need two batches of the same length, got "
                                          << count << " and " << count_of(b));
    check_room(answers.size(), count);
    if (!kernels::overlaps(a, b, answers.data()))
        refuse(count, [&](std::size_t i) { (void)overlaps(at(a, i), at(b, i)); });
}

void overlaps(const Aabb &box, const AabbBatch &boxes, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(boxes);
    check_room(answers.size(), count);
    check_valid(box);
    if (!kernels::overlaps(box, boxes, answers.data()))
        refuse(count, [&](std::size_t i) { (void)overlaps(box, at(boxes, i)); });
}

void overlaps(const Sphere &sphere, const SphereBatch &spheres, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(spheres);
    check_room(answers.size(), count);
    check_valid(sphere);
    if (!kernels::overlaps(sphere, spheres, answers.data()))
        refuse(count, [&](std::size_t i) { (void)overlaps(sphere, at(spheres, i)); });
}

void contains(const Sphere &sphere, const PointBatch &points, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(points);
    check_room(answers.size(), count);
    check_valid(sphere);
    PieceBits unsure;
    for (std::size_t first = 0; first < count; first += piece_size) {
        const std::size_t size = std::min(piece_size, count - first);
        const PointBatch here = piece(points, first, size);
        if (!kernels::contains(sphere, here, answers.data() + first / 64, unsure.data()))
            refuse(size, [&](std::size_t i) { (void)contains(sphere, at(here, i)); });
        each_bit(std::span(unsure).first(bit_words(size)), first,
                 [&](std::size_t i) { put_bit(answers, i, contains(sphere, at(points, i))); });
    }
}

void contains(const Aabb &box, const PointBatch &points, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(points);
    check_room(answers.size(), count);
    check_valid(box);
    if (!kernels::contains(box, points, answers.data()))
        refuse(count, [&](std::size_t i) { (void)contains(box, at(points, i)); });
}

void contains(const Box &box, const PointBatch &points, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(points);
    check_room(answers.size(), count);
    check_valid(box);
    if (!kernels::contains(box, points, answers.data()))
        refuse(count, [&](std::size_t i) { (void)contains(box, at(points, i)); });
}

void contains(const Frustum &frustum, const PointBatch &points, std::span<std::uint64_t> answers) {
    const std::size_t count = count_of(points);
    check_room(answers.size(), count);
    check_valid_planes(frustum);
    PieceBits not_outside;
    PieceBits unsure;
    for (std::size_t first = 0; first < count; first += piece_size) {
        const std::size_t size = std::min(piece_size, count - first);
        const PointBatch here = piece(points, first, size);
        if (!kernels::classify(frustum, here,
                               {not_outside.data(), answers.data() + first / 64, unsure.data()}))
            refuse(size, [&](std::size_t i) { (void)contains(frustum, at(here, i)); });
        each_bit(std::span(unsure).first(bit_words(size)), first,
                 [&](std::size_t i) { put_bit(answers, i, contains(frustum, at(points, i))); });
    }
}

void classify(const Frustum &frustum, const SphereBatch &spheres, const FrustumBits &answers) {
    classify_all(frustum, spheres, answers);
}

void classify(const Frustum &frustum, const AabbBatch &boxes, const FrustumBits &answers) {
    classify_all(frustum, boxes, answers);
}

} // namespace plumb::inline PLUMB_PRECISION
