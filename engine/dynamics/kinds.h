// The kinds of bodies and joints, the same in either precision.
#pragma once

namespace plumb {

// "static", "kinematic", "dynamic" in files. Kinematic bodies move at a given velocity that nothing
// changes; static bodies never move.
enum class BodyKind { static_body, kinematic, dynamic };

// ball: an anchor of one body stays on an anchor of the other. distance: the anchors stay between a
// least and a greatest distance, like a massless rod or rope. hinge: the bodies share a point and
// an axis, about which they turn. slider: they only move along an axis. fixed: they are welded
// together.
//
// The only list of them: each has a file in engine/dynamics/joints/kinds/ and a row in
// engine/scene/joint_type.cpp.
#define PLUMB_JOINT_TYPES(JOINT) JOINT(ball) JOINT(distance) JOINT(hinge) JOINT(slider) JOINT(fixed)

enum class JointType {
#define PLUMB_JOINT_TYPE(name) name,
    PLUMB_JOINT_TYPES(PLUMB_JOINT_TYPE)
#undef PLUMB_JOINT_TYPE
};

} // namespace plumb
