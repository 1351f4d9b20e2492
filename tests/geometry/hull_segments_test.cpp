// Segments that cross an edge of a hull, or touch a corner, exactly.
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/quickhull.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

HullMesh unit_tetrahedron() {
    const Real o(0), i(1);
    const std::vector<Vec3> corners = {{o, o, o}, {i, o, o}, {o, i, o}, {o, o, i}};
    return std::move(*convex_hull(corners, 4).mesh);
}

TEST(HullSegments, ThatCrossAnEdgeExactlyMeet) {
    const HullMesh mesh = unit_tetrahedron();
    const ConvexHull hull{&mesh, Vec3{Real(0)}, identity_rotation};
    ASSERT_TRUE(mesh.has_flat_faces);
    EXPECT_TRUE(linetest(hull, Vec3{Real(0.5), Real(-0.1), Real(0.3)},
                         Vec3{Real(0.5), Real(0.2), Real(-0.6)}));
    // Through (x, 0, 0) with both ends outside: from -k (0, y, z) to l (0, y, z), where each
    // product is exact. The directions are rounded, the crossing is not.
    Random random(1);
    int lost = 0;
    const int trial_count = trials(200'000);
    for (int i = 0; i < trial_count; ++i) {
        const Real x = Real(random.next_in(0.01, 0.99));
        Real y = Real(random.next_in(0.01, 1.0)), z = Real(-random.next_in(0.01, 1.0));
        // 16 bits (40 in double) for y and z leave room for k and l.
        const Real grid = sizeof(Real) == 4 ? Real(0x1p16) : Real(0x1p40);
        y = std::round(y * grid) / grid;
        z = std::round(z * grid) / grid;
        const Real k = Real(1 + int(random.next_index(100))),
                   l = Real(1 + int(random.next_index(100)));
        // Off the edge's own plane in x as well, along the edge.
        const Vec3 a{x, -k * y, -k * z}, b{x, l * y, l * z};
        const bool is_met = linetest(hull, a, b) && linetest(hull, b, a);
        lost += is_met ? 0 : 1;
        // A hair further out they miss.
        const Real off = -Real(0x1p-60);
        ASSERT_FALSE(linetest(hull, Vec3{x, a.y, off}, Vec3{x, b.y, off}));
    }
    EXPECT_EQ(lost, 0) << "of " << trial_count;
}

// Against integers: segment and hull are both on a lattice.
TEST(HullSegments, ExactOnAFineLattice) {
    const HullMesh mesh = unit_tetrahedron();
    const ConvexHull hull{&mesh, Vec3{Real(0)}, identity_rotation};
    __extension__ using Exact = __int128; // not in ISO C++
    Random random(2);
    int met = 0, touching = 0;
    const Real unit_length = sizeof(Real) == 4 ? Real(0x1p-12) : Real(0x1p-24);
    const auto size = long(1.0 / double(unit_length));
    for (int i = 0; i < trials(300'000); ++i) {
        const auto any = [&] { return long(random.next_in(-2.0, 2.0) * double(size)); };
        std::array<long, 3> a{any(), any(), any()}, b{any(), any(), any()};
        if (i % 2 == 0) { // through a point of an edge on the x axis
            const long x = long(random.next_in(0.0, 1.0) * double(size));
            const long k = 1 + long(random.next_index(3));
            for (int c = 0; c < 3; ++c)
                a[std::size_t(c)] /= 4;
            for (std::size_t c = 0; c < 3; ++c)
                b[c] = (c == 0 ? x : 0) - k * (a[c] - (c == 0 ? x : 0));
        }
        // Clips by x, y, z >= 0 and x + y + z <= size in fractions t = p / q.
        Exact enter_p = 0, enter_q = 1, exit_p = 1, exit_q = 1;
        bool is_met = true;
        const auto clip = [&](Exact from, Exact to) { // heights in front of a face at both ends
            if (from > 0 && to > 0)
                is_met = false;
            const Exact p = from, q = from - to; // crosses at p / q
            if (q > 0 && from > 0 && p * enter_q > enter_p * q) {
                enter_p = p;
                enter_q = q;
            } else if (q < 0 && to > 0 && (-p) * exit_q < exit_p * (-q)) {
                exit_p = -p;
                exit_q = -q;
            }
        };
        for (std::size_t c = 0; c < 3; ++c)
            clip(-a[c], -b[c]);
        clip(a[0] + a[1] + a[2] - size, b[0] + b[1] + b[2] - size);
        is_met = is_met && enter_p * exit_q <= exit_p * enter_q;
        touching += is_met && enter_p * exit_q == exit_p * enter_q ? 1 : 0;
        met += is_met ? 1 : 0;
        const auto point = [&](const std::array<long, 3> &p) {
            return unit_length * Vec3{Real(p[0]), Real(p[1]), Real(p[2])};
        };
        ASSERT_EQ(linetest(hull, point(a), point(b)), is_met) << "trial " << i;
    }
    EXPECT_GT(met, 0);
    EXPECT_GT(touching, 0);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
