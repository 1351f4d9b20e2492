#include "engine/geometry/overlap.h"

#include "tests/geometry/wide.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

// The least distance from a segment's points to a convex set, less `radius`, given the set's
// closest-point function: the derivative of the squared distance along the segment increases, so
// bisection finds its root. Stops early with any value on the right side of the band
// [-bound, bound].
template <typename Closest>
W least_gap(const W3 &a, const W3 &b, W radius, W bound, const Closest &closest) {
    const W3 d = b - a;
    W low = 0, high = 1;
    for (int i = 0;; ++i) {
        const W s = (low + high) / 2;
        const W3 p = a + d * s;
        const W3 way = p - closest(p);
        const W squared = glm::dot(way, way), slope = 2 * glm::dot(way, d);
        const W gap = std::sqrt(squared) - radius;
        if (gap < -bound || i > std::numeric_limits<Real>::digits + 4)
            return gap;
        (slope > W(0) ? high : low) = s;
        // A convex function lies above its tangents.
        const W least = squared - std::abs(slope) * (high - low);
        if (least > (radius + bound) * (radius + bound))
            return gap;
    }
}

TEST(Overlap, SphereWithSphereAndBoxes) {
    Random random(1);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 middle = any_position(random);
        Box box{narrowed(middle), oracle::awkward_rotation(random), any_half_extents(random, size)};
        if (random.next_index(8) == 0)
            box.rotation *= Real(1) + static_cast<Real>(random.next_in(-7, 7) * double(epsilon));
        const Frame frame(box);
        // A sphere that roughly touches the box at a random point of it.
        Sphere sphere{{}, static_cast<Real>(size * any_power(random, -2, 1))};
        const W3 local = glm::clamp(any_offset(random, size), -frame.half, frame.half);
        const W3 u = awkward_unit(random);
        sphere.center =
            narrowed(frame.point(local) + u * (W(sphere.radius) + any_gap(random, size)));
        const W distance = frame.signed_distance(widened(sphere.center)) - W(sphere.radius);
        const W bound = 32 * epsilon * std::max(scale_of(box), scale_of(sphere));
        judge(overlaps(sphere, box), distance, bound);
        ASSERT_EQ(overlaps(box, sphere), overlaps(sphere, box));

        const Aabb aabb{box.center - box.half_extents, box.center + box.half_extents};
        judge(overlaps(sphere, aabb),
              Frame(aabb).signed_distance(widened(sphere.center)) - W(sphere.radius), bound);
        ASSERT_EQ(overlaps(aabb, sphere), overlaps(sphere, aabb));

        Sphere other{{}, static_cast<Real>(size)};
        other.center = narrowed(widened(sphere.center) +
                                u * (W(sphere.radius) + size + any_gap(random, size)));
        judge(overlaps(sphere, other),
              glm::length(widened(other.center) - widened(sphere.center)) - W(sphere.radius) -
                  W(other.radius),
              32 * epsilon * (W(sphere.radius) + W(other.radius)));
        if (HasFatalFailure())
            return;
    }
}

TEST(Overlap, CapsuleWithSphereAndCapsule) {
    Random random(2);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 middle = any_position(random);
        const W3 u = awkward_unit(random);
        Capsule a{narrowed(middle - u * size * W(random.next_in(0, 1))),
                  narrowed(middle + u * size * W(random.next_in(0, 1))),
                  static_cast<Real>(size * any_power(random, -3, 0))};
        // The other's axis passes at about the sum of the radii: parallel, nearly so, or not.
        W3 v = awkward_unit(random);
        const std::uint32_t kind = random.next_index(4);
        if (kind == 0)
            v = u;
        else if (kind == 1)
            v = glm::normalize(u + v * any_power(random, -9, -1));
        const W3 n = awkward_unit(random);
        const W3 across = random.next_index(2) == 0 ? glm::cross(u, v) : n - u * glm::dot(u, n);
        if (glm::length(across) == W(0))
            continue;
        const W other = size * any_power(random, -2, 1);
        Capsule b{{}, {}, static_cast<Real>(size * any_power(random, -3, 0))};
        const W3 near =
            middle + glm::normalize(across) * (W(a.radius) + W(b.radius) + any_gap(random, size));
        b.a = narrowed(near - v * other * W(random.next_in(-0.1, 1)));
        b.b = random.next_index(16) == 0 ? b.a
                                         : narrowed(near + v * other * W(random.next_in(-0.1, 1)));
        const W3 b1 = widened(b.a), b2 = widened(b.b);
        const W bound = 32 * epsilon * std::max(scale_of(a), scale_of(b));
        const W distance = least_gap(widened(a.a), widened(a.b), W(a.radius) + W(b.radius), bound,
                                     [&](const W3 &p) { return closest_on_segment(b1, b2, p); });
        judge(overlaps(a, b), distance, bound);
        if (std::abs(distance) > bound) {
            ASSERT_EQ(overlaps(b, a), overlaps(a, b));
        }
        const Sphere sphere{b.a, b.radius};
        const W to_sphere = glm::length(b1 - closest_on_segment(widened(a.a), widened(a.b), b1)) -
                            W(a.radius) - W(b.radius);
        if (std::abs(to_sphere) > bound) {
            ASSERT_EQ(overlaps(a, sphere), to_sphere <= W(0));
            ASSERT_EQ(overlaps(sphere, a), to_sphere <= W(0));
        }
        if (HasFatalFailure())
            return;
    }
}

TEST(Overlap, CapsuleWithBoxes) {
    Random random(3);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const Box box{narrowed(any_position(random)),
                      random.next_index(4) == 0 ? identity_rotation
                                                : oracle::awkward_rotation(random),
                      any_half_extents(random, size)};
        const Frame frame(box);
        // Past a point of a face, edge or corner, at about the radius.
        W3 local = any_offset(random, size), outward{W(0)};
        for (int i = 0; i < 3; ++i)
            if (std::abs(local[i]) > frame.half[i] || random.next_index(3) == 0) {
                local[i] = local[i] < W(0) ? -frame.half[i] : frame.half[i];
                outward[i] = (local[i] < W(0) ? W(-1) : W(1)) * W(random.next_in(0.01, 1));
            }
        if (outward == W3{W(0)})
            continue;
        outward = glm::normalize(outward);
        const std::uint32_t kind = random.next_index(4);
        W3 v = awkward_unit(random);
        if (kind != 0)
            v -= outward * glm::dot(outward, v); // passing by
        if (kind == 2)
            v = {0, 0, 1}; // along a face or an edge
        if (glm::length(v) < W(1e-6))
            continue;
        v = glm::normalize(v);
        const W length = size * any_power(random, -2, 1);
        Capsule capsule{{}, {}, static_cast<Real>(size * any_power(random, -3, 0))};
        const W3 near = local + outward * (W(capsule.radius) + any_gap(random, size));
        capsule.a = narrowed(frame.point(near - v * length * W(random.next_in(-0.1, 1))));
        capsule.b = narrowed(frame.point(near + v * length * W(random.next_in(-0.1, 1))));
        const W bound = 32 * epsilon * std::max(scale_of(box), scale_of(capsule));
        const W3 a = widened(capsule.a), b = widened(capsule.b);
        judge(overlaps(capsule, box),
              least_gap(a, b, W(capsule.radius), bound,
                        [&](const W3 &p) { return frame.closest(p); }),
              bound);
        if (box.rotation == identity_rotation) {
            const Aabb aabb{box.center - box.half_extents, box.center + box.half_extents};
            const Frame aligned(aabb);
            judge(overlaps(capsule, aabb),
                  least_gap(a, b, W(capsule.radius), bound,
                            [&](const W3 &p) { return aligned.closest(p); }),
                  bound);
            ASSERT_EQ(overlaps(aabb, capsule), overlaps(capsule, aabb));
        }
        ASSERT_EQ(overlaps(box, capsule), overlaps(capsule, box));
        if (HasFatalFailure())
            return;
    }
}

// --- Exact answers -----------------------------------------------------------------------------

// Whether the segment from a to b comes within r of the box, by the squared distance
//   f(t) = sum of max(low - x, x - high, 0)^2,  x = a + t (b - a),
// which is a parabola between the parameters n / m at which x meets a plane of the box: its minimum
// is at one of those or at a vertex between two of them.
bool comes_near(const Int3 &low, const Int3 &high, const Int3 &a, const Int3 &b, Int r) {
    const Int3 d = b - a;
    struct Fraction {
        Int n = 0, m = 1;
    };
    std::array<Fraction, 8> breaks{{{0, 1}, {1, 1}}};
    std::size_t count = 2;
    for (int i = 0; i < 3; ++i)
        for (const Int side : {low[i], high[i]}) {
            const Int n = d[i] < 0 ? a[i] - side : side - a[i], m = std::abs(d[i]);
            if (m != 0 && n > 0 && n < m)
                breaks[count++] = {n, m};
        }
    std::sort(breaks.begin(), breaks.begin() + std::ptrdiff_t(count),
              [](const Fraction &x, const Fraction &y) { return x.n * y.m < y.n * x.m; });
    for (std::size_t k = 0; k < count; ++k) {
        const auto [n, m] = breaks[k];
        Int sum = 0; // of squares, times m^2
        for (int i = 0; i < 3; ++i) {
            const Int x = a[i] * m + n * d[i];
            const Int gap = std::max({low[i] * m - x, x - high[i] * m, Int(0)});
            sum += gap * gap;
        }
        if (sum <= r * r * m * m)
            return true;
        if (k + 1 == count)
            break;
        // Between this break and the next: A t^2 + 2 B t + C, by which side x is on in the middle.
        const auto [n2, m2] = breaks[k + 1];
        const Int mid_n = n * m2 + n2 * m, mid_m = 2 * m * m2;
        Int A = 0, B = 0, C = 0;
        for (int i = 0; i < 3; ++i) {
            const Int x = a[i] * mid_m + mid_n * d[i];
            if (x >= low[i] * mid_m && x <= high[i] * mid_m)
                continue;
            const Int side = x < low[i] * mid_m ? low[i] : high[i];
            A += d[i] * d[i];
            B += d[i] * (a[i] - side);
            C += (a[i] - side) * (a[i] - side);
        }
        // The vertex -B / A, if it is between the breaks, has the value C - B^2 / A.
        if (A > 0 && -B * m > n * A && -B * m2 < n2 * A && A * C - B * B <= r * r * A)
            return true;
    }
    return false;
}

// Whether two segments come within r of each other: the minimum of a quadratic on the unit square,
// by the normal equations in integers.
bool come_near(const Int3 &a1, const Int3 &a2, const Int3 &b1, const Int3 &b2, Int r) {
    const auto point_near = [r](const Int3 &p, const Int3 &q1, const Int3 &q2) {
        return comes_near(p, p, q1, q2, r);
    };
    if (point_near(a1, b1, b2) || point_near(a2, b1, b2) || point_near(b1, a1, a2) ||
        point_near(b2, a1, a2))
        return true;
    const Int3 u = a2 - a1, v = b2 - b1, w = b1 - a1;
    const Int uu = product(u, u), uv = product(u, v), vv = product(v, v);
    const Int uw = product(u, w), vw = product(v, w), ww = product(w, w);
    const Int gram = uu * vv - uv * uv;
    const Int s = uw * vv - vw * uv, t = uw * uv - vw * uu; // over gram
    if (gram <= 0 || s < 0 || s > gram || t < 0 || t > gram)
        return false;
    // min |w + t v - s u|^2 times gram: the determinant of the Gram matrix of u, v, w.
    const Int all = uu * (vv * ww - vw * vw) - uv * (uv * ww - vw * uw) + uw * (uv * vw - vv * uw);
    return all <= r * r * gram;
}

TEST(Overlap, WholeNumbersAreExact) {
    Random random(4);
    int touching = 0;
    const Real h = Real(0.5);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Int reach = trial % 2 == 0 ? 8 : 3;
        const Int3 a = any_int3(random, reach), b = any_int3(random, reach);
        const Int3 c = any_int3(random, reach), d = any_int3(random, reach);
        const Int r = Int(random.next_index(4)), q = Int(random.next_index(3));
        const Capsule capsule{real(a), real(b), Real(r)};
        const bool near = come_near(a, b, c, d, r + q);
        ASSERT_EQ(overlaps(capsule, Capsule{real(c), real(d), Real(q)}), near) << trial;
        touching += near && r + q > 0 && !come_near(a, b, c, d, r + q - 1);
        ASSERT_EQ(overlaps(capsule, Sphere{real(c), Real(q)}), come_near(a, b, c, c, r + q));

        const Int3 low = glm::min(c, d), high = glm::max(c, d);
        const Aabb box{real(low), real(high)};
        ASSERT_EQ(overlaps(capsule, box), comes_near(low, high, a, b, r)) << trial;
        ASSERT_EQ(overlaps(Sphere{real(a), Real(r)}, box), comes_near(low, high, a, a, r));
        ASSERT_EQ(overlaps(Sphere{real(a), Real(r)}, Sphere{real(b), Real(q)}),
                  come_near(a, a, b, b, r + q));

        // Boxes that are not rotated, or by a half turn, which changes nothing.
        const Int3 half = glm::abs(d);
        const Quat turn = random.next_index(2) == 0 ? identity_rotation
                                                    : Quat{Real(0), Real(0), Real(1), Real(0)};
        const Box turned{real(c), turn, real(half)};
        ASSERT_EQ(overlaps(capsule, turned), comes_near(c - half, c + half, a, b, r));
        ASSERT_EQ(overlaps(Sphere{real(a), Real(r)}, turned),
                  comes_near(c - half, c + half, a, a, r));
        const Int3 other_half = glm::abs(b);
        const Int3 gap = glm::abs(a - c) - half - other_half;
        const bool boxes = gap.x <= 0 && gap.y <= 0 && gap.z <= 0;
        const Aabb other{real(a - other_half), real(a + other_half)};
        ASSERT_EQ(overlaps(turned, Box{real(a), identity_rotation, real(other_half)}), boxes);
        ASSERT_EQ(overlaps(other, turned), boxes);
        ASSERT_EQ(overlaps(turned, other), boxes);
        ASSERT_EQ(overlaps(other, Aabb{real(c - half), real(c + half)}), boxes);
        // A third of a turn carries x to y, y to z, z to x.
        const Int3 carried{half.z, half.x, half.y};
        const Int3 third = glm::abs(a - c) - carried - other_half;
        ASSERT_EQ(overlaps(other, Box{real(c), Quat{h, h, h, h}, real(half)}),
                  third.x <= 0 && third.y <= 0 && third.z <= 0);

        // Planes.
        const Plane plane{{Real(0), Real(0), Real(-1)}, Real(q)};
        ASSERT_EQ(overlaps(Sphere{real(a), Real(r)}, plane), std::abs(-a.z - q) <= r);
        ASSERT_EQ(overlaps(plane, box), -high.z <= q && q <= -low.z);
        ASSERT_EQ(overlaps(turned, plane), std::abs(-c.z - q) <= half.z);
        ASSERT_EQ(overlaps(plane, capsule),
                  std::min(-a.z, -b.z) - r <= q && q <= std::max(-a.z, -b.z) + r);
    }
    EXPECT_GT(touching, trials(1'000'000) / 20);
}

TEST(Overlap, PlanesAreExact) {
    const Vec3 n{Real(0.6), Real(0), Real(0.8)};
    EXPECT_TRUE(overlaps(Plane{n, Real(2)}, Plane{n, Real(2)}));
    EXPECT_TRUE(overlaps(Plane{n, Real(2)}, Plane{-n, Real(-2)}));
    EXPECT_FALSE(overlaps(Plane{n, Real(2)}, Plane{-n, Real(2)}));
    EXPECT_FALSE(overlaps(Plane{n, Real(2)}, Plane{n, std::nextafter(Real(2), Real(3))}));
    // A normal that differs in its last bit meets the other plane far away.
    Vec3 m = n;
    m.x = std::nextafter(m.x, Real(1));
    EXPECT_TRUE(overlaps(Plane{n, Real(2)}, Plane{m, Real(3)}));
    // The same plane with normals of two lengths within the tolerance.
    const Real longer = Real(1) + std::ldexp(Real(1), -11);
    const Vec3 up{Real(0), Real(1), Real(0)};
    EXPECT_TRUE(overlaps(Plane{up, Real(2)}, Plane{longer * up, Real(2) * longer}));
    EXPECT_FALSE(overlaps(Plane{up, Real(2)}, Plane{longer * up, Real(2)}));
}

TEST(Overlap, EmptyBoxesOverlapNothingAndMisuseNamesTheValue) {
    const Vec3 p{Real(1), Real(2), Real(3)};
    const Aabb empty, all{Vec3{Real(-100)}, Vec3{Real(100)}};
    const Box box{p, identity_rotation, Vec3{Real(1)}};
    EXPECT_FALSE(overlaps(empty, empty));
    EXPECT_FALSE(overlaps(empty, all));
    EXPECT_FALSE(overlaps(empty, box));
    EXPECT_FALSE(overlaps(Sphere{p, Real(1)}, empty));
    EXPECT_FALSE(overlaps(Capsule{p, -p, Real(1)}, empty));
    EXPECT_FALSE(overlaps(empty, Plane{}));
    EXPECT_TRUE(overlaps(Capsule{p, p, Real(0)}, Capsule{p, p, Real(0)}));
    EXPECT_TRUE(overlaps(Capsule{p, p, Real(0)}, all));

    says([&] { overlaps(Sphere{p, Real(1)}, Sphere{p, Real(-7)}); }, "-7");
    says([&] { overlaps(Sphere{p, Real(-7)}, all); }, "-7");
    says([&] { overlaps(Capsule{p, p, Real(-7)}, box); }, "-7");
    says([&] { overlaps(all, Box{p, identity_rotation, Vec3{Real(-4)}}); }, "-4");
    says([&] { overlaps(Plane{}, Plane{Vec3{Real(5), Real(0), Real(0)}, Real(0)}); }, "5");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
