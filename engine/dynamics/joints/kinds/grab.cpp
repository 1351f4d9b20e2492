// Grab: the mouse holds a body's point with a spring of limited strength.
#include "engine/dynamics/check_value.h"
#include "engine/dynamics/joints/joint_rows.h"

namespace plumb::inline PLUMB_PRECISION {

Grab grab_of(const Vec3 &target, Real max_force, const GrabSpring &spring) {
    PLUMB_CHECK(is_finite(target), "a grab's target must be finite");
    check_not_negative("a grab's force", max_force);
    Grab grab;
    grab.target = target;
    grab.max_force = max_force;
    grab.frequency = static_cast<Real>(spring.frequency);
    grab.damping_ratio = static_cast<Real>(spring.damping_ratio);
    check_positive("a grab's frequency", grab.frequency);
    check_not_negative("a grab's damping_ratio", grab.damping_ratio);
    return grab;
}

void emit_rows(const Grab &grab, const Motion &world, const Motion &body, RowWriter &rows) {
    RowBlock &block = rows.add(RowKind::point, RowBounds::pull, 3, 0);
    block.r_a = grab.target - world.position;
    block.r_b = body.rotation * grab.point_local;
    block.error = (body.position - world.position) + (block.r_b - block.r_a);
    block.max_force = grab.max_force;
    block.frequency = grab.frequency;
    block.damping_ratio = grab.damping_ratio;
}

} // namespace plumb::inline PLUMB_PRECISION
