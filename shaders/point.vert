#version 330 core
#include "frame.glsl"

layout(location = 0) in vec4 marker;       // w: radius in pixels
layout(location = 1) in vec3 point_colour; // linear

out vec2 at; // pixels
flat out float radius;
flat out vec3 colour;

void main() {
    vec2 corner = vec2(gl_VertexID % 2 == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? -1.0 : 1.0);
    radius = marker.w;
    colour = point_colour;
    at = (radius + 1.0) * corner;
    // Nearer to the eye than the lines that end here.
    vec4 clip = projection * vec4(0.996 * (view * vec4(marker.xyz, 1.0)).xyz, 1.0);
    // The same w for the whole square, so interpolation is linear.
    gl_Position = clip + vec4(2.0 * at / viewport.xy * clip.w, 0.0, 0.0);
}
