#include "engine/geometry/contains.h"

#include "tests/geometry/wide.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

TEST(Contains, SphereOfAnySize) {
    Random random(1);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const Sphere sphere{narrowed(any_position(random)), static_cast<Real>(size)};
        const Vec3 point = narrowed(widened(sphere.center) +
                                    awkward_unit(random) * (size + any_gap(random, size)));
        const W height = glm::length(widened(point) - widened(sphere.center)) - W(sphere.radius);
        judge(contains(sphere, point), height, 8 * epsilon * W(sphere.radius));
        ASSERT_EQ(contains(Shape{sphere}, point), contains(sphere, point));
        if (HasFatalFailure())
            return;
    }
}

// A point near the surface of a box: on one face, or beyond two or three of them.
W3 near_surface(Random &random, const W3 &half, W size) {
    W3 local{half.x * W(random.next_in(-1, 1)), half.y * W(random.next_in(-1, 1)),
             half.z * W(random.next_in(-1, 1))};
    for (std::uint32_t faces = 1 + random.next_index(3); faces > 0; --faces) {
        const int i = int(random.next_index(3));
        const W side = random.next_index(2) == 0 ? W(1) : W(-1);
        local[i] = side * (half[i] + any_gap(random, size));
    }
    return local;
}

TEST(Contains, BoxOfAnySizeAndOrientation) {
    Random random(2);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        Box box{narrowed(any_position(random)), oracle::awkward_rotation(random),
                any_half_extents(random, size)};
        if (random.next_index(8) == 0)
            box.rotation *= Real(1) + static_cast<Real>(random.next_in(-7, 7) * double(epsilon));
        const Frame frame(box);
        const Vec3 point = narrowed(frame.point(near_surface(random, frame.half, size)));
        const W diagonal = W(2) * glm::length(frame.half);
        const bool is_turned = box.rotation.x != 0 || box.rotation.y != 0 || box.rotation.z != 0;
        judge(contains(box, point), frame.signed_distance(widened(point)),
              is_turned ? 8 * epsilon * diagonal : epsilon * scale_of(box));
        if (HasFatalFailure())
            return;
    }
}

TEST(Contains, CapsuleOfAnySize) {
    Random random(3);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        Capsule capsule;
        const W3 a = any_position(random);
        const W3 u = awkward_unit(random);
        capsule.a = narrowed(a);
        capsule.b = random.next_index(16) == 0 ? capsule.a : narrowed(a + u * size);
        capsule.radius = static_cast<Real>(size * any_power(random, -2, 1));
        const W3 foot = a + u * size * W(random.next_in(-0.1, 1.1));
        const W3 v = awkward_unit(random);
        const W3 across = v - u * glm::dot(u, v) * W(random.next_index(2));
        if (glm::length(across) < W(1e-3))
            continue;
        const Vec3 point =
            narrowed(foot + glm::normalize(across) * (W(capsule.radius) + any_gap(random, size)));
        const W3 p = widened(point);
        const W height =
            glm::length(p - closest_on_segment(widened(capsule.a), widened(capsule.b), p)) -
            W(capsule.radius);
        const W length = glm::length(widened(capsule.b) - widened(capsule.a));
        judge(contains(capsule, point), height, 8 * epsilon * (length + W(capsule.radius)));
        if (HasFatalFailure())
            return;
    }
}

TEST(Contains, CylinderOfAnySize) {
    Random random(4);
    Judge judge;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 a = any_offset(random, size * any_power(random, -2, 2));
        const W3 u = awkward_unit(random);
        const Cylinder cylinder{narrowed(a), narrowed(a + u * size),
                                static_cast<Real>(size * any_power(random, -2, 1))};
        if (cylinder.a == cylinder.b)
            continue;
        const W3 v = awkward_unit(random);
        const W3 across = v - u * glm::dot(u, v);
        if (glm::length(across) < W(1e-3))
            continue;
        const W3 side = glm::normalize(across);
        W3 p = a + u * size * W(random.next_in(-0.1, 1.1)) +
               side * (W(cylinder.radius) + any_gap(random, size));
        if (random.next_index(2) == 0)
            p = a + u * (size * W(random.next_index(2)) + any_gap(random, size)) +
                side * (W(cylinder.radius) * W(random.next_in(0, 1.1)));
        const Vec3 point = narrowed(p);
        // Height above the nearer end, and distance from the axis.
        const W3 wide_a = widened(cylinder.a), wide_b = widened(cylinder.b);
        const W3 axis = glm::normalize(wide_b - wide_a);
        const W3 q = widened(point);
        const W beyond = std::max(glm::dot(q - wide_b, axis), -glm::dot(q - wide_a, axis));
        const W3 from_a = q - wide_a;
        const W height = std::max(beyond, glm::length(from_a - axis * glm::dot(from_a, axis)) -
                                              W(cylinder.radius));
        const W length = glm::length(wide_b - wide_a);
        judge(contains(cylinder, point), height, 8 * epsilon * (length + W(cylinder.radius)));
        if (HasFatalFailure())
            return;
    }
}

// --- Exact answers -----------------------------------------------------------------------------

// The squared distance of p from the segment times |b - a|^2 (times 1 when that is zero).
Int scaled_distance(const Int3 &a, const Int3 &b, const Int3 &p, Int &scale) {
    const Int3 d = b - a, from_a = p - a, from_b = p - b;
    scale = 1;
    if (product(from_a, d) <= 0)
        return product(from_a, from_a);
    if (product(from_b, d) >= 0)
        return product(from_b, from_b);
    scale = product(d, d);
    return product(from_a, from_a) * scale - product(from_a, d) * product(from_a, d);
}

TEST(Contains, WholeNumbersAreExact) {
    Random random(5);
    const Real h = Real(0.5);
    // Half turns and third turns have exact quaternions; each permutes the axes.
    const std::array<Quat, 4> turns{identity_rotation, Quat{Real(0), Real(1), Real(0), Real(0)},
                                    Quat{h, h, h, h}, Quat{h, -h, h, -h}};
    int on_surface = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Int3 a = any_int3(random, 8), b = any_int3(random, 8), p = any_int3(random, 8);
        const Int r = Int(random.next_index(9));
        const Int3 from_a = p - a;
        ASSERT_EQ(contains(Sphere{real(a), Real(r)}, real(p)), product(from_a, from_a) <= r * r);
        Int scale = 1;
        const Int squared = scaled_distance(a, b, p, scale);
        on_surface += squared == r * r * scale;
        ASSERT_EQ(contains(Capsule{real(a), real(b), Real(r)}, real(p)), squared <= r * r * scale);
        ASSERT_EQ(contains(Segment{real(a), real(b)}, real(p)), squared == 0);
        const Int3 d = b - a;
        if (product(d, d) > 0) {
            const Int rest =
                product(from_a, from_a) * product(d, d) - product(from_a, d) * product(from_a, d);
            const bool is_between = product(from_a, d) >= 0 && product(p - b, d) <= 0;
            ASSERT_EQ(contains(Cylinder{real(a), real(b), Real(r)}, real(p)),
                      is_between && rest <= r * r * product(d, d));
        }
        const std::size_t turn = random.next_index(4);
        const Int3 half{std::abs(b.x), std::abs(b.y), std::abs(b.z)};
        const std::array<Int3, 4> local{from_a, Int3{from_a.x, -from_a.y, -from_a.z},
                                        Int3{from_a.y, from_a.z, from_a.x},
                                        Int3{-from_a.y, -from_a.z, from_a.x}};
        const Int3 &q = local[turn];
        ASSERT_EQ(contains(Box{real(a), turns[turn], real(half)}, real(p)),
                  std::abs(q.x) <= half.x && std::abs(q.y) <= half.y && std::abs(q.z) <= half.z)
            << "turn " << turn;
        const Aabb box{real(a), real(b)};
        ASSERT_EQ(contains(box, real(p)),
                  a.x <= p.x && p.x <= b.x && a.y <= p.y && p.y <= b.y && a.z <= p.z && p.z <= b.z);
        const Vec3 axis{Real(0), Real(-1), Real(0)};
        ASSERT_EQ(contains(HalfSpace{axis, Real(r)}, real(p)), -p.y <= r);
        ASSERT_EQ(contains(Plane{axis, Real(r)}, real(p)), -p.y == r);
    }
    EXPECT_GT(on_surface, trials(1'000'000) / 1000);
}

// Numbers that use every bit of the mantissa, as integer multiples of a power of two.
__extension__ typedef __int128 Huge; // NOLINT(modernize-use-using): __extension__ needs it
constexpr int bits = sizeof(Real) == sizeof(float) ? 20 : 36;

Huge any_huge(Random &random) {
    return Huge(Int(random.next_in(-1.0, 1.0) * double(Int(1) << bits)));
}
struct Huge3 {
    Huge x = 0, y = 0, z = 0;
};
using wide::real;
Vec3 real(const Huge3 &v) {
    return {Real(Int(v.x)), Real(Int(v.y)), Real(Int(v.z))};
}
Huge cross_part(Huge ax, Huge ay, Huge bx, Huge by) {
    return ax * by - ay * bx;
}

TEST(Contains, LinesWithoutThicknessAreExact) {
    Random random(6);
    int on_line = 0, on_plane = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Huge3 a{any_huge(random), any_huge(random), any_huge(random)};
        // A direction with small components, so that its integer multiples lie on the line; one
        // coordinate may then be off by its last bit.
        const Int steps = any_int(random, 1 << 12);
        const Int length = Int(random.next_index(1 << 12));
        const Int3 d = any_int3(random, 1 << 6);
        if (product(d, d) == 0)
            continue;
        const Huge3 b{a.x + d.x * length, a.y + d.y * length, a.z + d.z * length};
        Huge3 p{a.x + d.x * steps, a.y + d.y * steps, a.z + d.z * steps};
        if (random.next_index(2) == 0)
            p.x += any_int(random, 1);
        if (random.next_index(4) == 0)
            p.z += any_int(random, 1);
        const Huge3 f{p.x - a.x, p.y - a.y, p.z - a.z};
        const bool is_collinear = cross_part(d.x, d.y, f.x, f.y) == 0 &&
                                  cross_part(d.y, d.z, f.y, f.z) == 0 &&
                                  cross_part(d.z, d.x, f.z, f.x) == 0;
        const Huge along = d.x * f.x + d.y * f.y + d.z * f.z; // steps * |d|^2 on the line
        const Huge whole = Huge(product(d, d));
        const bool is_forward = is_collinear && along >= 0;
        on_line += is_collinear;
        const bool on_segment = length == 0 ? along == 0 && f.x == 0 && f.y == 0 && f.z == 0
                                            : is_forward && along <= whole * length;
        ASSERT_EQ(contains(Segment{real(a), real(b)}, real(p)), on_segment) << "trial " << trial;
        ASSERT_EQ(contains(Ray{real(a), real(d)}, real(p)), is_forward) << "trial " << trial;
        // The same direction scaled by a power of two, with an end on a step.
        const Real factor = std::ldexp(Real(1), int(any_int(random, 18)));
        const Ray ray{real(a), real(d) * factor, Real(length) / factor};
        ASSERT_EQ(contains(ray, real(p)), is_forward && along <= whole * length)
            << "trial " << trial;
        // A plane whose normal is in multiples of 2^-12, and a point that is on it or off by the
        // last bit, where the rounded height can be anything.
        const double angle = random.next_in(0.0, 6.28);
        const Int one = 1 << 12;
        const Int3 m{Int(double(one) * std::cos(angle)), Int(double(one) * std::sin(angle)),
                     any_int(random, 64)};
        const Int far = any_int(random, 1 << 10);
        const Int3 q{m.y * far + any_int(random, 1), -m.x * far, any_int(random, 2)};
        const Int offset = any_int(random, 1);
        const Plane plane{real(m) / Real(one), Real(offset) / Real(one)};
        const Int height = product(m, q) - offset;
        ASSERT_EQ(contains(plane, real(q)), height == 0) << "trial " << trial;
        ASSERT_EQ(contains(HalfSpace{plane.normal, plane.offset}, real(q)), height <= 0)
            << "trial " << trial;
        on_plane += height == 0;
    }
    EXPECT_GT(on_line, trials(1'000'000) / 8);
    EXPECT_GT(on_plane, trials(1'000'000) / 50);
}

TEST(Contains, DegenerateShapes) {
    const Vec3 p{Real(1), Real(2), Real(3)};
    const Vec3 other{Real(1), Real(2), std::nextafter(Real(3), Real(4))};
    EXPECT_TRUE(contains(Sphere{p, Real(0)}, p));
    EXPECT_FALSE(contains(Sphere{p, Real(0)}, other));
    EXPECT_TRUE(contains(Box{p, identity_rotation, Vec3{Real(0)}}, p));
    EXPECT_FALSE(contains(Box{p, identity_rotation, Vec3{Real(0)}}, other));
    EXPECT_TRUE(contains(Capsule{p, p, Real(0)}, p));
    EXPECT_FALSE(contains(Capsule{p, p, Real(0)}, other));
    EXPECT_TRUE(contains(Segment{p, p}, p));
    EXPECT_FALSE(contains(Segment{p, p}, other));
    EXPECT_FALSE(contains(Aabb{}, p)); // empty
    EXPECT_TRUE(contains(Aabb{p, p}, p));
    EXPECT_TRUE(contains(Ray{p, p, Real(0)}, p));
    EXPECT_FALSE(contains(Ray{p, p, Real(-1)}, p));
    EXPECT_TRUE(contains(Ray{p, p}, Real(7) * p));
    EXPECT_FALSE(contains(Ray{p, p}, Vec3{Real(0)}));
}

TEST(Contains, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real infinity = std::numeric_limits<Real>::infinity();
    const Vec3 p{Real(1), Real(2), Real(3)};
    says([&] { contains(Sphere{p, Real(1)}, Vec3{Real(4), nan, Real(5)}); }, "(4, nan, 5)");
    says([&] { contains(Sphere{p, Real(-3)}, p); }, "-3");
    says([&] { contains(Box{p, identity_rotation, Vec3{Real(-2)}}, p); }, "-2");
    says([&] { contains(Cylinder{p, p, Real(1)}, p); }, "(1, 2, 3)");
    says([&] { contains(Ray{p, Vec3{Real(0)}}, p); }, "(0, 0, 0)");
    says([&] { contains(Ray{p, p, nan}, p); }, "nan");
    says([&] { contains(Segment{p, Vec3{infinity}}, p); }, "inf");
    says([&] { contains(Plane{Vec3{Real(2)}, Real(0)}, p); }, "(2, 2, 2)");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
