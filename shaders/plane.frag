#version 330 core
#include "frame.glsl"
#include "backdrop.glsl"
#include "dither.glsl"
#include "lighting.glsl"

uniform vec4 axis_x;
uniform vec4 axis_z;
uniform vec4 normal;
uniform float grid;
out vec4 result;

// How much of a pixel the lines of a unit grid cover (Golus, "The Best Darn Grid Shader (Yet)", 2023): a
// line is never drawn thinner than a pixel, only fainter, and a grid too fine to see becomes even.
float grid_lines(vec2 at, vec2 per_pixel, float width) {
    vec2 drawn = clamp(vec2(width), per_pixel, vec2(0.5));
    vec2 soft = 1.2 * per_pixel;
    vec2 from_line = 0.5 - abs(fract(at) - 0.5);
    vec2 line = 1.0 - smoothstep(0.5 * drawn - 0.5 * soft, 0.5 * drawn + 0.5 * soft, from_line);
    line *= clamp(vec2(width) / drawn, 0.0, 1.0);
    line = mix(line, vec2(width), clamp(2.0 * per_pixel - 1.0, 0.0, 1.0));
    return max(line.x, line.y);
}

void main() {
    // Where the ray through this pixel meets the plane; exact however large the square is.
    vec2 clip = (2.0 * gl_FragCoord.xy / viewport.xy - 1.0 - centre.xy) * viewport.zw;
    vec3 ray = transpose(mat3(view)) * vec3(clip, -1.0);
    float height = dot(eye.xyz, normal.xyz) + normal.w;
    float t = height / max(-dot(ray, normal.xyz), 1e-6);
    vec3 position = eye.xyz + t * ray;

    vec2 at = vec2(dot(position, axis_x.xyz) + axis_x.w, dot(position, axis_z.xyz) + axis_z.w);
    vec2 dx = dFdx(at);
    vec2 dy = dFdy(at);
    vec2 per_pixel = sqrt(dx * dx + dy * dy);
    vec3 albedo = vec3(0.73, 0.735, 0.745);
    if (grid > 0.5) {
        float fine = grid_lines(at, per_pixel, 0.02);
        float coarse = grid_lines(0.1 * at, 0.1 * per_pixel, 0.005);
        albedo *= 1.0 - 0.24 * fine;
        albedo *= 1.0 - 0.34 * coarse;
    }

    float facing = max(dot(normal.xyz, to_light.xyz), 0.0);
    vec3 all = ambient_light(normal.xyz) + light_colour * (to_light.w * facing);
    float reaching = facing > 0.0 ? light_reaching(position, normal.xyz, 0.0) : 0.0;
    vec3 some = ambient_light(normal.xyz) + light_colour * (to_light.w * facing * reaching);
    // Far away the plane becomes the backdrop; shadows stay on it a little longer.
    float away = length(position + normal.w * normal.xyz) / eye.w;
    float fade = 1.0 - exp(-0.045 * away * away);
    vec3 seen = mix(albedo * all, backdrop(gl_FragCoord.xy), fade);
    seen *= mix(some / max(all, 1e-6), vec3(1.0), fade * fade);
    result = vec4(dither(seen, gl_FragCoord.xy), 1.0);
}
