#version 330 core
#include "frame.glsl"

uniform sampler2D occlusion_map;
out vec2 result;

// The mean over the 4 x 4 pattern, of pixels at the same depth.
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(occlusion_map, 0) - 1;
    float metres = texelFetch(occlusion_map, pixel, 0).g;
    float sum = 0.0;
    float weights = 0.0;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            vec2 there = texelFetch(occlusion_map, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).rg;
            float weight = max(1e-4, 1.0 - abs(there.g - metres) / (0.02 * metres));
            sum += weight * there.r;
            weights += weight;
        }
    }
    result = vec2(sum / weights, metres);
}
