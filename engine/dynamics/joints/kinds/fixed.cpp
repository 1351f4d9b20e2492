// Fixed: two bodies move as one.
#include "engine/dynamics/joints/joint_rows.h"

namespace plumb::inline PLUMB_PRECISION {

void emit_fixed(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    emit_point(joint, a, b, 0, rows);
    emit_same_turn(joint, a, b, 3, rows);
}

JointPlace place_of_fixed(const Joint &, const Motion &, const Motion &) {
    return {};
}

} // namespace plumb::inline PLUMB_PRECISION
