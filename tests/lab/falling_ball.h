// A scene text: a ball that falls from rest for a second.
#pragma once

namespace plumb {

// By s = g t^2 / 2 from 10 m to 5.095 m, whatever its mass; after the [world], if there is one.
inline constexpr const char *falling_ball = R"(
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
mass = 1
position = [0, 10, 0]
velocity = [0, 0, 0]
[[expect]]
name = "height"
quantity = "position.y"
body = "ball"
to = 1
equals = 5.095
tolerance = 0.01
source = "s = g t^2 / 2"
)";

} // namespace plumb
