#version 330 core

uniform float opacity;
in vec2 at;
flat in float half_length;
flat in float half_width;
flat in vec3 colour;
out vec4 result;

void main() {
    // The distance to the segment, with round ends.
    float away = length(vec2(max(abs(at.x) - half_length, 0.0), at.y));
    float cover = clamp(half_width + 0.5 - away, 0.0, 1.0);
    if (cover <= 0.0)
        discard;
    result = vec4(colour, opacity * cover);
}
