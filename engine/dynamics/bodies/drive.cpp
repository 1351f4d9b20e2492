#include "engine/dynamics/bodies/drive.h"

#include "engine/dynamics/bodies/motion.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

Damped strongly_damped(Real rate, Real h) {
    const double x = static_cast<double>(rate) * static_cast<double>(h);
    const double lost = -std::expm1(-x);
    const double mean = lost / x;
    // (1 - mean) / x by its series for small x, where the difference would cancel.
    const double rest = x > 1e-3 ? (1.0 - mean) / x : 0.5 - x / 6.0 + x * x / 24.0;
    return {static_cast<Real>(1.0 - lost), static_cast<Real>(mean),
            static_cast<Real>(mean * static_cast<double>(h)),
            static_cast<Real>(rest * static_cast<double>(h))};
}

Drive drive_of(const Body &body, const Vec3 &gravity, Real h) {
    Drive drive;
    if (body.kind != BodyKind::dynamic)
        return drive;
    const Vec3 pull = pull_on(body, gravity);
    const Damped linear = damped(body.linear_damping, h);
    drive.mean_kept = linear.mean_kept;
    drive.late_kept = linear.kept - linear.mean_kept;
    drive.kept = linear.kept;
    drive.mean_gain = linear.mean_gained * pull;
    drive.late_gain = (linear.gained - linear.mean_gained) * pull;
    drive.gain = linear.gained * pull;
    drive.angular = damped(body.angular_damping, h);
    drive.is_dynamic = true;
    drive.is_gyroscopic = has_gyroscopic_spin(body);
    return drive;
}

} // namespace plumb::inline PLUMB_PRECISION
