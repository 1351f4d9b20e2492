#version 330 core
#include "frame.glsl"
#include "depth.glsl"

uniform sampler2D occlusion_map;
out vec4 result;

// Upsampling: of the four nearest values, those on this pixel's surface.
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float metres = metres_at(pixel);
    ivec2 last = textureSize(occlusion_map, 0) - 1;
    ivec2 base = pixel / 2;
    ivec2 next = pixel & 1;
    float sum = 0.0;
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 there = texelFetch(occlusion_map, min(base + corner * next, last), 0).rg;
        float weight = max(1e-4, 1.0 - abs(there.g - metres) / (0.02 * metres));
        sum += weight * there.r;
        weights += weight;
    }
    float open = sum / weights;
    // Creases keep a little of the ground's warmth.
    result = vec4(mix(vec3(0.17, 0.165, 0.16), vec3(1.0), open), 1.0);
}
