#version 330 core
in vec2 uv;
in vec4 tint;
uniform sampler2D picture;
out vec4 colour;

void main() { colour = tint * texture(picture, uv); }
