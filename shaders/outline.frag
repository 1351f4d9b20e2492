#version 330 core

uniform vec4 accent;
out vec4 result;

void main() { result = vec4(accent.rgb, 1.0); }
