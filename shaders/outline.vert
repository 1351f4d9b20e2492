#version 330 core
#include "frame.glsl"
#include "instance.glsl"

uniform vec4 accent; // linear; w: the outline's width in pixels

void main() {
    float depth = -(view * vec4(instance_position.xyz, 1.0)).z;
    float grow = accent.w * range.w * max(depth, range.x);
    vec3 position = instance_position.xyz + rotate(instance_rotation, local_position(grow));
    gl_Position = projection * (view * vec4(position, 1.0));
}
