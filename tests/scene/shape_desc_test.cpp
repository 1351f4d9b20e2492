// Shape measures against closed forms and brute force.
#include "engine/scene/scene_desc.h"

#include "engine/core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;

HullDesc hull_of(std::vector<glm::dvec3> points) {
    HullDesc hull;
    hull.points = std::make_shared<const std::vector<glm::dvec3>>(std::move(points));
    return hull;
}

glm::dvec3 random_direction(Random &random) {
    for (;;) {
        const double x = random.next_in(-1, 1);
        const double y = random.next_in(-1, 1);
        const glm::dvec3 v(x, y, random.next_in(-1, 1));
        if (const double length = glm::length(v); length > 0.1 && length <= 1)
            return v / length;
    }
}

double extent_along(const std::vector<glm::dvec3> &points, const glm::dvec3 &direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const glm::dvec3 &point : points) {
        low = std::min(low, glm::dot(point, direction));
        high = std::max(high, glm::dot(point, direction));
    }
    return high - low;
}

TEST(ShapeDesc, CylindersAndRegularSolidsHaveTheirClosedForms) {
    EXPECT_DOUBLE_EQ(volume(CylinderDesc{1.5, 2}), 12 * pi);
    EXPECT_EQ(smallest_width(CylinderDesc{1.5, 2}), 3);
    EXPECT_EQ(smallest_width(CylinderDesc{3, 2}), 4);
    // Edges of sqrt(8): the volume is a^3 / (6 sqrt 2); two opposite edges are a / sqrt 2 apart.
    const ShapeDesc tetrahedron = hull_of({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
    EXPECT_NEAR(volume(tetrahedron), 8.0 / 3, 1e-12);
    EXPECT_NEAR(smallest_width(tetrahedron), 2, 1e-12);
    // Edges of sqrt 2: opposite faces are a sqrt(2 / 3) apart.
    const ShapeDesc octahedron =
        hull_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    EXPECT_NEAR(volume(octahedron), 4.0 / 3, 1e-12);
    EXPECT_NEAR(smallest_width(octahedron), 2 / std::sqrt(3), 1e-12);
    EXPECT_EQ(volume(hull_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})), 0);
}

TEST(ShapeDesc, AHullIsAsWideAsTheNarrowestWayToHoldIt) {
    Random random(5);
    for (int i = 0; i < 40; ++i) {
        std::vector<glm::dvec3> points;
        const auto count = 4 + random.next_index(20);
        for (std::uint32_t k = 0; k < count; ++k)
            points.push_back(random_direction(random) * glm::dvec3(1, 2, random.next_in(0.5, 1)));
        const double width = smallest_width(hull_of(points));
        double narrowest = std::numeric_limits<double>::infinity();
        glm::dvec3 best{0};
        for (int d = 0; d < 5000; ++d) {
            const glm::dvec3 direction = random_direction(random);
            if (const double extent = extent_along(points, direction); extent < narrowest) {
                narrowest = extent;
                best = direction;
            }
        }
        // Then a random descent.
        for (double step = 0.05; step > 1e-7; step *= 0.99) {
            const glm::dvec3 near = glm::normalize(best + step * random_direction(random));
            if (const double extent = extent_along(points, near); extent < narrowest) {
                narrowest = extent;
                best = near;
            }
        }
        EXPECT_LE(width, narrowest + 1e-9);
        EXPECT_GE(width, 0.97 * narrowest);
    }
}

// Enough points on its surface that their AABB is nearly the shape's.
TEST(ShapeDesc, ATurnedCylinderFillsItsBounds) {
    Random random(6);
    const CylinderDesc cylinder{0.75, 0.5};
    for (int i = 0; i < 50; ++i) {
        const glm::dquat turn = glm::angleAxis(random.next_in(-pi, pi), random_direction(random));
        const glm::dvec3 at = 3.0 * random_direction(random);
        const BoundsDesc box = bounds(cylinder, at, turn);
        BoundsDesc seen{glm::dvec3(1e9), glm::dvec3(-1e9)};
        for (int k = 0; k < 4000; ++k) {
            const double angle = 2 * pi * k / 2000;
            const glm::dvec3 rim(0.5 * std::cos(angle), k < 2000 ? 0.75 : -0.75,
                                 0.5 * std::sin(angle));
            seen.min = glm::min(seen.min, at + turn * rim);
            seen.max = glm::max(seen.max, at + turn * rim);
        }
        EXPECT_LT(glm::length(box.min - seen.min), 1e-5);
        EXPECT_LT(glm::length(box.max - seen.max), 1e-5);
    }
}

TEST(ShapeDesc, AreSummedUpInAFewWords) {
    EXPECT_EQ(summary(SphereDesc{0.5}), "sphere, radius 0.5 m");
    EXPECT_EQ(summary(BoxDesc{{0.5, 1, 0.1}}), "box, 1 × 2 × 0.2 m");
    EXPECT_EQ(summary(CapsuleDesc{0.5, 0.2}), "capsule, half height 0.5 m, radius 0.2 m");
    EXPECT_EQ(summary(PlaneDesc{}), "plane");
    HeightFieldDesc field;
    field.rows = 2;
    field.columns = 3;
    field.hills.reset();
    EXPECT_EQ(summary(field), "height field of 2 × 3, spacing 1 m, sides one");
    HullDesc hull;
    hull.points = std::make_shared<std::vector<glm::dvec3>>(8);
    EXPECT_EQ(summary(hull), "hull of 8 points");
}

TEST(ShapeDesc, ABodysBoundsHoldAllOfItsShapes) {
    BodyDesc body;
    body.position = {10, 0, 0};
    body.orientation = glm::angleAxis(pi / 2, glm::dvec3(0, 0, 1)); // x becomes y
    body.colliders.emplace_back().shape = SphereDesc{1};
    ColliderDesc &box = body.colliders.emplace_back();
    box.shape = BoxDesc{{0.5, 0.25, 0.125}};
    box.position = {4, 0, 0};
    const BoundsDesc around = bounds(body);
    EXPECT_LT(glm::distance(around.min, glm::dvec3(9, -1, -1)), 1e-12);
    EXPECT_LT(glm::distance(around.max, glm::dvec3(11, 4.5, 1)), 1e-12);
    EXPECT_EQ(smallest_width(body), 0.25);
    EXPECT_FALSE(has_plane(body));
    body.colliders.emplace_back().shape = PlaneDesc{};
    EXPECT_TRUE(has_plane(body));
}

} // namespace
} // namespace plumb
