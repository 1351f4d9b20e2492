#include "engine/geometry/frustum.h"

#include "tests/geometry/wide.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <string>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

using W4 = glm::vec<4, W, glm::defaultp>;
using WideMatrix = glm::mat<4, 4, W, glm::defaultp>;

// A camera anywhere, the engine's frustum for it, and the clip volume of the same matrix in wider
// numbers: a point is inside when -w <= x, y, z <= w.
struct View {
    Mat4 matrix{Real(1)};
    WideMatrix wide_matrix{W(1)};
    Frustum frustum;
    std::array<W3, 8> corners;
    std::array<W4, 6> planes; // outward: dot(xyz, p) + w <= 0 inside, xyz unit
    W scale = 0;              // the largest coordinate of a corner
    W bound = 0;

    explicit View(Random &random) {
        const W3 eye = any_offset(random, any_power(random, -1, 3));
        const W3 forward = awkward_unit(random);
        W3 up = any_unit(random);
        while (glm::length(glm::cross(forward, up)) < W(0.1))
            up = any_unit(random);
        const WideMatrix view = glm::lookAt(eye, eye + forward, up);
        const W near = any_power(random, -1, 1), ratio = any_power(random, 0.1, 2);
        WideMatrix projection{W(1)};
        switch (random.next_index(3)) {
        case 0:
            projection = glm::perspective(W(random.next_in(0.2, 2.5)), W(random.next_in(0.4, 2.5)),
                                          near, near * ratio);
            break;
        case 1: { // off-centre, as for a tile of a picture
            const W left = near * W(random.next_in(-1, 1)),
                    width = near * W(random.next_in(0.1, 2));
            projection =
                glm::frustum(left, left + width, -width, width * W(0.3), near, near * ratio);
            break;
        }
        default: {
            const W height = near * W(random.next_in(0.2, 5));
            projection = glm::ortho(-height, height * W(1.5), -height, height, near, near * ratio);
        }
        }
        matrix = Mat4(projection * view);
        wide_matrix = WideMatrix(matrix);
        frustum = frustum_of(matrix);

        const WideMatrix inverse = glm::inverse(wide_matrix);
        for (int k = 0; k < 8; ++k) {
            const W4 p = inverse *
                         W4{(k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1, 1};
            corners[std::size_t(k)] = W3{p} / p.w;
            scale = std::max(scale, largest(corners[std::size_t(k)]));
        }
        for (int face = 0; face < 6; ++face) {
            W4 row{W(0)};
            for (int j = 0; j < 4; ++j)
                row[j] = (face % 2 == 0 ? -wide_matrix[j][face / 2] : wide_matrix[j][face / 2]) -
                         wide_matrix[j][3];
            planes[std::size_t(face)] = row / glm::length(W3{row});
        }
        // In float the result is double's, rounded; in double the far plane is a small difference.
        bound = 8 * epsilon * scale * (sizeof(Real) == sizeof(float) ? W(1) : W(4) * ratio);
    }
    W height(std::size_t face, const W3 &p) const {
        return glm::dot(W3{planes[face]}, p) + planes[face].w;
    }
    // The largest height over any face: negative inside.
    W worst(const W3 &p) const {
        W most = height(0, p);
        for (std::size_t face = 1; face < 6; ++face)
            most = std::max(most, height(face, p));
        return most;
    }
    // The point with the given clip coordinates divided by w.
    W3 at(const W3 &clip) const {
        const W4 p = glm::inverse(wide_matrix) * W4{clip, W(1)};
        return W3{p} / p.w;
    }
    // A point in or near the frustum, often near an edge or a corner of it.
    W3 any_near(Random &random) const {
        W3 parts{W(random.next_in(0, 1)), W(random.next_in(0, 1)), W(random.next_in(0, 1))};
        if (random.next_index(2) == 0)
            for (int i = 0; i < 3; ++i)
                if (random.next_index(2) == 0)
                    parts[i] = W(random.next_index(2));
        // Between the corners, in an affine frame, so that nothing flips beyond them.
        W3 p{W(0)};
        for (int k = 0; k < 8; ++k)
            p += corners[std::size_t(k)] *
                 (((k & 1) != 0 ? parts.x : 1 - parts.x) * ((k & 2) != 0 ? parts.y : 1 - parts.y) *
                  ((k & 4) != 0 ? parts.z : 1 - parts.z));
        return p;
    }
    // A direction that leaves the frustum from most points near its surface.
    W3 any_outward(Random &random, const W3 &from) const {
        const W3 middle = (corners[0] + corners[7]) * W(0.5);
        return glm::normalize(glm::normalize(from - middle) + any_unit(random) * W(0.7));
    }
    // The sine of the sharpest angle between neighbouring faces.
    W sharpest() const {
        W least = 1;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (i / 2 != j / 2)
                    least = std::min(least, glm::length(glm::cross(W3{planes[i]}, W3{planes[j]})));
        return least;
    }
    W size() const { return glm::length(corners[7] - corners[0]); }
};

constexpr int views = 1000; // each with as many shapes

TEST(Frustum, PlanesAndCornersAreThoseOfTheMatrix) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const View view(random);
        for (int k = 0; k < 8; ++k) {
            const W3 corner = widened(view.frustum.corners[std::size_t(k)]);
            ASSERT_LE(glm::length(corner - view.corners[std::size_t(k)]), view.bound);
            for (int face = 0; face < 6; ++face) {
                const Plane &plane = view.frustum.planes[std::size_t(face)];
                const bool is_on_face = ((k >> (face / 2)) & 1) == face % 2;
                const W height =
                    glm::dot(widened(plane.normal), view.corners[std::size_t(k)]) - W(plane.offset);
                ASSERT_NEAR(double(glm::length(widened(plane.normal))), 1.0, 4 * double(epsilon));
                if (is_on_face) {
                    ASSERT_LE(std::abs(height), view.bound) << "corner " << k << " face " << face;
                } else {
                    ASSERT_LT(height, -view.bound) << "corner " << k << " face " << face;
                }
            }
        }
    }
}

TEST(Frustum, PointsAgainstTheClipVolume) {
    Random random(2);
    int inside = 0;
    for (int v = 0; v < views; ++v) {
        const View view(random);
        for (int trial = 0; trial < trials(1'000'000) / views; ++trial) {
            const Vec3 point = narrowed(view.any_near(random) + any_unit(random) * view.size() *
                                                                    any_power(random, -8, -0.3));
            const W3 p = widened(point);
            const W4 clip = view.wide_matrix * W4{p, W(1)};
            if (std::abs(view.worst(p)) <= view.bound)
                continue;
            const bool is_inside = largest(W3{clip}) <= clip.w;
            ASSERT_EQ(contains(view.frustum, point), is_inside);
            ASSERT_EQ(classify(view.frustum, point),
                      is_inside ? FrustumSide::inside : FrustumSide::outside);
            inside += is_inside;
        }
    }
    EXPECT_GT(inside, trials(1'000'000) / 10);
}

// What the plane tests must say about a shape that spans from `lowest` to `highest` over each face;
// nothing where either is within the bound of zero.
struct Expected {
    FrustumSide side = FrustumSide::inside;
    bool is_certain = true;

    void meet(W lowest, W highest, W bound) {
        is_certain = is_certain && std::abs(lowest) > bound && std::abs(highest) > bound;
        if (lowest > W(0))
            side = FrustumSide::outside;
        else if (highest > W(0) && side == FrustumSide::inside)
            side = FrustumSide::across;
    }
};

template <typename Shape, typename Reach>
void judge_planes(const View &view, const Shape &shape, W bound, const Reach &reach) {
    Expected expected;
    for (std::size_t face = 0; face < 6; ++face) {
        W lowest = 0, highest = 0;
        reach(face, lowest, highest);
        expected.meet(lowest, highest, bound);
    }
    if (expected.is_certain) {
        ASSERT_EQ(classify(view.frustum, shape), expected.side);
    }
}

// Whether the frustum meets the box with each half extent grown by `grow`: clips each one's faces
// by the other's planes and looks for anything left.
bool meets(const View &view, Frame box, W grow) {
    box.half += W3{grow};
    // A corner inside settles it without clipping.
    std::array<W3, 8> of_box_at;
    for (int k = 0; k < 8; ++k) {
        of_box_at[std::size_t(k)] = box.corner(k);
        if (view.worst(of_box_at[std::size_t(k)]) <= W(0) ||
            box.signed_distance(view.corners[std::size_t(k)]) <= W(0))
            return true;
    }
    for (std::size_t face = 0; face < 6; ++face)
        if (std::all_of(of_box_at.begin(), of_box_at.end(),
                        [&](const W3 &p) { return view.height(face, p) > W(0); }))
            return false;
    if (view.worst(box.center) <= W(0))
        return true;
    for (const auto &face : face_corners) {
        Polygon of_box, of_frustum;
        for (std::size_t k : face) {
            of_box.corner[of_box.count++] = of_box_at[k];
            of_frustum.corner[of_frustum.count++] = view.corners[k];
        }
        for (std::size_t p = 0; p < 6 && of_box.count > 0; ++p)
            of_box.cut(W3{view.planes[p]}, -view.planes[p].w);
        box.cut(of_frustum);
        if (of_box.count > 0 || of_frustum.count > 0)
            return true;
    }
    return false;
}

struct Counts {
    int overlapping = 0;
    int apart = 0;
    int apart_but_across = 0; // cases the plane tests alone cannot tell
};

template <typename AnyBox>
void judge_box(const View &view, const AnyBox &box, W box_scale, Counts &counts) {
    const Frame frame(box);
    const W scale = std::max(view.scale, box_scale);
    const W bound = std::max(view.bound, 32 * epsilon * scale);
    judge_planes(view, box, bound, [&](std::size_t face, W &lowest, W &highest) {
        lowest = std::numeric_limits<W>::infinity();
        highest = -lowest;
        for (int k = 0; k < 8; ++k) {
            lowest = std::min(lowest, view.height(face, frame.corner(k)));
            highest = std::max(highest, view.height(face, frame.corner(k)));
        }
    });
    // A box grown by g on all sides overlaps everything within g of it, and nothing further than
    // sqrt(3) g.
    const W g = bound / std::sqrt(W(3));
    const bool answer = overlaps(view.frustum, box);
    if (answer) {
        ASSERT_TRUE(meets(view, frame, g));
        ++counts.overlapping;
    } else {
        ++counts.apart;
        counts.apart_but_across += classify(view.frustum, box) == FrustumSide::across;
        if (std::min({frame.half.x, frame.half.y, frame.half.z}) > g) {
            ASSERT_FALSE(meets(view, frame, -g));
        }
    }
}

template <typename AnyBox> void check_boxes(std::uint64_t seed) {
    Random random(seed);
    Counts counts;
    for (int v = 0; v < views; ++v) {
        const View view(random);
        for (int trial = 0; trial < trials(1'000'000) / views; ++trial) {
            const W size = view.size() * any_power(random, -2, 0.3);
            const W3 near = view.any_near(random);
            const W3 u = view.any_outward(random, near);
            // Moved outwards from a point of the frustum until they touch, or not quite.
            Box box{{}, oracle::awkward_rotation(random), any_half_extents(random, size)};
            const Frame frame(box);
            box.center = narrowed(near + u * (frame.reach(u) * W(random.next_in(0.5, 1.5)) +
                                              size * any_power(random, -6, -1)));
            if constexpr (std::is_same_v<AnyBox, Box>) {
                judge_box(view, box, scale_of(box), counts);
            } else {
                const Aabb aabb{box.center - box.half_extents, box.center + box.half_extents};
                judge_box(view, aabb, scale_of(aabb), counts);
            }
            if (testing::Test::HasFatalFailure())
                return;
        }
    }
    EXPECT_GT(counts.overlapping, trials(1'000'000) / 8);
    EXPECT_GT(counts.apart, trials(1'000'000) / 8);
    EXPECT_GT(counts.apart_but_across, trials(1'000'000) / 100);
}

TEST(Frustum, BoxesAgainstClipping) {
    check_boxes<Box>(3);
}

TEST(Frustum, AabbsAgainstClipping) {
    check_boxes<Aabb>(6);
}

TEST(Frustum, SpheresCapsulesAndClosestPoints) {
    Random random(4);
    int apart_but_across = 0;
    for (int v = 0; v < views; ++v) {
        const View view(random);
        for (int trial = 0; trial < trials(1'000'000) / views; ++trial) {
            const W size = view.size() * any_power(random, -2, 0);
            const W3 near = view.any_near(random);
            const Vec3 center =
                narrowed(near + view.any_outward(random, near) * (size + any_gap(random, size)));
            const Sphere sphere{center, static_cast<Real>(size)};
            const W3 c = widened(center);
            const W bound =
                std::max(view.bound, 32 * epsilon * std::max(view.scale, scale_of(sphere)));
            const W r = W(sphere.radius);
            judge_planes(view, sphere, bound, [&](std::size_t face, W &lowest, W &highest) {
                lowest = view.height(face, c) - r;
                highest = view.height(face, c) + r;
            });
            const Capsule capsule{center, narrowed(c + any_unit(random) * size), sphere.radius};
            judge_planes(view, capsule, bound, [&](std::size_t face, W &lowest, W &highest) {
                const W a = view.height(face, c), b = view.height(face, widened(capsule.b));
                lowest = std::min(a, b) - r;
                highest = std::max(a, b) + r;
            });

            // The closest point is in the frustum, and the frustum is behind the plane through it
            // perpendicular to the direction to the centre.
            const W3 q = widened(closest_point(view.frustum, center));
            const W at_edges = bound / view.sharpest();
            ASSERT_LE(view.worst(q), bound);
            const W3 way = c - q;
            const W distance = glm::length(way);
            for (const W3 &corner : view.corners)
                ASSERT_LE(glm::dot(way, corner - q), at_edges * (view.size() + 2 * distance));
            if (view.worst(c) < -bound) {
                ASSERT_EQ(distance, W(0));
            }
            // So the distance is known, up to that plane's tilt across the frustum.
            W shortfall = 0;
            for (const W3 &corner : view.corners)
                shortfall = std::max(shortfall, glm::dot(way, corner - q));
            const W least = distance > W(0) ? distance - shortfall / distance : W(0);
            if (distance + bound < r) {
                ASSERT_TRUE(overlaps(view.frustum, sphere));
            }
            if (least - bound > r) {
                ASSERT_FALSE(overlaps(view.frustum, sphere));
                apart_but_across += classify(view.frustum, sphere) == FrustumSide::across;
            }
            if (HasFatalFailure())
                return;
        }
    }
    EXPECT_GT(apart_but_across, trials(1'000'000) / 100);
}

TEST(Frustum, UnprojectAndPick) {
    Random random(5);
    for (int v = 0; v < views; ++v) {
        const View view(random);
        const Mat4 inverse = Mat4(glm::inverse(view.wide_matrix));
        const WideMatrix back = glm::inverse(WideMatrix(inverse));
        const Viewport viewport{
            {Real(random.next_index(100)), Real(random.next_index(100))},
            {Real(100 + random.next_index(2000)), Real(100 + random.next_index(2000))}};
        for (int trial = 0; trial < trials(1'000'000) / views; ++trial) {
            const Vec2 pixel =
                viewport.origin + viewport.size * Vec2{static_cast<Real>(random.next_unit()),
                                                       static_cast<Real>(random.next_unit())};
            const Real depth = static_cast<Real>(random.next_unit());
            const Vec3 point = unproject(pixel, depth, inverse, viewport);
            // Projecting the point again gives its original pixel, to within what the roundings of
            // the point and the pixel are worth in pixels there.
            const auto project = [&](const W3 &p) {
                const W4 clip = back * W4{p, W(1)};
                return W3{W(viewport.origin.x) + W(viewport.size.x) * (clip.x / clip.w + 1) / 2,
                          W(viewport.origin.y) + W(viewport.size.y) * (1 - clip.y / clip.w) / 2,
                          (clip.z / clip.w + 1) / 2};
            };
            const W3 p = widened(point);
            const W3 there = project(p);
            const W tolerance = 32 * epsilon *
                                (view.scale / glm::length(view.corners[0] - view.corners[1]) + 4) *
                                W(viewport.size.x + viewport.size.y);
            ASSERT_LE(std::abs(there.x - W(pixel.x)), tolerance);
            ASSERT_LE(std::abs(there.y - W(pixel.y)), tolerance);
            const Ray ray = pick_ray(pixel, inverse, viewport);
            ASSERT_EQ(ray.max_t, Real(1));
            ASSERT_EQ(ray.origin, unproject(pixel, Real(0), inverse, viewport));
        }
    }
}

TEST(Frustum, PixelsAreCountedFromTheTopLeft) {
    const Mat4 projection =
        glm::ortho(Real(-2), Real(2), Real(-1), Real(1), Real(1), Real(3)); // looks along -z
    const Mat4 inverse = glm::inverse(projection);
    const Viewport viewport{{Real(10), Real(20)}, {Real(400), Real(200)}};
    const auto expect_near = [](const Vec3 &a, const Vec3 &b) {
        EXPECT_LE(glm::length(a - b), Real(8) * std::numeric_limits<Real>::epsilon() * Real(3));
    };
    expect_near(unproject({Real(10), Real(20)}, Real(0), inverse, viewport),
                {Real(-2), Real(1), Real(-1)});
    expect_near(unproject({Real(410), Real(220)}, Real(1), inverse, viewport),
                {Real(2), Real(-1), Real(-3)});
    const Ray ray = pick_ray({Real(210), Real(120)}, inverse, viewport);
    expect_near(ray.origin, {Real(0), Real(0), Real(-1)});
    expect_near(ray.direction, {Real(0), Real(0), Real(-2)});

    const Frustum frustum = frustum_of(projection);
    expect_near(frustum.corners[0], {Real(-2), Real(-1), Real(-1)}); // left, bottom, near
    expect_near(frustum.corners[7], {Real(2), Real(1), Real(-3)});
    expect_near(frustum.planes[Frustum::near].normal, {Real(0), Real(0), Real(1)});
    expect_near(frustum.planes[Frustum::right].normal, {Real(1), Real(0), Real(0)});
}

TEST(Frustum, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Mat4 good = glm::perspective(Real(1), Real(1), Real(1), Real(10));
    const Frustum frustum = frustum_of(good);
    says([&] { frustum_of(glm::infinitePerspective(Real(1), Real(1), Real(1))); }, "plane 5");
    says([&] { frustum_of(Mat4{Real(0)}); }, "plane 0");
    Mat4 bad = good;
    bad[2][1] = nan;
    says([&] { frustum_of(bad); }, "nan in column 2, row 1");
    Mat4 flat = good; // y collapsed
    flat[1][1] = Real(0);
    says([&] { frustum_of(flat); }, "corner 0");
    says([&] { frustum_of(-good); }, "corner 0");
    says([&] { classify(frustum, Sphere{Vec3{Real(0)}, Real(-2)}); }, "-2");
    says([&] { overlaps(frustum, Aabb{Vec3{Real(4)}, Vec3{Real(1)}}); }, "(4, 4, 4)");
    says([&] { contains(frustum, Vec3{nan}); }, "nan");
    says([&] { unproject({}, Real(0), good, Viewport{{}, {Real(0), Real(-3)}}); }, "(0, -3)");
    says([&] { unproject({}, nan, good, Viewport{}); }, "nan");
    says([&] { unproject({}, Real(0), Mat4{Real(0)}, Viewport{}); }, "nan");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
