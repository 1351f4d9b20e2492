// Grab: the mouse holds a body's point on a spring of bounded strength.
#include "engine/dynamics/joint_rows.h"

namespace plumb::inline PLUMB_PRECISION {

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
