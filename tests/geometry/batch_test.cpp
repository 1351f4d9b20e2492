#include "engine/geometry/batch.h"

#include "engine/core/check.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/overlap.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <string>
#include <type_traits>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <hwy/highway.h>
#include <hwy/targets.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr Real nan_value = std::numeric_limits<Real>::quiet_NaN();
constexpr Real infinity = std::numeric_limits<Real>::infinity();

// --- Columns of exactly the length needed, so that a sanitizer sees reads past the end.

struct Columns {
    std::vector<std::vector<Real>> columns;

    explicit Columns(std::size_t count, std::size_t length)
        : columns(count, std::vector<Real>(length)) {}
    std::span<const Real> operator[](std::size_t k) const { return columns[k]; }
    void put(std::size_t i, std::initializer_list<Real> values) {
        std::size_t k = 0;
        for (const Real value : values)
            columns[k++][i] = value;
    }
};

Columns columns_of(const std::vector<Vec3> &points) {
    Columns c(3, points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        c.put(i, {points[i].x, points[i].y, points[i].z});
    return c;
}
Columns columns_of(const std::vector<Sphere> &spheres) {
    Columns c(4, spheres.size());
    for (std::size_t i = 0; i < spheres.size(); ++i)
        c.put(i,
              {spheres[i].center.x, spheres[i].center.y, spheres[i].center.z, spheres[i].radius});
    return c;
}
Columns columns_of(const std::vector<Aabb> &boxes) {
    Columns c(6, boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        c.put(i, {boxes[i].min.x, boxes[i].min.y, boxes[i].min.z, boxes[i].max.x, boxes[i].max.y,
                  boxes[i].max.z});
    return c;
}
Columns columns_of(const std::vector<Ray> &rays) {
    Columns c(7, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        c.put(i, {rays[i].origin.x, rays[i].origin.y, rays[i].origin.z, rays[i].direction.x,
                  rays[i].direction.y, rays[i].direction.z, rays[i].max_t});
    return c;
}
Columns columns_of(const std::vector<Triangle> &triangles) {
    Columns c(9, triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto &[p, q, r] = triangles[i];
        c.put(i, {p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z});
    }
    return c;
}

PointBatch points_of(const Columns &c) {
    return {c[0], c[1], c[2]};
}
SphereBatch spheres_of(const Columns &c) {
    return {c[0], c[1], c[2], c[3]};
}
AabbBatch boxes_of(const Columns &c) {
    return {c[0], c[1], c[2], c[3], c[4], c[5]};
}
RayBatch rays_of(const Columns &c) {
    return {c[0], c[1], c[2], c[3], c[4], c[5], c[6]};
}
TriangleBatch triangles_of(const Columns &c) {
    return {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8]};
}

// --- Room for answers, followed by a guard word that must not change.

constexpr std::uint64_t untouched = 0xDEADBEEFDEADBEEFULL;

struct BitRoom {
    std::vector<std::uint64_t> words;
    std::size_t count;

    explicit BitRoom(std::size_t n) : words(bit_words(n) + 1, untouched), count(n) {}
    std::span<std::uint64_t> span() { return std::span(words).first(bit_words(count)); }
    bool at(std::size_t i) const { return bit_at(words, i); }
    // The unused bits of the last word are zero, and nothing is written past it.
    void expect_tidy() const {
        EXPECT_EQ(words.back(), untouched);
        if (count % 64 != 0) {
            EXPECT_EQ(words[count / 64] >> (count % 64), 0U);
        }
    }
};

struct IntervalRoom {
    BitRoom is_met;
    std::vector<Real> enter, exit;

    explicit IntervalRoom(std::size_t n)
        : is_met(n), enter(n + 1, Real(-77)), exit(n + 1, Real(-77)) {}
    IntervalBatch batch() {
        const std::size_t n = is_met.count;
        return {is_met.span(), std::span(enter).first(n), std::span(exit).first(n)};
    }
};

template <typename T> auto bits_of(T x) {
    if constexpr (sizeof(T) == 4)
        return std::bit_cast<std::uint32_t>(x);
    else
        return std::bit_cast<std::uint64_t>(x);
}

template <typename Scalar> void expect_intervals(const IntervalRoom &room, Scalar &&scalar) {
    room.is_met.expect_tidy();
    EXPECT_EQ(room.enter.back(), Real(-77));
    EXPECT_EQ(room.exit.back(), Real(-77));
    for (std::size_t i = 0; i < room.is_met.count; ++i) {
        const std::optional<RayInterval> expected = scalar(i);
        const RayInterval interval = expected.value_or(RayInterval{});
        ASSERT_EQ(room.is_met.at(i), expected.has_value()) << i;
        ASSERT_EQ(bits_of(room.enter[i]), bits_of(interval.t_enter)) << i;
        ASSERT_EQ(bits_of(room.exit[i]), bits_of(interval.t_exit)) << i;
        ASSERT_FALSE(std::isnan(room.enter[i]) || std::isnan(room.exit[i]));
    }
}

template <typename Scalar> void expect_bits(const BitRoom &room, Scalar &&scalar) {
    room.expect_tidy();
    for (std::size_t i = 0; i < room.count; ++i)
        ASSERT_EQ(room.at(i), scalar(i)) << i;
}

// --- Inputs: small integers, where exact touching is common; sizes of all magnitudes; zeros of
// both signs.

struct Source {
    Random random;
    bool is_integer = false;
    double size = 1.0;

    explicit Source(std::uint64_t seed) : random(seed) {}
    void choose() {
        is_integer = random.next_index(3) == 0;
        size = random.next_index(2) == 0 ? 1.0 : std::pow(10.0, random.next_in(-3.0, 5.0));
    }
    Real coordinate(double reach) {
        const std::uint32_t kind = random.next_index(24);
        if (kind == 0)
            return Real(0);
        if (kind == 1)
            return -Real(0);
        if (is_integer)
            return Real(int(random.next_index(17)) - 8);
        return any_real(random, -reach * size, reach * size);
    }
    Vec3 point(double reach = 4.0) {
        const Real x = coordinate(reach), y = coordinate(reach), z = coordinate(reach);
        return {x, y, z};
    }
    Real length(double reach = 2.0) { return std::abs(coordinate(reach)); }
    Sphere sphere() {
        const Vec3 center = point();
        return {center, length()};
    }
    Aabb aabb() {
        Vec3 a = point(), b = point();
        if (random.next_index(16) != 0) { // otherwise empty, perhaps
            const Vec3 low = glm::min(a, b);
            b = glm::max(a, b);
            a = low;
        }
        if (random.next_index(16) == 0)
            b[int(random.next_index(3))] = a[0]; // flat, or empty
        if (random.next_index(64) == 0)
            return {};
        return {a, b};
    }
    Ray ray() {
        Ray ray{point(6.0), point(1.0)};
        if (random.next_index(4) == 0)
            ray.direction[int(random.next_index(3))] =
                random.next_index(2) == 0 ? Real(0) : -Real(0);
        if (random.next_index(8) == 0)
            ray.direction *= Real(std::pow(10.0, random.next_in(-6.0, 6.0)));
        if (ray.direction == Vec3{Real(0)})
            ray.direction = {Real(0), Real(1), -Real(0)};
        const std::uint32_t kind = random.next_index(8);
        if (kind < 3)
            ray.max_t = any_real(random, 0.0, 5.0);
        else if (kind == 3)
            ray.max_t = Real(0);
        else if (kind == 4 && random.next_index(4) == 0)
            ray.max_t = Real(-1);
        return ray;
    }
    Triangle triangle() {
        Triangle t{point(), point(), point()};
        const std::uint32_t kind = random.next_index(16);
        if (kind == 0)
            t.c = t.b;
        if (kind == 1)
            t.c = t.a + Real(0.5) * (t.b - t.a);
        if (kind == 2)
            t = {t.a, t.a, t.a};
        return t;
    }
    Frustum frustum() {
        const Vec3 eye = point() + Vec3{Real(0), Real(0.5), Real(9) * Real(size)};
        const Mat4 view = glm::lookAt(eye, Vec3{Real(0)}, Vec3{Real(0), Real(1), Real(0)});
        const Real s = Real(size);
        return frustum_of((random.next_index(2) == 0
                               ? glm::perspective(Real(0.8), Real(1.5), Real(0.5) * s, Real(20) * s)
                               : glm::ortho(Real(-4) * s, Real(4) * s, Real(-3) * s, Real(3) * s,
                                            Real(0.5) * s, Real(20) * s)) *
                          view);
    }
    template <typename Make> auto many(std::size_t count, Make &&make) {
        std::vector<decltype(make())> all;
        all.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            all.push_back(make());
        return all;
    }
};

// Makes every batch use one instruction set; 0 selects the best again.
void use_target(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Runs body(source, count) with every instruction set this machine has, for every length up to more
// than two of the longest vectors: a million elements in all.
template <typename Body> void for_every_width(std::uint64_t seed, Body &&body) {
    const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_FALSE(targets.empty());
    std::vector<std::size_t> used;
    std::vector<std::size_t> counts;
    for (std::size_t count = 0; count <= 40; ++count)
        counts.push_back(count);
    for (const std::size_t count : {63U, 64U, 65U, 127U, 128U, 129U, 4095U, 4096U, 4097U, 9000U})
        counts.push_back(count);
    const int elements = trials(1'000'000) / int(targets.size());
    for (const std::int64_t target : targets) {
        SCOPED_TRACE(hwy::TargetName(target));
        use_target(target);
        used.push_back(hwy::GetChosenTarget().GetIndex());
        Source source(seed);
        for (int done = 0; done < elements;) {
            for (const std::size_t count : counts) {
                source.choose();
                body(source, count);
                done += int(count);
                if (testing::Test::HasFatalFailure()) {
                    use_target(0);
                    FAIL() << "of " << count;
                }
                if (done >= elements && count > 128)
                    break;
            }
        }
    }
    use_target(0);
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::unique(used.begin(), used.end()), used.end()) << "a target was used twice";
}

TEST(Batch, RayAgainstAabbs) {
    std::size_t met = 0;
    for_every_width(1, [&](Source &source, std::size_t count) {
        const auto boxes = source.many(count, [&] { return source.aabb(); });
        const Ray ray = source.ray();
        const Columns columns = columns_of(boxes);
        IntervalRoom room(count);
        ray_interval(boxes_of(columns), ray, room.batch());
        const PreparedRay prepared(ray);
        expect_intervals(room, [&](std::size_t i) { return ray_interval(boxes[i], prepared); });
        for (std::size_t i = 0; i < count; ++i)
            met += room.is_met.at(i) ? 1 : 0;
    });
    EXPECT_GT(met, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, RaysAgainstAabb) {
    std::size_t met = 0;
    for_every_width(2, [&](Source &source, std::size_t count) {
        const auto rays = source.many(count, [&] { return source.ray(); });
        const Aabb box = source.aabb();
        const Columns columns = columns_of(rays);
        IntervalRoom room(count);
        ray_interval(box, rays_of(columns), room.batch());
        expect_intervals(room, [&](std::size_t i) { return ray_interval(box, rays[i]); });
        for (std::size_t i = 0; i < count; ++i)
            met += room.is_met.at(i) ? 1 : 0;
    });
    EXPECT_GT(met, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, RayAgainstSpheres) {
    std::size_t met = 0;
    for_every_width(3, [&](Source &source, std::size_t count) {
        const auto spheres = source.many(count, [&] { return source.sphere(); });
        const Ray ray = source.ray();
        const Columns columns = columns_of(spheres);
        IntervalRoom room(count);
        ray_interval(spheres_of(columns), ray, room.batch());
        expect_intervals(room, [&](std::size_t i) { return ray_interval(spheres[i], ray); });
        for (std::size_t i = 0; i < count; ++i)
            met += room.is_met.at(i) ? 1 : 0;
    });
    EXPECT_GT(met, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, RayAgainstTriangles) {
    std::size_t met = 0, asked = 0;
    for_every_width(4, [&](Source &source, std::size_t count) {
        const auto triangles = source.many(count, [&] { return source.triangle(); });
        Ray ray = source.ray();
        if (count > 0 && source.random.next_index(2) == 0) { // through a corner or an edge
            const Triangle &t = triangles[source.random.next_index(std::uint32_t(count))];
            const Vec3 on = source.random.next_index(2) == 0 ? t.a : Real(0.5) * (t.a + t.b);
            if (on != ray.origin)
                ray.direction = on - ray.origin;
        }
        const Columns columns = columns_of(triangles);
        const auto found = raycast(triangles_of(columns), ray);
        std::optional<BatchHit> expected;
        for (std::size_t i = 0; i < count; ++i)
            if (const auto hit = raycast(triangles[i], ray))
                if (!expected || hit->t < expected->hit.t)
                    expected = BatchHit{i, *hit};
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (expected) {
            ASSERT_EQ(found->index, expected->index);
            ASSERT_EQ(bits_of(found->hit.t), bits_of(expected->hit.t));
            ASSERT_EQ(found->hit.point, expected->hit.point);
            ASSERT_EQ(found->hit.normal, expected->hit.normal);
            ASSERT_EQ(found->hit.starts_inside, expected->hit.starts_inside);
            ++met;
        }
        ++asked;
    });
    EXPECT_GT(met, asked / 5);
}

TEST(Batch, AabbsOverlap) {
    std::size_t touching = 0;
    for_every_width(5, [&](Source &source, std::size_t count) {
        const auto a = source.many(count, [&] { return source.aabb(); });
        const auto b = source.many(count, [&] { return source.aabb(); });
        const Aabb one = source.aabb();
        const Columns columns_a = columns_of(a), columns_b = columns_of(b);
        BitRoom pairs(count), with_one(count);
        overlaps(boxes_of(columns_a), boxes_of(columns_b), pairs.span());
        overlaps(one, boxes_of(columns_b), with_one.span());
        expect_bits(pairs, [&](std::size_t i) { return overlaps(a[i], b[i]); });
        expect_bits(with_one, [&](std::size_t i) { return overlaps(one, b[i]); });
        for (std::size_t i = 0; i < count; ++i)
            touching += pairs.at(i) ? 1 : 0;
    });
    EXPECT_GT(touching, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, SpheresOverlap) {
    std::size_t touching = 0;
    for_every_width(6, [&](Source &source, std::size_t count) {
        const auto spheres = source.many(count, [&] { return source.sphere(); });
        const Sphere one = source.sphere();
        const Columns columns = columns_of(spheres);
        BitRoom room(count);
        overlaps(one, spheres_of(columns), room.span());
        expect_bits(room, [&](std::size_t i) { return overlaps(one, spheres[i]); });
        for (std::size_t i = 0; i < count; ++i)
            touching += room.at(i) ? 1 : 0;
    });
    EXPECT_GT(touching, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, PointsInSolids) {
    std::size_t inside = 0;
    for_every_width(7, [&](Source &source, std::size_t count) {
        const Sphere sphere = source.sphere();
        const Aabb aabb = source.aabb();
        Box box{source.point(), awkward_rotation(source.random), Vec3{Real(0)}};
        box.half_extents = {source.length(4.0), source.length(4.0), source.length(4.0)};
        if (source.random.next_index(4) == 0)
            box.rotation = identity_rotation;
        const auto points = source.many(count, [&] {
            return source.random.next_index(4) != 0
                       ? source.point()
                       : Vec3{sphere.center.x + sphere.radius, sphere.center.y, sphere.center.z};
        });
        const Columns columns = columns_of(points);
        BitRoom in_sphere(count), in_aabb(count), in_box(count);
        contains(sphere, points_of(columns), in_sphere.span());
        contains(aabb, points_of(columns), in_aabb.span());
        contains(box, points_of(columns), in_box.span());
        expect_bits(in_sphere, [&](std::size_t i) { return contains(sphere, points[i]); });
        expect_bits(in_aabb, [&](std::size_t i) { return contains(aabb, points[i]); });
        expect_bits(in_box, [&](std::size_t i) { return contains(box, points[i]); });
        for (std::size_t i = 0; i < count; ++i)
            inside += in_box.at(i) ? 1 : 0;
    });
    EXPECT_GT(inside, std::size_t(trials(1'000'000)) / 200);
}

TEST(Batch, Frustum) {
    std::size_t inside = 0, outside = 0, across = 0;
    for_every_width(8, [&](Source &source, std::size_t count) {
        const Frustum frustum = source.frustum();
        const auto full_box = [&] {
            const Aabb box = source.aabb();
            return Aabb{glm::min(box.min, box.max), glm::max(box.min, box.max)};
        };
        // Many exactly on the planes: through corners of the frustum.
        const auto points = source.many(count, [&] {
            if (source.random.next_index(2) == 0)
                return source.point();
            const Vec3 &a = frustum.corners[source.random.next_index(8)];
            const Vec3 &b = frustum.corners[source.random.next_index(8)];
            return Real(0.5) * (a + b);
        });
        auto spheres = source.many(count, [&] { return source.sphere(); });
        for (std::size_t i = 0; i < count; i += 3) {
            spheres[i].center = points[i];
            spheres[i].radius = Real(0);
        }
        auto boxes = source.many(count, full_box);
        for (auto &box : boxes)
            if (!(std::abs(box.min.x) < Real(1e9) && std::abs(box.max.x) < Real(1e9)))
                box = {Vec3{Real(0)}, Vec3{Real(1)}};
        const Columns point_columns = columns_of(points), sphere_columns = columns_of(spheres),
                      box_columns = columns_of(boxes);
        BitRoom in(count), sphere_seen(count), sphere_in(count), box_seen(count), box_in(count);
        contains(frustum, points_of(point_columns), in.span());
        classify(frustum, spheres_of(sphere_columns), {sphere_seen.span(), sphere_in.span()});
        classify(frustum, boxes_of(box_columns), {box_seen.span(), box_in.span()});
        expect_bits(in, [&](std::size_t i) { return contains(frustum, points[i]); });
        const auto side = [&](const BitRoom &seen, const BitRoom &in_all, std::size_t i) {
            return in_all.at(i) ? FrustumSide::inside
                   : seen.at(i) ? FrustumSide::across
                                : FrustumSide::outside;
        };
        sphere_seen.expect_tidy();
        sphere_in.expect_tidy();
        box_seen.expect_tidy();
        box_in.expect_tidy();
        for (std::size_t i = 0; i < count; ++i) {
            const FrustumSide expected = classify(frustum, spheres[i]);
            ASSERT_EQ(side(sphere_seen, sphere_in, i), expected) << i;
            ASSERT_TRUE(sphere_seen.at(i) || !sphere_in.at(i));
            ASSERT_EQ(side(box_seen, box_in, i), classify(frustum, boxes[i])) << i;
            (expected == FrustumSide::inside    ? inside
             : expected == FrustumSide::outside ? outside
                                                : across)++;
        }
    });
    const std::size_t some = std::size_t(trials(1'000'000)) / 100;
    EXPECT_GT(inside, some);
    EXPECT_GT(outside, some);
    EXPECT_GT(across, some);
}

// --- Misuse.

template <typename Call> std::string failure(Call &&call) {
    try {
        call();
    } catch (const CheckFailure &error) {
        return error.what();
    }
    return {};
}

TEST(Batch, RefusesWhatIsNotValidWhereverItIs) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        use_target(target);
        for (const std::size_t count : {1U, 2U, 7U, 16U, 33U}) {
            for (std::size_t bad = 0; bad < count; ++bad) {
                for (const Real value : {nan_value, infinity, -infinity}) {
                    const char *said = std::isnan(value) ? "nan" : "inf";
                    const auto expect_refused = [&](auto make, std::size_t columns, auto ask) {
                        for (std::size_t k = 0; k < columns; ++k) {
                            Columns c = make();
                            c.columns[k][bad] = value;
                            const std::string text = failure([&] { ask(c); });
                            EXPECT_NE(text.find(said), std::string::npos)
                                << "column " << k << " said: " << text;
                        }
                    };
                    const auto unit_boxes = [&] {
                        return columns_of(
                            std::vector<Aabb>(count, Aabb{Vec3{Real(0)}, Vec3{Real(1)}}));
                    };
                    const auto unit_spheres = [&] {
                        return columns_of(std::vector<Sphere>(count, {Vec3{Real(0)}, Real(1)}));
                    };
                    const auto points = [&] {
                        return columns_of(std::vector<Vec3>(count, Vec3{Real(1)}));
                    };
                    IntervalRoom room(count);
                    BitRoom bits(count), others(count);
                    const Aabb box{Vec3{Real(0)}, Vec3{Real(1)}};
                    const Columns good_boxes = unit_boxes();
                    const Frustum frustum = Source(1).frustum();
                    expect_refused(unit_boxes, 6, [&](const Columns &c) {
                        ray_interval(boxes_of(c), Ray{}, room.batch());
                    });
                    expect_refused(unit_spheres, 4, [&](const Columns &c) {
                        ray_interval(spheres_of(c), Ray{}, room.batch());
                    });
                    const auto rays = [&] { return columns_of(std::vector<Ray>(count)); };
                    expect_refused(rays, std::isnan(value) ? 7 : 6, [&](const Columns &c) {
                        ray_interval(box, rays_of(c), room.batch());
                    });
                    expect_refused(unit_boxes, 6, [&](const Columns &c) {
                        overlaps(boxes_of(good_boxes), boxes_of(c), bits.span());
                    });
                    expect_refused(unit_boxes, 6, [&](const Columns &c) {
                        overlaps(boxes_of(c), boxes_of(good_boxes), bits.span());
                    });
                    expect_refused(unit_boxes, 6, [&](const Columns &c) {
                        overlaps(box, boxes_of(c), bits.span());
                    });
                    expect_refused(unit_spheres, 4, [&](const Columns &c) {
                        overlaps(Sphere{}, spheres_of(c), bits.span());
                    });
                    expect_refused(points, 3, [&](const Columns &c) {
                        contains(Sphere{}, points_of(c), bits.span());
                    });
                    expect_refused(points, 3, [&](const Columns &c) {
                        contains(box, points_of(c), bits.span());
                    });
                    expect_refused(points, 3, [&](const Columns &c) {
                        contains(Box{}, points_of(c), bits.span());
                    });
                    expect_refused(points, 3, [&](const Columns &c) {
                        contains(frustum, points_of(c), bits.span());
                    });
                    expect_refused(unit_spheres, 4, [&](const Columns &c) {
                        classify(frustum, spheres_of(c), {bits.span(), others.span()});
                    });
                    expect_refused(unit_boxes, 6, [&](const Columns &c) {
                        classify(frustum, boxes_of(c), {bits.span(), others.span()});
                    });
                    const auto triangles = [&] {
                        return columns_of(std::vector<Triangle>(count, Triangle{}));
                    };
                    expect_refused(triangles, 9, [&](const Columns &c) {
                        (void)raycast(triangles_of(c), Ray{});
                    });
                }
            }
        }
    }
    use_target(0);
}

TEST(Batch, MisuseNamesTheValue) {
    const auto says = [](const std::string &text, const char *part) {
        EXPECT_NE(text.find(part), std::string::npos) << "said: " << text;
    };
    const std::vector<Sphere> spheres(5, {Vec3{Real(0)}, Real(1)});
    Columns columns = columns_of(spheres);
    BitRoom bits(5);
    IntervalRoom room(5);
    columns.columns[3][4] = Real(-3);
    says(failure([&] { overlaps(Sphere{}, spheres_of(columns), bits.span()); }), "-3");
    says(failure([&] { ray_interval(spheres_of(columns), Ray{}, room.batch()); }), "-3");
    columns.columns[3].resize(4);
    says(failure([&] { overlaps(Sphere{}, spheres_of(columns), bits.span()); }), "5 and 4");
    columns = columns_of(spheres);
    says(failure([&] { overlaps(Sphere{}, spheres_of(columns), {}); }), "got 0");
    says(failure([&] {
             ray_interval(spheres_of(columns), Ray{},
                          {bits.span(), std::span(room.enter).first(3), room.exit});
         }),
         "5 intervals need as many elements, got 3");
    Ray ray;
    ray.direction = Vec3{Real(0)};
    says(failure([&] { ray_interval(spheres_of(columns), ray, room.batch()); }), "zero");
    says(failure([&] { (void)raycast(TriangleBatch{}, ray); }), "zero");
    says(failure([&] { overlaps(Sphere{Vec3{nan_value}, Real(1)}, SphereBatch{}, {}); }), "nan");
    Columns rays = columns_of(std::vector<Ray>(9));
    for (std::size_t k = 3; k < 6; ++k)
        rays.columns[k][8] = -Real(0);
    IntervalRoom nine(9);
    says(failure([&] {
             ray_interval(Aabb{Vec3{Real(0)}, Vec3{Real(1)}}, rays_of(rays), nine.batch());
         }),
         "zero");
    const Columns boxes = columns_of(std::vector<Aabb>(3, Aabb{Vec3{Real(2)}, Vec3{Real(1)}}));
    says(failure([&] {
             classify(Source(1).frustum(), boxes_of(boxes), {bits.span(), bits.span()});
         }),
         "empty");
    // Empty batches have empty answers.
    overlaps(Sphere{}, SphereBatch{}, {});
    EXPECT_FALSE(raycast(TriangleBatch{}, Ray{}).has_value());
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
