#version 330 core
#include "frame.glsl"
#include "backdrop.glsl"
#include "dither.glsl"

out vec4 result;

void main() { result = vec4(dither(backdrop(gl_FragCoord.xy), gl_FragCoord.xy), 1.0); }
