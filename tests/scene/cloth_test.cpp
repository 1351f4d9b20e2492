// How many springs a cloth has, how long they are, and that it is symmetric.
#include "engine/scene/cloth.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

using Kind = ClothSpring::Kind;

ClothDesc grid(int nx, int nz, double x, double z) {
    ClothDesc cloth;
    cloth.name = "sheet";
    cloth.cells = {nx, nz};
    cloth.size = {x, z};
    return cloth;
}

long count(const ClothParts &parts, Kind kind) {
    return std::ranges::count(parts.springs, kind, &ClothSpring::kind);
}

TEST(Cloth, GridHasTheSpringsOfItsCells) {
    for (const auto &[nx, nz] : {std::pair{1, 1}, {1, 4}, {3, 2}, {7, 5}}) {
        const ClothParts parts = cloth_parts(grid(nx, nz, 3, 2));
        EXPECT_EQ(parts.places.size(), static_cast<std::size_t>((nx + 1) * (nz + 1)));
        EXPECT_EQ(particle_count(grid(nx, nz, 3, 2)), parts.places.size());
        EXPECT_EQ(count(parts, Kind::stretch), nx * (nz + 1) + nz * (nx + 1));
        EXPECT_EQ(count(parts, Kind::shear), 2 * nx * nz);
        EXPECT_EQ(count(parts, Kind::bend), (nx - 1) * (nz + 1) + (nz - 1) * (nx + 1));
        EXPECT_EQ(parts.triangles.size(), static_cast<std::size_t>(2 * nx * nz));
    }
}

TEST(Cloth, SpringsOfAGridAreAsLongAsTheirCells) {
    const ClothParts parts = cloth_parts(grid(4, 5, 2, 1));
    const double dx = 2.0 / 4;
    const double dz = 1.0 / 5;
    for (const ClothSpring &spring : parts.springs) {
        const glm::dvec3 way = parts.places[spring.b] - parts.places[spring.a];
        EXPECT_NEAR(spring.rest_length, glm::length(way), 1e-15);
        const double along_x = std::abs(way.x) / dx; // in cells
        const double along_z = std::abs(way.z) / dz;
        const std::pair cells{std::lround(along_x), std::lround(along_z)};
        EXPECT_NEAR(along_x, static_cast<double>(cells.first), 1e-12);
        EXPECT_NEAR(along_z, static_cast<double>(cells.second), 1e-12);
        if (spring.kind == Kind::stretch)
            EXPECT_EQ(cells.first + cells.second, 1);
        else if (spring.kind == Kind::shear)
            EXPECT_EQ(cells, (std::pair{1L, 1L}));
        else
            EXPECT_TRUE((cells == std::pair{2L, 0L}) || (cells == std::pair{0L, 2L}));
    }
}

// Mirrored along x or z, or, for a square one, with x and z swapped, it has the same springs.
TEST(Cloth, GridIsSymmetric) {
    const int n = 6;
    const ClothParts parts = cloth_parts(grid(n, n, 2, 2));
    using Spring = std::tuple<Kind, std::uint32_t, std::uint32_t>;
    std::set<Spring> springs;
    for (const ClothSpring &spring : parts.springs)
        EXPECT_TRUE(springs.insert({spring.kind, spring.a, spring.b}).second);
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int mirror = 0; mirror < 3; ++mirror) {
        const auto image = [&](std::uint32_t particle) {
            const int i = static_cast<int>(particle) % (n + 1);
            const int j = static_cast<int>(particle) / (n + 1);
            return mirror == 0 ? index(n - i, j) : mirror == 1 ? index(i, n - j) : index(j, i);
        };
        for (const auto &[kind, a, b] : springs) {
            const std::uint32_t at_a = image(a);
            const std::uint32_t at_b = image(b);
            EXPECT_TRUE(springs.contains({kind, std::min(at_a, at_b), std::max(at_a, at_b)}))
                << a << " " << b;
        }
        for (std::uint32_t i = 0; i < parts.places.size(); ++i) {
            const glm::dvec3 &p = parts.places[i];
            const glm::dvec3 &q = parts.places[image(i)];
            EXPECT_EQ(q, mirror == 0   ? glm::dvec3(-p.x, 0, p.z)
                         : mirror == 1 ? glm::dvec3(p.x, 0, -p.z)
                                       : glm::dvec3(p.z, 0, p.x));
        }
    }
}

// Seen from above the triangles cover the sheet once, and their sides are the springs between their
// corners.
TEST(Cloth, TrianglesCoverTheSheet) {
    const ClothParts parts = cloth_parts(grid(5, 3, 2, 1.5));
    double area = 0;
    for (const ClothTriangle &triangle : parts.triangles) {
        const auto at = [&](std::size_t k) { return parts.places[triangle.corners[k % 3]]; };
        const glm::dvec3 across = glm::cross(at(1) - at(0), at(2) - at(0));
        EXPECT_GT(across.y, 0);
        area += 0.5 * across.y;
        for (std::size_t k = 0; k < 3; ++k) {
            const ClothSpring &side = parts.springs.at(triangle.sides[k]);
            const auto [low, high] =
                std::minmax(triangle.corners[k], triangle.corners[(k + 1) % 3]);
            EXPECT_EQ(side.a, low);
            EXPECT_EQ(side.b, high);
            EXPECT_NE(side.kind, Kind::bend);
        }
    }
    EXPECT_NEAR(area, 2 * 1.5, 1e-12);
}

// An octahedron: 6 corners, 12 edges, and across each edge a pair of opposite corners: 3 pairs in
// all, on the axes.
TEST(Cloth, MeshHasItsEdgesAndWhatBendsAcrossThem) {
    MeshData mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            glm::dvec3 corner(0);
            corner[axis] = side;
            mesh.vertices.push_back(corner);
        }
    for (const std::uint32_t x : {0U, 1U})
        for (const std::uint32_t y : {2U, 3U})
            for (const std::uint32_t z : {4U, 5U})
                mesh.triangles.push_back((x + y + z) % 2 == 0 ? std::array{x, y, z}
                                                              : std::array{x, z, y});
    ClothDesc cloth;
    cloth.mesh = std::make_shared<const MeshData>(mesh);
    const ClothParts parts = cloth_parts(cloth);
    EXPECT_EQ(parts.places.size(), 6U);
    EXPECT_EQ(parts.triangles.size(), 8U);
    EXPECT_EQ(count(parts, Kind::stretch), 12);
    EXPECT_EQ(count(parts, Kind::bend), 3);
    for (const ClothSpring &spring : parts.springs)
        EXPECT_NEAR(spring.rest_length, spring.kind == Kind::bend ? 2 : std::sqrt(2.0), 1e-15);
}

TEST(Cloth, ParticlesAreFoundByTheirNames) {
    ClothDesc cloth = grid(3, 2, 1, 1);
    for (std::uint32_t i = 0; i < particle_count(cloth); ++i) {
        const std::string name = particle_name(cloth, i);
        EXPECT_EQ(find_particle(cloth, name.substr(name.find('['))), i);
    }
    EXPECT_EQ(particle_name(cloth, 6), "sheet[2,1]");
    EXPECT_EQ(find_particle(cloth, "[ 3, 2]"), 11U);
    for (const char *wrong : {"[4,0]", "[0,3]", "[-1,0]", "[1]", "[1,1,1]", "[]", "[1,1", "1,1]",
                              "", "[", "[1,]", "[99999999999,0]"})
        EXPECT_FALSE(find_particle(cloth, wrong)) << wrong;
    cloth.mesh =
        std::make_shared<const MeshData>(MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_EQ(particle_name(cloth, 2), "sheet[2]");
    EXPECT_EQ(find_particle(cloth, "[2]"), 2U);
    EXPECT_FALSE(find_particle(cloth, "[3]"));
    EXPECT_FALSE(find_particle(cloth, "[0,0]"));
}

} // namespace
} // namespace plumb
