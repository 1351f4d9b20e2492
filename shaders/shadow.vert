#version 330 core
#include "frame.glsl"
#include "instance.glsl"

void main() {
    vec3 position = instance_position.xyz + rotate(instance_rotation, local_position(0.0));
    gl_Position = vec4((shadow * vec4(position, 1.0)).xyz * 2.0 - 1.0, 1.0);
}
