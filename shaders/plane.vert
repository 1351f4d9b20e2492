#version 330 core
#include "frame.glsl"
#include "lighting.glsl"

uniform vec4 axis_x; // the plane's axes; w: the target's place along them
uniform vec4 axis_z;
uniform vec4 normal; // w: the target's height above the plane

// Constant over the plane, so computed four times rather than for each pixel.
flat out vec3 seen_x; // the plane's axes in the eye's frame
flat out vec3 seen_z;
flat out vec3 seen_normal;
flat out vec3 foot;     // the eye along them, from the target's foot on the plane
flat out vec3 shadow_x; // steps along them, and that foot, in the shadow map
flat out vec3 shadow_z;
flat out vec3 shadow_foot;
flat out vec3 lit;
flat out vec3 direct; // the share of that which is direct light

// A square around the target's foot, wide enough that its border is fully faded.
void main() {
    vec2 corner = vec2(gl_VertexID % 2 == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? 1.0 : -1.0);
    float reach = 40.0 * eye.w + 4.0 * abs(normal.w);
    vec3 position = reach * (corner.x * axis_x.xyz + corner.y * axis_z.xyz) - normal.w * normal.xyz;
    gl_Position = projection * (view * vec4(position, 1.0));

    seen_x = mat3(view) * axis_x.xyz;
    seen_z = mat3(view) * axis_z.xyz;
    seen_normal = mat3(view) * normal.xyz;
    foot = vec3(dot(eye.xyz, axis_x.xyz), dot(eye.xyz, normal.xyz) + normal.w, dot(eye.xyz, axis_z.xyz));
    shadow_x = mat3(shadow) * axis_x.xyz;
    shadow_z = mat3(shadow) * axis_z.xyz;
    shadow_foot = (shadow * vec4((off_surface(normal.xyz) - normal.w) * normal.xyz, 1.0)).xyz;
    vec3 straight = light_colour * (to_light.w * max(dot(normal.xyz, to_light.xyz), 0.0));
    lit = ambient_light(normal.xyz) + straight;
    direct = straight / max(lit, 1e-6);
}
