// Ball: a point of one body stays on a point of the other.
#include "engine/dynamics/joints/joint_rows.h"

namespace plumb::inline PLUMB_PRECISION {

void emit_ball(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    emit_point(joint, a, b, 0, rows);
}

JointPlace place_of_ball(const Joint &, const Motion &, const Motion &) {
    return {};
}

} // namespace plumb::inline PLUMB_PRECISION
