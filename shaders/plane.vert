#version 330 core
#include "frame.glsl"

uniform vec4 axis_x; // the plane's axes; w: the target's place along them
uniform vec4 axis_z;
uniform vec4 normal; // w: the target's height above the plane

// A square around the target's foot, wide enough that its border has long faded.
void main() {
    vec2 corner = vec2(gl_VertexID % 2 == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? 1.0 : -1.0);
    float reach = 40.0 * eye.w + 4.0 * abs(normal.w);
    vec3 position = reach * (corner.x * axis_x.xyz + corner.y * axis_z.xyz) - normal.w * normal.xyz;
    gl_Position = projection * (view * vec4(position, 1.0));
}
