#include "engine/dynamics/motion.h"

#include "engine/core/check.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The Cayley map of the turn h * spin: the unit quaternion along (1, h spin / 2). Of all maps it is
// the one under which the midpoint rule keeps the world angular momentum exactly (Austin,
// Krishnaprasad, Wang 1993, "Almost Poisson Integration of Rigid Body Systems", sec. 4).
Quat cayley(const Vec3 &spin, Real h) {
    const Vec3 v = (Real(0.5) * h) * spin;
    return glm::normalize(Quat{Real(1), v.x, v.y, v.z});
}

} // namespace

Mat3 world_inverse_inertia(const Quat &rotation, const Vec3 &inv_inertia) {
    if (is_isotropic(inv_inertia))
        return Mat3{inv_inertia.x};
    const Mat3 r = glm::mat3_cast(rotation);
    const Mat3 scaled{r[0] * inv_inertia.x, r[1] * inv_inertia.y, r[2] * inv_inertia.z};
    return scaled * glm::transpose(r);
}

Vec3 spin_momentum(const Quat &rotation, const Vec3 &inertia, const Vec3 &angular_velocity) {
    return rotation * (inertia * (glm::conjugate(rotation) * angular_velocity));
}

Quat turned(const Quat &rotation, const Vec3 &angular_velocity, Real h) {
    const Real angle = glm::length(angular_velocity) * h;
    if (angle == Real(0))
        return rotation;
    // sin(x/2)/x for small x by its series, where the quotient would lose the direction.
    const Real scale = angle > Real(1e-3) ? std::sin(angle / 2) / angle * h
                                          : (Real(0.5) - angle * angle / Real(48)) * h;
    const Vec3 v = scale * angular_velocity;
    return glm::normalize(Quat{std::cos(angle / 2), v.x, v.y, v.z} * rotation);
}

Vec3 gyroscopic_spin(const Vec3 &inertia, const Vec3 &spin, Real h, int iterations) {
    const Mat3 inertia_matrix{Vec3{inertia.x, 0, 0}, Vec3{0, inertia.y, 0}, Vec3{0, 0, inertia.z}};
    // The unknown is the small change, so that rounding is small, too.
    Vec3 change{Real(0)};
    for (int i = 0; i < iterations; ++i) {
        const Vec3 mid = spin + Real(0.5) * change;
        const Vec3 residual = inertia * change + h * glm::cross(mid, inertia * mid);
        // d(residual)/d(change); mid depends on the change by one half.
        const Mat3 jacobian =
            inertia_matrix +
            (Real(0.5) * h) * (cross_matrix(mid) * inertia_matrix - cross_matrix(inertia * mid));
        change -= glm::inverse(jacobian) * residual;
    }
    // Turns of more than a radian need more iterations, and from two on Newton's method may run
    // away from its root; the energy is kept all the same.
    const Vec3 end = spin + change;
    const Real before = glm::dot(inertia * spin, spin);
    const Real after = glm::dot(inertia * end, end);
    constexpr Real rounding = Real(32) * std::numeric_limits<Real>::epsilon();
    if (!PLUMB_RARELY("gyroscopic spin did not converge",
                      !(std::abs(after - before) <= rounding * before)))
        return end;
    return std::isfinite(after) && after > Real(0) ? std::sqrt(before / after) * end : spin;
}

FreeFlight begin_flight(Motion &motion, const Body &body, const Vec3 &gravity, Real h, Kick kick,
                        int gyroscopic_iterations) {
    FreeFlight flight;
    flight.mean_velocity = motion.velocity;
    if (body.kind == BodyKind::dynamic) {
        const Vec3 half_kick = (Real(0.5) * h) * gravity;
        flight.mean_velocity += half_kick;
        flight.late_velocity = kick == Kick::around ? half_kick : Vec3{Real(0)};
        motion.velocity += h * gravity - flight.late_velocity;
        if (!is_isotropic(body.inertia)) {
            const Vec3 spin = rotated(glm::conjugate(motion.rotation), motion.angular_velocity);
            flight.end_spin = gyroscopic_spin(body.inertia, spin, h, gyroscopic_iterations);
            flight.mean_spin = Real(0.5) * (spin + flight.end_spin);
            motion.angular_velocity =
                rotated(motion.rotation, kick == Kick::around ? flight.mean_spin : flight.end_spin);
        }
    }
    flight.velocity = motion.velocity;
    flight.angular_velocity = motion.angular_velocity;
    return flight;
}

void move(Motion &motion, const Body &body, FreeFlight &flight, Real h) {
    if (body.kind == BodyKind::fixed)
        return;
    flight.free =
        motion.velocity == flight.velocity && motion.angular_velocity == flight.angular_velocity;
    motion.position += h * (flight.free ? flight.mean_velocity : motion.velocity);
    if (flight.free && !is_isotropic(body.inertia))
        motion.rotation = glm::normalize(motion.rotation * cayley(flight.mean_spin, h));
    else
        motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
    if (body.kind == BodyKind::dynamic)
        motion.inv_inertia = world_inverse_inertia(motion.rotation, body.inv_inertia);
}

void end_flight(Motion &motion, const Body &body, const FreeFlight &flight, Kick kick) {
    motion.velocity += flight.late_velocity;
    if (is_isotropic(body.inertia))
        return;
    if (flight.free)
        motion.angular_velocity = rotated(motion.rotation, flight.end_spin);
    else if (kick == Kick::around)
        motion.angular_velocity += rotated(motion.rotation, flight.end_spin - flight.mean_spin);
}

} // namespace plumb::inline PLUMB_PRECISION
