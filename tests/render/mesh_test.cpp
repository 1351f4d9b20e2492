#include "app/render/mesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace plumb {
namespace {

glm::vec3 corner(const Mesh &mesh, std::size_t i, float half_height) {
    const MeshVertex &vertex = mesh.vertices[mesh.indices[i]];
    return vertex.position + glm::vec3(0, vertex.end * half_height, 0);
}

// By the divergence theorem; positive only if the faces look outward.
double volume(const Mesh &mesh, float half_height = 0) {
    double six = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(corner(mesh, i, half_height));
        const glm::dvec3 b(corner(mesh, i + 1, half_height));
        const glm::dvec3 c(corner(mesh, i + 2, half_height));
        six += glm::dot(a, glm::cross(b, c));
    }
    return six / 6;
}

// Each directed edge is matched by its opposite, equally often; zero-length edges do not count.
bool closed(const Mesh &mesh, float half_height) {
    using Point = std::tuple<long, long, long>;
    const auto point = [](const glm::vec3 &p) {
        return Point{std::lround(p.x * 1e5f), std::lround(p.y * 1e5f), std::lround(p.z * 1e5f)};
    };
    std::map<std::pair<Point, Point>, int> balance;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Point a = point(corner(mesh, i + k, half_height));
            const Point b = point(corner(mesh, i + (k + 1) % 3, half_height));
            if (a < b)
                ++balance[{a, b}];
            else if (b < a)
                --balance[{b, a}];
        }
    }
    for (const auto &[edge, count] : balance)
        if (count != 0)
            return false;
    return true;
}

TEST(Mesh, BoxIsClosedAndHasItsVolume) {
    EXPECT_NEAR(volume(box_mesh()), 8, 1e-6);
    EXPECT_TRUE(closed(box_mesh(), 0));
}

TEST(Mesh, SpheresAreClosedAndApproachTheirVolumeFromBelow) {
    const double exact = 4 * std::numbers::pi / 3;
    double missing = exact;
    for (int splits = 0; splits <= 5; ++splits) {
        const Mesh mesh = sphere_mesh(splits);
        EXPECT_TRUE(closed(mesh, 0));
        EXPECT_EQ(mesh.indices.size(), 60u << (2 * splits));
        const double now = exact - volume(mesh);
        EXPECT_GT(now, 0);
        // Each split halves the edges, and the gap shrinks with their square.
        EXPECT_LT(now, missing / 2.5);
        missing = now;
    }
}

TEST(Mesh, CapsuleStretchesToAnyHeight) {
    const Mesh mesh = capsule_mesh(64, 16);
    const double round = volume(mesh, 0);
    EXPECT_NEAR(round, 4 * std::numbers::pi / 3, 0.03);
    // The cross-section is a regular 64-gon.
    const double section = 32 * std::sin(2 * std::numbers::pi / 64);
    for (const float half_height : {0.0f, 0.3f, 4.0f}) {
        EXPECT_TRUE(closed(mesh, half_height));
        EXPECT_NEAR(volume(mesh, half_height),
                    round + 2 * static_cast<double>(half_height) * section, 1e-4);
    }
}

TEST(Mesh, CylinderStretchesToAnyHeight) {
    const Mesh mesh = cylinder_mesh(64);
    const double section = 32 * std::sin(2 * std::numbers::pi / 64);
    for (const float half_height : {0.3f, 4.0f}) {
        EXPECT_TRUE(closed(mesh, half_height));
        EXPECT_NEAR(volume(mesh, half_height), 2 * static_cast<double>(half_height) * section,
                    1e-4);
    }
}

TEST(Mesh, NormalsAreUnitAndPointOutward) {
    for (const Mesh &mesh : {box_mesh(), sphere_mesh(2), capsule_mesh(12, 3), cylinder_mesh(12)}) {
        for (const MeshVertex &vertex : mesh.vertices) {
            EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-5f);
            // With a height of 2, to tell the ends apart.
            const glm::vec3 place = vertex.position + glm::vec3(0, vertex.end, 0);
            EXPECT_GT(glm::dot(vertex.normal, place), 0);
        }
    }
}

} // namespace
} // namespace plumb
