#version 330 core
#include "frame.glsl"
#include "instance.glsl"

out vec3 position;
out vec3 local;
out vec3 local_normal;
out vec3 profile; // the place on a round shape of radius 1, without its half height
flat out vec4 rotation;
flat out vec4 scale;
flat out vec4 colour;

void main() {
    local = local_position(0.0);
    local_normal = mesh_normal;
    profile = mesh_position;
    rotation = instance_rotation;
    scale = instance_scale;
    colour = instance_colour;
    position = instance_position.xyz + rotate(instance_rotation, local);
    gl_Position = projection * (view * vec4(position, 1.0));
}
