#version 330 core
#include "frame.glsl"

layout(location = 0) in vec4 from; // w: width in pixels
layout(location = 1) in vec4 to;
layout(location = 2) in vec3 line_colour; // linear

out vec2 at; // pixels along and across the line
flat out float half_length;
flat out float half_width;
flat out vec3 colour;

void main() {
    // Slightly nearer to the eye, so that a surface does not cut into a line on it.
    vec3 a = 0.998 * (view * vec4(from.xyz, 1.0)).xyz;
    vec3 b = 0.998 * (view * vec4(to.xyz, 1.0)).xyz;
    // The part in front of the near plane.
    float limit = -1.01 * range.x;
    if (a.z > limit && b.z > limit) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    if (a.z > limit)
        a = mix(b, a, (limit - b.z) / (a.z - b.z));
    else if (b.z > limit)
        b = mix(a, b, (limit - a.z) / (b.z - a.z));
    vec4 clip_a = projection * vec4(a, 1.0);
    vec4 clip_b = projection * vec4(b, 1.0);
    vec2 pixel_a = 0.5 * viewport.xy * clip_a.xy / clip_a.w;
    vec2 pixel_b = 0.5 * viewport.xy * clip_b.xy / clip_b.w;
    float span = distance(pixel_a, pixel_b);
    vec2 along = span > 1e-3 ? (pixel_b - pixel_a) / span : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);

    half_length = 0.5 * span;
    half_width = 0.5 * from.w;
    colour = line_colour;
    float margin = half_width + 1.0;
    bool second = gl_VertexID >= 2;
    float end = second ? 1.0 : -1.0;
    float side = gl_VertexID % 2 == 0 ? -1.0 : 1.0;
    at = vec2(end * (half_length + margin), side * margin);
    vec4 clip = second ? clip_b : clip_a;
    vec2 offset = margin * (end * along + side * across);
    // Already divided by w, so that the sides of the view do not clip it in perspective.
    gl_Position = vec4(clip.xyz / clip.w + vec3(2.0 * offset / viewport.xy, 0.0), 1.0);
}
