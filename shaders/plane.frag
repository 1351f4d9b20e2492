#version 330 core
#include "frame.glsl"
#include "backdrop.glsl"
#include "dither.glsl"
#include "lighting.glsl"

uniform vec4 axis_x;
uniform vec4 axis_z;
uniform float grid;
flat in vec3 seen_x;
flat in vec3 seen_z;
flat in vec3 seen_normal;
flat in vec3 foot;
flat in vec3 shadow_x;
flat in vec3 shadow_z;
flat in vec3 shadow_foot;
flat in vec3 lit;
flat in vec3 direct;
out vec4 result;

// How much of a pixel a unit grid's lines cover (Golus, "The Best Darn Grid Shader (Yet)", 2023): a
// line is never drawn thinner than a pixel, only fainter, and a grid too fine to see becomes
// uniform. `pixels` is pixels per unit, `per_pixel` its inverse.
float grid_lines(vec2 at, vec2 per_pixel, vec2 pixels, float width) {
    vec2 drawn = clamp(vec2(width), per_pixel, vec2(0.5));
    vec2 from_line = 0.5 - abs(fract(at) - 0.5);
    vec2 beyond = clamp((from_line - 0.5 * drawn) * pixels / 1.2 + 0.5, 0.0, 1.0);
    vec2 line = 1.0 - beyond * beyond * (3.0 - 2.0 * beyond);
    line *= clamp(width * pixels, 2.0 * width, 1.0); // width / drawn
    line = mix(line, vec2(width), clamp(2.0 * per_pixel - 1.0, 0.0, 1.0));
    return max(line.x, line.y);
}

void main() {
    // Where the ray through this pixel hits the plane, relative to the target's foot; exact however
    // large the square is.
    vec3 ray = vec3((2.0 * gl_FragCoord.xy / viewport.xy - 1.0 - centre.xy) * viewport.zw, -1.0);
    float t = foot.y / max(-dot(ray, seen_normal), 1e-6);
    vec2 from_foot = foot.xz + t * vec2(dot(ray, seen_x), dot(ray, seen_z));

    vec3 albedo = vec3(0.73, 0.735, 0.745);
    if (grid > 0.5) {
        vec2 at = from_foot + vec2(axis_x.w, axis_z.w);
        vec2 dx = dFdx(at);
        vec2 dy = dFdy(at);
        vec2 per_pixel = max(sqrt(dx * dx + dy * dy), 1e-9);
        vec2 pixels = 1.0 / per_pixel;
        float fine = grid_lines(at, per_pixel, pixels, 0.02);
        float coarse = grid_lines(0.1 * at, 0.1 * per_pixel, 10.0 * pixels, 0.005);
        albedo *= (1.0 - 0.24 * fine) * (1.0 - 0.34 * coarse);
    }

    float reaching = light_at(shadow_foot + from_foot.x * shadow_x + from_foot.y * shadow_z);
    // Far away the plane fades into the backdrop; shadows stay on it a little longer.
    float fade = 1.0 - exp(-0.045 / (eye.w * eye.w) * dot(from_foot, from_foot));
    vec3 seen = mix(albedo * lit, backdrop(gl_FragCoord.xy), fade);
    seen *= 1.0 - (1.0 - reaching) * (1.0 - fade * fade) * direct;
    result = vec4(dither(seen, gl_FragCoord.xy), 1.0);
}
