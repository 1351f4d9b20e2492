#version 330 core
#include "frame.glsl"
#include "dither.glsl"
#include "lighting.glsl"

in vec3 position;
in vec3 local;
in vec3 local_normal;
in vec3 profile;
flat in mat3 turned;
flat in vec4 scale;
flat in vec4 colour;
uniform float glass; // 1: things behind show through
out vec4 result;

float squared(float x) { return x * x; }

void main() {
    vec3 albedo = mix(colour.rgb, vec3(1.0), 0.35 * colour.a);
    vec3 smooth_normal = normalize(local_normal);
    // Flat triangles are visible from both sides.
    vec3 bent = scale.w == 4.0 && !gl_FrontFacing ? -smooth_normal : smooth_normal;
    vec3 normal = turned * bent;
    vec3 per_pixel = fwidth(local);

    if (range.z > 0.5) {
        if (scale.w == 1.0) {
            // Rounded edges: near an edge the normal leans towards the neighbouring face, and a
            // fine line keeps faces of one colour apart.
            vec3 across = 1.0 - abs(bent);
            vec3 pixel = max(per_pixel, 1e-9);
            vec3 inside = scale.xyz - abs(local);
            float smallest = min(scale.x, min(scale.y, scale.z));
            vec3 width = clamp(vec3(0.07 * smallest), 1.3 * pixel, vec3(0.25 * smallest) + 1e-9);
            vec3 lean = clamp(1.0 - inside / width, 0.0, 1.0) * across;
            bent = normalize(bent + 0.8 * lean * lean * sign(local));
            vec3 line = (1.0 - smoothstep(0.6 * pixel, 1.6 * pixel, inside)) * across;
            // On a box of few pixels there would be nothing but lines.
            line *= smoothstep(4.0 * pixel, 16.0 * pixel, scale.xyz);
            albedo *= 1.0 - 0.30 * max(line.x, max(line.y, line.z));
        } else if (scale.w != 4.0) {
            // Quarters, a shade apart, show how round shapes turn.
            vec3 side = clamp(local / max(per_pixel, 1e-9), -1.0, 1.0);
            albedo *= 1.0 + 0.13 * side.x * side.y * side.z;
        }
    }

    vec3 shaded = turned * bent;
    vec3 to_eye = normalize(eye.xyz - position);
    float facing = max(dot(shaded, to_light.xyz), 0.0);
    // A facet lies below the round surface it approximates, by a share of the radius that depends
    // on the mesh, and so below the shadow map's finer facets: sample the light on the surface.
    bool is_round = scale.w == 0.0 || scale.w == 2.0 || (scale.w == 3.0 && abs(smooth_normal.y) < 0.5);
    float under = is_round ? scale.x * max(1.0 - dot(profile, smooth_normal), 0.0) : 0.0;
    float reaching = facing > 0.0 ? light_reaching(position, normal, under) : 0.0;
    vec3 direct = light_colour * (to_light.w * facing * reaching);
    // A satin surface: a broad, weak gloss, and a little sheen at grazing angles.
    vec3 halfway = normalize(to_light.xyz + to_eye);
    float gloss = squared(squared(squared(squared(squared(max(dot(shaded, halfway), 0.0))))));
    float sheen = squared(squared(1.0 - max(dot(shaded, to_eye), 0.0))) * (0.5 + 0.5 * shaded.y);
    vec3 lit = albedo * (ambient_light(shaded) + direct) + 0.10 * (direct * gloss + to_light.w * sheen);
    // Glass is thicker at grazing angles.
    float along = 1.0 - abs(dot(shaded, to_eye));
    float opacity = glass > 0.5 ? mix(0.42, 0.85, along * along) : 1.0;
    result = vec4(dither(lit, gl_FragCoord.xy), opacity);
}
