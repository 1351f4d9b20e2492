// Exact signs of small determinants: which side of a line or a plane a point is on, never wrong.
//
// Each returns -1, 0 or +1, the sign of the exact value for the given coordinates. A rounded value
// is used if its error bound settles the sign; otherwise the sum is computed exactly, as an
// expansion of doubles (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast
// Robust Geometric Predicates"). No fused operations are needed.
//
// Range: in float, every finite value. In double, 0 and magnitudes of 1e-80 to 1e90 (for
// line_ball_sign, 1e-60 to 1e70); beyond, products of three (of four) overflow or underflow, and
// the sign may be wrong. NaN and infinity have no sign; the caller must reject them.
#pragma once

#include "engine/math/types.h"

#include <algorithm>
#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

namespace exact {

// Half an ulp of 1: the relative error of one operation on doubles.
inline constexpr double unit = 0x1p-53;

int cross_sign(const double (&u)[2][2], const double (&v)[2][2]);
int triple_sign(const double (&u)[3][2], const double (&v)[3][2], const double (&w)[3][2]);
int plane_sign(const double (&normal)[3], double offset, const double (&point)[3]);
int product_difference_sign(double a, double b, double c, double d);
int dot_sign(const double (&u)[3][2], const double (&v)[3][2]);
int ball_sign(double radius, const double (&m)[3][2]);
int line_ball_sign(double radius, const double (&m)[3][2], const double (&d)[3][2]);
glm::dvec3 cross(const double (&u)[3][2], const double (&v)[3][2]);

} // namespace exact

// a b - c d.
inline int product_difference_sign(Real a, Real b, Real c, Real d) {
    // Products of floats are exact in double. Rounding is monotonic, so double products that differ
    // after rounding differ the same way before it.
    const double ab = double(a) * double(b);
    const double cd = double(c) * double(d);
    if (ab != cd)
        return ab > cd ? 1 : -1;
    if constexpr (sizeof(Real) == sizeof(float))
        return 0;
    return exact::product_difference_sign(double(a), double(b), double(c), double(d));
}

// u x (b - a) in 2D: +1 when b - a points to the left of u.
inline int cross_sign(const Vec2 &u, const Vec2 &a, const Vec2 &b) {
    const double x = double(b.x) - double(a.x);
    const double y = double(b.y) - double(a.y);
    const double left = double(u.x) * y;
    const double right = double(u.y) * x;
    const double cross = left - right;
    // Shewchuk 1997, section 4.3, for orient2d; here one factor of each product is exact.
    const double bound =
        (3.0 + 16.0 * exact::unit) * exact::unit * (std::abs(left) + std::abs(right));
    if (cross > bound)
        return 1;
    if (cross < -bound)
        return -1;
    if (left == 0.0 && right == 0.0)
        return 0;
    return exact::cross_sign({{double(u.x), 0.0}, {double(u.y), 0.0}},
                             {{double(b.x), double(a.x)}, {double(b.y), double(a.y)}});
}

// (b - a) x (c - a): +1 when a, b, c turn counter-clockwise, 0 when they are collinear.
inline int orient2d(const Vec2 &a, const Vec2 &b, const Vec2 &c) {
    const double left = (double(b.x) - double(a.x)) * (double(c.y) - double(a.y));
    const double right = (double(b.y) - double(a.y)) * (double(c.x) - double(a.x));
    const double cross = left - right;
    const double bound =
        (3.0 + 16.0 * exact::unit) * exact::unit * (std::abs(left) + std::abs(right));
    if (cross > bound)
        return 1;
    if (cross < -bound)
        return -1;
    if (left == 0.0 && right == 0.0)
        return 0;
    return exact::cross_sign({{double(b.x), double(a.x)}, {double(b.y), double(a.y)}},
                             {{double(c.x), double(a.x)}, {double(c.y), double(a.y)}});
}

namespace exact {

// The sign of the triple product u . (v x w) of vectors whose components are each off by at most
// one rounding; 2 when that leaves it undecided.
inline int filtered_triple_sign(double ux, double uy, double uz, double vx, double vy, double vz,
                                double wx, double wy, double wz) {
    const double vy_wz = vy * wz, vz_wy = vz * wy;
    const double vz_wx = vz * wx, vx_wz = vx * wz;
    const double vx_wy = vx * wy, vy_wx = vy * wx;
    const double triple = ux * (vy_wz - vz_wy) + uy * (vz_wx - vx_wz) + uz * (vx_wy - vy_wx);
    const double permanent = (std::abs(vy_wz) + std::abs(vz_wy)) * std::abs(ux) +
                             (std::abs(vz_wx) + std::abs(vx_wz)) * std::abs(uy) +
                             (std::abs(vx_wy) + std::abs(vy_wx)) * std::abs(uz);
    // Shewchuk 1997, section 4.3, bound A of orient3d.
    const double bound = (7.0 + 56.0 * unit) * unit * permanent;
    if (triple > bound)
        return 1;
    if (triple < -bound)
        return -1;
    return permanent == 0.0 ? 0 : 2;
}

} // namespace exact

// u . ((a - o) x (b - o)): the side on which the line through o along u passes the line from a to
// b; 0 when they are coplanar.
inline int triple_sign(const Vec3 &u, const Vec3 &o, const Vec3 &a, const Vec3 &b) {
    const int sign = exact::filtered_triple_sign(
        double(u.x), double(u.y), double(u.z), double(a.x) - double(o.x), double(a.y) - double(o.y),
        double(a.z) - double(o.z), double(b.x) - double(o.x), double(b.y) - double(o.y),
        double(b.z) - double(o.z));
    if (sign != 2)
        return sign;
    return exact::triple_sign(
        {{double(u.x), 0.0}, {double(u.y), 0.0}, {double(u.z), 0.0}},
        {{double(a.x), double(o.x)}, {double(a.y), double(o.y)}, {double(a.z), double(o.z)}},
        {{double(b.x), double(o.x)}, {double(b.y), double(o.y)}, {double(b.z), double(o.z)}});
}

// (d - a) . ((b - a) x (c - a)): +1 when d is in front of the plane of a, b, c (seen
// counter-clockwise from there), 0 when the four points are coplanar.
inline int orient3d(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const int sign = exact::filtered_triple_sign(
        double(d.x) - double(a.x), double(d.y) - double(a.y), double(d.z) - double(a.z),
        double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z),
        double(c.x) - double(a.x), double(c.y) - double(a.y), double(c.z) - double(a.z));
    if (sign != 2)
        return sign;
    return exact::triple_sign(
        {{double(d.x), double(a.x)}, {double(d.y), double(a.y)}, {double(d.z), double(a.z)}},
        {{double(b.x), double(a.x)}, {double(b.y), double(a.y)}, {double(b.z), double(a.z)}},
        {{double(c.x), double(a.x)}, {double(c.y), double(a.y)}, {double(c.z), double(a.z)}});
}

// normal . point - offset: +1 when the point is in front of the plane, 0 when it is on it. With
// offset 0, the sign of a dot product.
inline int plane_sign(const Vec3 &normal, Real offset, const Vec3 &point) {
    const double x = double(normal.x) * double(point.x);
    const double y = double(normal.y) * double(point.y);
    const double z = double(normal.z) * double(point.z);
    const double height = ((x + y) + z) - double(offset);
    // Each term takes one rounding as a product and three in the sums.
    const double bound = (4.0 + 32.0 * exact::unit) * exact::unit *
                         (std::abs(x) + std::abs(y) + std::abs(z) + std::abs(double(offset)));
    if (height > bound)
        return 1;
    if (height < -bound)
        return -1;
    if (bound == 0.0)
        return 0;
    return exact::plane_sign({double(normal.x), double(normal.y), double(normal.z)}, double(offset),
                             {double(point.x), double(point.y), double(point.z)});
}

// (b - a) . (d - c): +1 when b - a and d - c make an acute angle.
inline int dot_sign(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const double x = (double(b.x) - double(a.x)) * (double(d.x) - double(c.x));
    const double y = (double(b.y) - double(a.y)) * (double(d.y) - double(c.y));
    const double z = (double(b.z) - double(a.z)) * (double(d.z) - double(c.z));
    const double dot = (x + y) + z;
    // Each term takes three roundings as a product and two in the sums.
    const double bound = 8.0 * exact::unit * (std::abs(x) + std::abs(y) + std::abs(z));
    if (dot > bound)
        return 1;
    if (dot < -bound)
        return -1;
    if (bound == 0.0)
        return 0;
    return exact::dot_sign(
        {{double(b.x), double(a.x)}, {double(b.y), double(a.y)}, {double(b.z), double(a.z)}},
        {{double(d.x), double(c.x)}, {double(d.y), double(c.y)}, {double(d.z), double(c.z)}});
}

// radius^2 - |point - center|^2: +1 when the point is inside the ball, 0 when it is on its surface.
inline int ball_sign(const Vec3 &center, Real radius, const Vec3 &point) {
    const double x = double(point.x) - double(center.x);
    const double y = double(point.y) - double(center.y);
    const double z = double(point.z) - double(center.z);
    const double reach = double(radius) * double(radius);
    const double away = x * x + y * y + z * z;
    // Five roundings in `away`, one in `reach` and one in the difference.
    const double bound = 8.0 * exact::unit * (reach + away);
    if (reach - away > bound)
        return 1;
    if (reach - away < -bound)
        return -1;
    if (bound == 0.0)
        return 0;
    return exact::ball_sign(double(radius), {{double(point.x), double(center.x)},
                                             {double(point.y), double(center.y)},
                                             {double(point.z), double(center.z)}});
}

// radius^2 |d|^2 - |(center - origin) x d|^2 with d = to - from: +1 when the line through `origin`
// along d cuts the ball, 0 when it touches it, or when d is zero.
inline int line_ball_sign(const Vec3 &center, Real radius, const Vec3 &origin, const Vec3 &from,
                          const Vec3 &to) {
    const glm::dvec3 m = glm::dvec3(center) - glm::dvec3(origin);
    const glm::dvec3 d = glm::dvec3(to) - glm::dvec3(from);
    const glm::dvec3 moment{m.y * d.z - m.z * d.y, m.z * d.x - m.x * d.z, m.x * d.y - m.y * d.x};
    const double r = double(radius);
    const double squared = d.x * d.x + d.y * d.y + d.z * d.z;
    const double rest =
        r * r * squared - (moment.x * moment.x + moment.y * moment.y + moment.z * moment.z);
    // Each component of the moment is off by 4 units of the sum of its products' magnitudes, so the
    // line's distance by 4 sqrt(2) units of |m|, and the squares by 14 units of r^2 |d|^2 when they
    // are nearly equal. With e = 8 units (|m| + r), (2 r + e) e exceeds all of that.
    const double e = 8.0 * exact::unit * (std::abs(m.x) + std::abs(m.y) + std::abs(m.z) + r);
    const double bound = squared * (e * (2.0 * r + e));
    if (rest > bound)
        return 1;
    if (rest < -bound)
        return -1;
    if (bound == 0.0)
        return 0;
    return exact::line_ball_sign(r,
                                 {{double(center.x), double(origin.x)},
                                  {double(center.y), double(origin.y)},
                                  {double(center.z), double(origin.z)}},
                                 {{double(to.x), double(from.x)},
                                  {double(to.y), double(from.y)},
                                  {double(to.z), double(from.z)}});
}

// (b - a) x (d - c), off by at most 2e-9 of its length in float and 4e-15 in double however nearly
// parallel b - a and d - c are; zero only if they are parallel or one of them is zero.
inline glm::dvec3 accurate_cross(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const glm::dvec3 u = glm::dvec3(b) - glm::dvec3(a);
    const glm::dvec3 v = glm::dvec3(d) - glm::dvec3(c);
    const glm::dvec3 left{u.y * v.z, u.z * v.x, u.x * v.y};
    const glm::dvec3 right{u.z * v.y, u.x * v.z, u.y * v.x};
    const glm::dvec3 cross = left - right;
    // Components are off by 7 units of the largest product. The share of it that must survive
    // cancellation for the promised accuracy:
    constexpr double least = sizeof(Real) == sizeof(float) ? 0x1p-20 : 0.5;
    const auto largest = [](const glm::dvec3 &w) {
        return std::max({std::abs(w.x), std::abs(w.y), std::abs(w.z)});
    };
    if (largest(cross) >= least * std::max(largest(left), largest(right)))
        return cross;
    return exact::cross(
        {{double(b.x), double(a.x)}, {double(b.y), double(a.y)}, {double(b.z), double(a.z)}},
        {{double(d.x), double(c.x)}, {double(d.y), double(c.y)}, {double(d.z), double(c.z)}});
}

} // namespace plumb::inline PLUMB_PRECISION
