// The kinds of bodies and joints, the same in either precision.
#pragma once

namespace plumb {

// "static", "kinematic", "dynamic" in files. Kinematic bodies move with a given velocity that
// nothing changes; static ones not at all.
enum class BodyKind { fixed, kinematic, dynamic };

// ball: a point of one body stays on a point of the other. distance: the two points stay a given
// length apart, like a rigid massless rod.
enum class JointType { ball, distance };

} // namespace plumb
