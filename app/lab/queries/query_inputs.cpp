#include "app/lab/queries/query_inputs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb {

const std::vector<std::string> &lattice_families() {
    static const std::vector<std::string> families{
        "on faces, edges and corners", // small numbers, so coincidences are common
        "anywhere", "far from the origin",
        "tiny and huge", // 2^-10 to 2^16 m
    };
    return families;
}

oracle::Int whole(Random &random, oracle::Int reach) {
    return static_cast<oracle::Int>(random.next_index(static_cast<std::uint32_t>(2 * reach + 1))) -
           reach;
}

Lattice any_lattice(Random &random, std::uint8_t &family) {
    family = static_cast<std::uint8_t>(random.next_index(4));
    Lattice lattice;
    switch (family) {
    case 0:
        lattice.spread = 2 + random.next_index(3);
        break;
    case 1:
        lattice.spread = 500;
        break;
    case 2:
        lattice.offset = {whole(random, 8000), whole(random, 8000), whole(random, 8000)};
        break;
    default:
        lattice.unit = std::ldexp(1.0f, static_cast<int>(random.next_index(27)) - 10);
        break;
    }
    return lattice;
}

oracle::Point any_point(Random &random, const Lattice &lattice) {
    return lattice.offset + oracle::Point{whole(random, lattice.spread),
                                          whole(random, lattice.spread),
                                          whole(random, lattice.spread)};
}

oracle::Point any_direction(Random &random, oracle::Int spread) {
    oracle::Point d;
    do {
        d = {whole(random, spread), whole(random, spread), whole(random, spread)};
        if (random.next_index(3) == 0)
            d.x = 0;
        if (random.next_index(3) == 0)
            d.y = 0;
        if (random.next_index(3) == 0)
            d.z = 0;
    } while (d == oracle::Point{});
    return d;
}

oracle::Block any_block(Random &random, const Lattice &lattice) {
    const oracle::Point p = any_point(random, lattice);
    const oracle::Point q = any_point(random, lattice);
    return {{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
            {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
}

oracle::Ball any_ball(Random &random, const Lattice &lattice) {
    return {any_point(random, lattice), static_cast<oracle::Int>(random.next_index(
                                            static_cast<std::uint32_t>(2 * lattice.spread + 1)))};
}

oracle::Corners any_corners(Random &random, const Lattice &lattice) {
    oracle::Corners corners{any_point(random, lattice), any_point(random, lattice),
                            any_point(random, lattice)};
    if (random.next_index(8) == 0)
        corners[2] = random.next_index(2) == 0 ? corners[0] : corners[1];
    for (oracle::Point &corner : corners)
        corner = {corner.x & ~oracle::Int{1}, corner.y & ~oracle::Int{1},
                  corner.z & ~oracle::Int{1}};
    return corners;
}

oracle::Point any_place(Random &random, const oracle::Block &block) {
    const auto one = [&](oracle::Int low, oracle::Int high) {
        switch (random.next_index(3)) {
        case 0:
            return low;
        case 1:
            return high;
        default:
            return low + static_cast<oracle::Int>(
                             random.next_index(static_cast<std::uint32_t>(high - low + 1)));
        }
    };
    const oracle::Int x = one(block.min.x, block.max.x), y = one(block.min.y, block.max.y);
    return {x, y, one(block.min.z, block.max.z)};
}

oracle::Point any_place(Random &random, const oracle::Ball &ball) {
    const oracle::Int r = random.next_index(2) == 0 ? ball.radius : -ball.radius;
    const oracle::Point reach[] = {{r, 0, 0}, {0, r, 0}, {0, 0, r}, {}};
    return ball.center + reach[random.next_index(4)];
}

oracle::Point any_place(Random &random, const oracle::Corners &triangle) {
    const oracle::Point &a = triangle[random.next_index(3)];
    const oracle::Point &b = triangle[random.next_index(3)];
    const auto middle = [](oracle::Int p, oracle::Int q) { return (p + q) / 2; };
    return {middle(a.x, b.x), middle(a.y, b.y), middle(a.z, b.z)};
}

oracle::Line any_segment(Random &random, const Lattice &lattice) {
    const oracle::Point origin = any_point(random, lattice);
    if (random.next_index(8) == 0)
        return {origin, {}, true};
    return {origin, any_direction(random, lattice.spread), true};
}

Ray real_ray(Random &random, const oracle::Line &line, const Lattice &lattice) {
    Vec3 direction = lattice.real(line.along) / lattice.unit *
                     std::ldexp(1.0f, static_cast<int>(random.next_index(41)) - 20);
    for (int i = 0; i < 3; ++i)
        if (direction[i] == 0 && random.next_index(2) == 0)
            direction[i] = -0.0f;
    return {lattice.real(line.origin), direction};
}

Segment real_segment(const oracle::Line &line, const Lattice &lattice) {
    return {lattice.real(line.origin), lattice.real(line.origin + line.along)};
}

Aabb real_aabb(const oracle::Block &block, const Lattice &lattice) {
    return {lattice.real(block.min), lattice.real(block.max)};
}

Sphere real_sphere(const oracle::Ball &ball, const Lattice &lattice) {
    return {lattice.real(ball.center), static_cast<float>(ball.radius) * lattice.unit};
}

Triangle real_triangle(const oracle::Corners &corners, const Lattice &lattice) {
    return {lattice.real(corners[0]), lattice.real(corners[1]), lattice.real(corners[2])};
}

Box real_box(const oracle::Block &block, const Lattice &lattice) {
    return {0.5f * lattice.real(block.min + block.max), identity_rotation,
            0.5f * lattice.real(block.max - block.min)};
}

Vec3 any_vector(Random &random, double reach) {
    const auto x = static_cast<float>(random.next_in(-reach, reach));
    const auto y = static_cast<float>(random.next_in(-reach, reach));
    const auto z = static_cast<float>(random.next_in(-reach, reach));
    return {x, y, z};
}

Vec3 any_half(Random &random) {
    return 0.1f + glm::abs(any_vector(random, 1));
}

Quat any_rotation(Random &random) {
    Quat q = identity_rotation;
    do {
        const Vec3 v = any_vector(random, 1);
        q = Quat{static_cast<float>(random.next_in(-1, 1)), v.x, v.y, v.z};
    } while (glm::dot(q, q) < 0.01f);
    return glm::normalize(q);
}

Box any_box(Random &random, double reach) {
    return {any_vector(random, reach), any_rotation(random), any_half(random)};
}

Ray timed_ray(Random &random) {
    const Vec3 origin = any_vector(random, 4);
    return {origin, any_vector(random, 1.6) - origin};
}

Triangle timed_triangle(Random &random, double reach) {
    const Vec3 a = any_vector(random, reach);
    return {a, a + any_vector(random, 1.5), a + any_vector(random, 1.5)};
}

Aabb timed_aabb(Random &random, double reach) {
    const Vec3 center = any_vector(random, reach), half = any_half(random);
    return {center - half, center + half};
}

} // namespace plumb
