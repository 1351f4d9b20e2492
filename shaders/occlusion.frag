#version 330 core
#include "frame.glsl"
#include "depth.glsl"

out vec2 result; // share of the ambient light that arrives, and depth in metres

const int taps = 10;

// Nearby surfaces that rise above this one's tangent plane block light: after McGuire, Osman,
// Bukowski, Hennessy, "The Alchemy Screen-Space Ambient Obscurance Algorithm", 2011, with our own
// falloff.
void main() {
    ivec2 pixel = 2 * ivec2(gl_FragCoord.xy);
    float metres = metres_at(pixel);
    result = vec2(1.0, metres);
    if (metres > 0.9 * range.y)
        return;
    vec3 here = seen_at(pixel, metres);
    // Of the two neighbours along each axis, the one on the same surface.
    vec3 left = here - seen_at(pixel - ivec2(1, 0));
    vec3 right = seen_at(pixel + ivec2(1, 0)) - here;
    vec3 down = here - seen_at(pixel - ivec2(0, 1));
    vec3 up = seen_at(pixel + ivec2(0, 1)) - here;
    vec3 x = abs(left.z) < abs(right.z) ? left : right;
    vec3 y = abs(down.z) < abs(up.z) ? down : up;
    vec3 normal = normalize(cross(y, x)); // towards the eye: z is negative

    float reach = 0.07 * eye.w; // metres
    float pixels = min(reach / (range.w * metres), 0.12 * viewport.y);
    if (pixels < 1.5)
        return;
    // A spiral of taps, rotated from pixel to pixel in a 4 x 4 pattern that is smoothed away.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    int mixed = cell.x ^ cell.y;
    int order = 8 * (mixed & 1) + 4 * (cell.y & 1) + (mixed & 2) + (cell.y >> 1);
    float turn = float(order) * (pi / 8.0);
    float sum = 0.0;
    for (int i = 0; i < taps; ++i) {
        float share = (float(i) + 0.5) / float(taps);
        float angle = turn + 2.0 * pi * 4.0 * share;
        vec2 offset = pixels * share * vec2(cos(angle), sin(angle));
        vec3 v = seen_at(pixel + ivec2(offset)) - here;
        float squared = dot(v, v);
        float near = max(1.0 - squared / (reach * reach), 0.0);
        sum += near * near * max(dot(v, normal) - 0.0015 * metres, 0.0) /
               (squared + 0.0004 * reach * reach) * reach;
    }
    result.x = clamp(1.0 - 1.5 * sum / float(taps), 0.0, 1.0);
}
