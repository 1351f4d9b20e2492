#version 330 core
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 coordinates;
layout(location = 2) in vec4 colour;
uniform vec4 display; // position and size
out vec2 uv;
out vec4 tint;

void main() {
    uv = coordinates;
    tint = colour;
    vec2 p = (position - display.xy) / display.zw;
    gl_Position = vec4(2.0 * p.x - 1.0, 1.0 - 2.0 * p.y, 0.0, 1.0);
}
