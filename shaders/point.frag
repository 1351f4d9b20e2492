#version 330 core

uniform float opacity;
in vec2 at;
flat in float radius;
flat in vec3 colour;
out vec4 result;

void main() {
    float away = length(at);
    float cover = clamp(radius + 0.5 - away, 0.0, 1.0);
    if (cover <= 0.0)
        discard;
    // A bead: darker at its rim, lit from above.
    float rim = smoothstep(0.55 * radius, radius, away);
    float above = clamp(at.y / radius, -1.0, 1.0);
    vec3 bead = colour * (1.0 + 0.25 * above) * mix(1.0, 0.55, rim);
    result = vec4(bead, opacity * cover);
}
