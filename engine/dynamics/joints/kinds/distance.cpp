// Distance: two points stay a length apart (rod), within two lengths (rope), or on a spring.
#include "engine/dynamics/joints/joint_rows.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

void emit_distance(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    const Vec3 r_a = a.rotation * joint.anchor_a_local;
    const Vec3 r_b = b.rotation * joint.anchor_b_local;
    const Vec3 gap = (b.position - a.position) + (r_b - r_a);
    const Real distance = glm::length(gap);
    // Coincident anchors: any direction separates them.
    const Vec3 axis = distance > Real(0) ? gap / distance : Vec3{Real(0), Real(1), Real(0)};
    const auto add = [&](RowBounds bounds, std::size_t memory, Real length) {
        RowBlock &block = rows.add(RowKind::linear, bounds, 1, memory);
        block.axes[0] = axis;
        block.r_a = r_a;
        block.r_b = r_b;
        block.error.x = distance - length;
        block.swing_length = distance;
        block.frequency = joint.frequency;
        block.damping_ratio = joint.damping_ratio;
    };
    if (joint.min_length == joint.max_length) {
        add(RowBounds::equal, 0, joint.max_length);
        return;
    }
    add(RowBounds::at_most, 0, joint.max_length);
    if (joint.min_length > Real(0))
        add(RowBounds::at_least, 1, joint.min_length);
}

JointPlace place_of_distance(const Joint &joint, const Motion &a, const Motion &b) {
    const Vec3 from = a.position + a.rotation * joint.anchor_a_local;
    const Vec3 to = b.position + b.rotation * joint.anchor_b_local;
    const Real distance = glm::length(to - from);
    if (!(distance > Real(0)))
        return {};
    return {distance, glm::dot(to - from, anchor_velocity(joint, a, b)) / distance};
}

} // namespace plumb::inline PLUMB_PRECISION
