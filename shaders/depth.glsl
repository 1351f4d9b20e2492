uniform sampler2D depth_map;

// The depth of a pixel in metres from the eye's plane.
float metres_at(ivec2 pixel) {
    float depth = texelFetch(depth_map, clamp(pixel, ivec2(0), ivec2(viewport.xy) - 1), 0).r;
    return range.x * range.y / (range.y - depth * (range.y - range.x));
}

// A pixel's surface point, in the eye's frame with z forward.
vec3 seen_at(ivec2 pixel, float metres) {
    vec2 clip = 2.0 * (vec2(pixel) + 0.5) / viewport.xy - 1.0 - centre.xy;
    return vec3(clip * viewport.zw * metres, metres);
}

vec3 seen_at(ivec2 pixel) { return seen_at(pixel, metres_at(pixel)); }
