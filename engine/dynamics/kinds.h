// The kinds of bodies and joints, the same in either precision.
#pragma once

namespace plumb {

// "static", "kinematic", "dynamic" in files. Kinematic bodies move with a given velocity that
// nothing changes; static ones not at all.
enum class BodyKind { static_body, kinematic, dynamic };

// ball: a point of one body stays on a point of the other. distance: the two points stay between a
// least and a greatest distance, like a massless rod or rope. hinge: the bodies share a point and
// an axis, about which they turn. slider: they only move along an axis. fixed: they are one.
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
