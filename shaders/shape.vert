#version 330 core
#include "frame.glsl"
#include "instance.glsl"

out vec3 position;
out vec3 local;
out vec3 local_normal;
out vec3 profile; // position on a round shape of radius 1, without its half height
flat out mat3 turned; // the shape's axes
flat out vec4 scale;
flat out vec4 colour;

void main() {
    local = local_position(0.0);
    local_normal = mesh_normal;
    profile = mesh_position;
    turned = mat3(rotate(instance_rotation, vec3(1.0, 0.0, 0.0)), rotate(instance_rotation, vec3(0.0, 1.0, 0.0)),
                  rotate(instance_rotation, vec3(0.0, 0.0, 1.0)));
    scale = instance_scale;
    colour = instance_colour;
    position = instance_position.xyz + turned * local;
    gl_Position = projection * (view * vec4(position, 1.0));
}
