#include "engine/geometry/mass.h"

#include "engine/core/check.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/constants.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Real volume_of(const Sphere &sphere) {
    return Real(4) / Real(3) * pi * sphere.radius * sphere.radius * sphere.radius;
}

Real volume_of(const Box &box) {
    return Real(8) * box.half_extents.x * box.half_extents.y * box.half_extents.z;
}

Real volume_of(const Capsule &capsule) {
    const Real length = glm::length(capsule.b - capsule.a);
    return pi * capsule.radius * capsule.radius * (length + Real(4) / Real(3) * capsule.radius);
}

Real volume_of(const HalfSpace &) {
    return std::numeric_limits<Real>::infinity();
}

Real volume_of(const Cylinder &cylinder) {
    return pi * cylinder.radius * cylinder.radius * glm::length(cylinder.b - cylinder.a);
}

Real volume_of(const ConvexHull &hull) {
    return hull.mesh->volume;
}

void check_mass(Real mass) {
    PLUMB_CHECK(mass >= Real(0) && std::isfinite(mass),
                "mass must be finite and not negative, got " << mass);
}

Vec3 inertia_of(const Sphere &sphere, Real mass) {
    return Vec3{Real(0.4) * mass * sphere.radius * sphere.radius};
}

Vec3 inertia_of(const Box &box, Real mass) {
    const Vec3 squared = box.half_extents * box.half_extents;
    return mass / Real(3) *
           Vec3{squared.y + squared.z, squared.z + squared.x, squared.x + squared.y};
}

Vec3 inertia_of(const Capsule &capsule, Real mass) {
    const Real r = capsule.radius;
    const Real length = glm::length(capsule.b - capsule.a);
    const Real equivalent = length + Real(4) / Real(3) * r; // volume / (pi r^2)
    if (equivalent <= Real(0))
        return Vec3{Real(0)}; // a point
    const Real cylinder = mass * (length / equivalent);
    const Real caps = mass - cylinder; // both hemispheres

    // A cylinder, and two hemispheres whose centres of mass lie 3/8 r beyond its ends. About the
    // middle, by the parallel axis theorem, per unit mass of the caps:
    //   (2/5 r^2 - (3/8 r)^2) + (L/2 + 3/8 r)^2 = 2/5 r^2 + L^2/4 + 3/8 L r.
    const Real along = cylinder * r * r / Real(2) + caps * Real(0.4) * r * r;
    const Real across =
        cylinder * (length * length / Real(12) + r * r / Real(4)) +
        caps * (Real(0.4) * r * r + length * length / Real(4) + Real(0.375) * length * r);
    return {across, along, across};
}

Vec3 inertia_of(const Cylinder &cylinder, Real mass) {
    const Vec3 along = cylinder.b - cylinder.a;
    const Real squared = cylinder.radius * cylinder.radius;
    const Real across = mass * (squared / Real(4) + glm::dot(along, along) / Real(12));
    return {across, mass * squared / Real(2), across};
}

Vec3 inertia_of(const HalfSpace &half_space, Real mass) {
    PLUMB_CHECK(false, "a half-space has no inertia; its offset is "
                           << half_space.offset << " and the given mass " << mass);
}

Vec3 inertia_of(const ConvexHull &hull, Real mass) {
    return principal_frame(inertia(hull, mass)).moments;
}

// R I R^T.
Mat3 turned_inertia(const Mat3 &inertia, const Quat &rotation) {
    const Mat3 r = glm::mat3_cast(rotation);
    return r * inertia * glm::transpose(r);
}

// The inertia of a solid of revolution about the unit vector `axis`.
Mat3 inertia_about(const Vec3 &axis, Real along, Real across) {
    return Mat3{across} + (along - across) * glm::outerProduct(axis, axis);
}

MassProperties mass_properties_of(const Sphere &sphere) {
    const Real v = volume_of(sphere);
    return {v, sphere.center, Mat3{inertia_of(sphere, v).x}};
}

MassProperties mass_properties_of(const Box &box) {
    const Real v = volume_of(box);
    const Vec3 moments = inertia_of(box, v);
    Mat3 local{Real(0)};
    for (int i = 0; i < 3; ++i)
        local[i][i] = moments[i];
    return {v, box.center, turned_inertia(local, box.rotation)};
}

// A capsule or a cylinder.
template <typename Round> MassProperties round_mass_properties(const Round &shape) {
    const Real v = volume_of(shape);
    const Vec3 moments = inertia_of(shape, v);
    const Vec3 along = shape.b - shape.a;
    const Real length = glm::length(along);
    const Vec3 axis = length > Real(0) ? along / length : Vec3{Real(0), Real(1), Real(0)};
    return {v, Real(0.5) * (shape.a + shape.b), inertia_about(axis, moments.y, moments.x)};
}

MassProperties mass_properties_of(const Capsule &capsule) {
    return round_mass_properties(capsule);
}

MassProperties mass_properties_of(const Cylinder &cylinder) {
    return round_mass_properties(cylinder);
}

MassProperties mass_properties_of(const ConvexHull &hull) {
    return {hull.mesh->volume, hull.position + hull.rotation * hull.mesh->center,
            turned_inertia(hull.mesh->inertia, hull.rotation)};
}

MassProperties mass_properties_of(const HalfSpace &half_space) {
    PLUMB_CHECK(false, "a half-space has no mass; its offset is " << half_space.offset);
}

} // namespace

MassProperties mass_properties(const Shape &shape) {
    check_valid(shape);
    return std::visit([](const auto &solid) { return mass_properties_of(solid); }, shape);
}

Real volume(const Shape &shape) {
    check_valid(shape);
    return std::visit([](const auto &solid) { return volume_of(solid); }, shape);
}

Real volume(const Cylinder &cylinder) {
    check_valid(cylinder);
    return volume_of(cylinder);
}

Real volume(const ConvexHull &hull) {
    check_valid(hull);
    return hull.mesh->volume;
}

Vec3 principal_inertia(const Shape &shape, Real mass) {
    check_mass(mass);
    check_valid(shape);
    return std::visit([&](const auto &solid) { return inertia_of(solid, mass); }, shape);
}

Vec3 principal_inertia(const Cylinder &cylinder, Real mass) {
    check_mass(mass);
    check_valid(cylinder);
    return inertia_of(cylinder, mass);
}

Mat3 inertia(const ConvexHull &hull, Real mass) {
    check_mass(mass);
    check_valid(hull);
    return (mass / hull.mesh->volume) * hull.mesh->inertia;
}

// Jacobi's method (Golub, Van Loan 2013, "Matrix Computations", 8.5): rotates in one coordinate
// plane after the other until the matrix is diagonal. Four rounds are usually enough for a 3 x 3
// matrix of doubles; eight are allowed.
PrincipalFrame principal_frame(const Mat3 &inertia) {
    glm::dmat3 m(inertia);
    PLUMB_CHECK(std::isfinite(m[0][0] + m[1][0] + m[2][0] + m[1][1] + m[2][1] + m[2][2]),
                "inertia must be finite, got diagonal (" << m[0][0] << ", " << m[1][1] << ", "
                                                         << m[2][2] << ')');
    glm::dmat3 axes(1.0);
    for (int round = 0; round < 8; ++round)
        for (const auto &[p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
            const double off = m[q][p];
            if (off == 0.0)
                continue;
            const double theta = (m[q][q] - m[p][p]) / (2.0 * off);
            const double t =
                (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0);
            glm::dmat3 turn(1.0);
            turn[p][p] = turn[q][q] = c;
            turn[q][p] = t * c;
            turn[p][q] = -t * c;
            m = glm::transpose(turn) * m * turn;
            axes = axes * turn;
        }
    for (const auto &[i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}})
        if (m[i][i] > m[j][j]) {
            std::swap(m[i][i], m[j][j]);
            std::swap(axes[i], axes[j]);
        }
    if (glm::determinant(axes) < 0.0)
        axes[2] = -axes[2];
    PrincipalFrame frame;
    frame.moments = Vec3(Real(m[0][0]), Real(m[1][1]), Real(m[2][2]));
    frame.rotation = Quat(glm::normalize(glm::quat_cast(axes)));
    return frame;
}

// Sums over signed tetrahedra from one point to the triangles. For edges a, b, c from that point:
// volume v = a . (b x c) / 6, first moment v (a + b + c) / 4, second moments v / 20 (s s^T + a a^T
// + b b^T + c c^T) with s = a + b + c (Tonon 2004, "Explicit exact formulas for the 3-D tetrahedron
// inertia tensor").
MassProperties mass_properties(std::span<const Triangle> surface) {
    using Wide = glm::dvec3;
    Wide base{0.0};
    for (const Triangle &triangle : surface) {
        check_valid(triangle);
        base += (Wide(triangle.a) + Wide(triangle.b) + Wide(triangle.c)) /
                (3.0 * double(surface.size()));
    }
    double six_volumes = 0.0;
    Wide first{0.0};
    glm::dmat3 second(0.0);
    for (const Triangle &triangle : surface) {
        const Wide a = Wide(triangle.a) - base;
        const Wide b = Wide(triangle.b) - base;
        const Wide c = Wide(triangle.c) - base;
        const Wide sum = a + b + c;
        const double v = glm::dot(a, glm::cross(b, c));
        six_volumes += v;
        first += v * sum;
        second += v * (glm::outerProduct(sum, sum) + glm::outerProduct(a, a) +
                       glm::outerProduct(b, b) + glm::outerProduct(c, c));
    }
    MassProperties mass;
    if (six_volumes == 0.0)
        return mass;
    const Wide center = first / (4.0 * six_volumes);
    mass.volume = Real(six_volumes / 6.0);
    mass.center = Vec3(base + center);
    // Moments about the centre: the moments about the base minus the parallel axis term.
    second = second / 120.0 - (six_volumes / 6.0) * glm::outerProduct(center, center);
    const double trace = second[0][0] + second[1][1] + second[2][2];
    mass.inertia = Mat3(glm::dmat3(trace) - second);
    return mass;
}

} // namespace plumb::inline PLUMB_PRECISION
