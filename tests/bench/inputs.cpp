#include "tests/bench/inputs.h"

#include "engine/geometry/quickhull.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inputs {

namespace {

float real(Random &random, double low, double high) {
    return static_cast<float>(random.next_in(low, high));
}

} // namespace

Vec3 vector(Random &random, double reach) {
    const float x = real(random, -reach, reach);
    const float y = real(random, -reach, reach);
    const float z = real(random, -reach, reach);
    return {x, y, z};
}

Quat rotation(Random &random) {
    Quat q = identity_rotation;
    do {
        const Vec3 v = vector(random, 1);
        q = Quat{real(random, -1, 1), v.x, v.y, v.z};
    } while (glm::dot(q, q) < 0.01f);
    return glm::normalize(q);
}

Sphere sphere(Random &random, double reach) {
    return {vector(random, reach), real(random, 0.3, 0.9)};
}

Aabb aabb(Random &random, double reach) {
    const Vec3 center = vector(random, reach);
    const Vec3 half = 0.2f + glm::abs(vector(random, 0.6));
    return {center - half, center + half};
}

Box box(Random &random, double reach) {
    return {vector(random, reach), rotation(random), 0.2f + glm::abs(vector(random, 0.6))};
}

Capsule capsule(Random &random, double reach) {
    const Vec3 center = vector(random, reach), axis = vector(random, 0.7);
    return {center - axis, center + axis, real(random, 0.2, 0.5)};
}

Cylinder cylinder(Random &random, double reach) {
    const Vec3 center = vector(random, reach), axis = vector(random, 0.7) + Vec3{0, 0.01f, 0};
    return {center - axis, center + axis, real(random, 0.2, 0.6)};
}

Triangle triangle(Random &random, double reach) {
    const Vec3 a = vector(random, reach);
    return {a, a + vector(random, 1.2), a + vector(random, 1.2)};
}

const HullMesh &rock() {
    static const HullMesh mesh = [] {
        Random random(7);
        std::vector<Vec3> points;
        while (points.size() < 32) {
            const Vec3 p = vector(random, 1);
            if (glm::dot(p, p) > 0.01f)
                points.push_back(0.7f * glm::normalize(p));
        }
        return *convex_hull(points, 64).mesh;
    }();
    return mesh;
}

ConvexHull hull(Random &random, double reach) {
    return {&rock(), vector(random, reach), rotation(random)};
}

Ray ray(Random &random) {
    Vec3 direction{0};
    do
        direction = vector(random, 1);
    while (glm::dot(direction, direction) < 0.01f);
    direction = glm::normalize(direction);
    return {vector(random, 0.9) - 4.0f * direction, direction, 8.0f};
}

} // namespace plumb::inputs
