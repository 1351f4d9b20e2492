#include "app/render/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/check.h"

namespace plumb {

Mesh box_mesh() {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 normal{0};
            normal[axis] = side;
            glm::vec3 u{0};
            u[(axis + 1) % 3] = 1;
            const glm::vec3 v = glm::cross(normal, u);
            const auto first = static_cast<std::uint16_t>(mesh.vertices.size());
            for (const glm::vec3 &corner : {-u - v, u - v, u + v, -u + v})
                mesh.vertices.push_back({normal + corner, normal, 0});
            for (const int i : {0, 1, 2, 0, 2, 3})
                mesh.indices.push_back(static_cast<std::uint16_t>(first + i));
        }
    }
    return mesh;
}

Mesh sphere_mesh(int splits) {
    PLUMB_CHECK(splits >= 0 && splits <= 5, "a sphere can be split 0 to 5 times, not " << splits);
    const float g = std::numbers::phi_v<float>;
    std::vector<glm::vec3> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                  {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                  {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (glm::vec3 &point : points)
        point = glm::normalize(point);
    std::vector<std::uint16_t> faces{0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                     1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                     3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                     4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
    for (int split = 0; split < splits; ++split) {
        std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint16_t> middles;
        const auto middle = [&](std::uint16_t a, std::uint16_t b) {
            const auto [entry, fresh] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint16_t>(points.size()));
            if (fresh)
                points.push_back(glm::normalize(points[a] + points[b]));
            return entry->second;
        };
        std::vector<std::uint16_t> finer;
        for (std::size_t i = 0; i < faces.size(); i += 3) {
            const std::uint16_t a = faces[i];
            const std::uint16_t b = faces[i + 1];
            const std::uint16_t c = faces[i + 2];
            const std::uint16_t ab = middle(a, b);
            const std::uint16_t bc = middle(b, c);
            const std::uint16_t ca = middle(c, a);
            finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        faces = std::move(finer);
    }
    Mesh mesh;
    mesh.indices = std::move(faces);
    for (const glm::vec3 &point : points)
        mesh.vertices.push_back({point, point, 0});
    return mesh;
}

Mesh capsule_mesh(int segments, int rings) {
    PLUMB_CHECK(segments >= 3 && rings >= 1 && (2 * rings + 2) * (segments + 1) < 65536,
                "no capsule with " << segments << " segments and " << rings << " rings");
    Mesh mesh;
    const float quarter = std::numbers::pi_v<float> / 2;
    // From the lower pole up; the equator appears twice, once for each end.
    for (const float end : {-1.0f, 1.0f}) {
        for (int ring = 0; ring <= rings; ++ring) {
            const float up = static_cast<float>(end < 0 ? ring - rings : ring) /
                             static_cast<float>(rings) * quarter;
            for (int segment = 0; segment <= segments; ++segment) {
                const float around =
                    4 * quarter * static_cast<float>(segment) / static_cast<float>(segments);
                const glm::vec3 point{std::cos(up) * std::sin(around), std::sin(up),
                                      std::cos(up) * std::cos(around)};
                mesh.vertices.push_back({point, point, end});
            }
        }
    }
    for (int row = 0; row + 1 < 2 * (rings + 1); ++row) {
        for (int segment = 0; segment < segments; ++segment) {
            const int a = row * (segments + 1) + segment;
            const int b = a + segments + 1;
            for (const int i : {a, a + 1, b + 1, a, b + 1, b})
                mesh.indices.push_back(static_cast<std::uint16_t>(i));
        }
    }
    return mesh;
}

Mesh cylinder_mesh(int segments) {
    PLUMB_CHECK(segments >= 3 && 4 * segments + 6 < 65536,
                "no cylinder with " << segments << " segments");
    Mesh mesh;
    const auto rim = [&](int segment) {
        const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(segment) /
                             static_cast<float>(segments);
        return glm::vec3(std::sin(around), 0, std::cos(around));
    };
    const auto add = [&](std::initializer_list<std::size_t> corners) {
        for (const std::size_t corner : corners)
            mesh.indices.push_back(static_cast<std::uint16_t>(corner));
    };
    for (const float end : {-1.0f, 1.0f})
        for (int segment = 0; segment <= segments; ++segment)
            mesh.vertices.push_back({rim(segment), rim(segment), end});
    const std::size_t row = static_cast<std::size_t>(segments) + 1;
    for (std::size_t a = 0; a + 1 < row; ++a)
        add({a, a + 1, a + row + 1, a, a + row + 1, a + row});
    for (const float end : {-1.0f, 1.0f}) {
        const std::size_t middle = mesh.vertices.size();
        mesh.vertices.push_back({{0, 0, 0}, {0, end, 0}, end});
        for (int segment = 0; segment <= segments; ++segment)
            mesh.vertices.push_back({rim(segment), {0, end, 0}, end});
        for (std::size_t a = middle + 1; a + 1 <= middle + row; ++a)
            if (end > 0)
                add({middle, a, a + 1});
            else
                add({middle, a + 1, a});
    }
    return mesh;
}

} // namespace plumb
