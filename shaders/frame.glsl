// Shared by all programs of a frame. Positions are relative to the camera's target, in metres.
layout(std140) uniform Frame {
    mat4 projection;
    mat4 view;
    mat4 shadow;
    vec4 eye;      // xyz; w: the camera's distance
    vec4 to_light; // xyz, unit; w: intensity
    vec4 viewport; // width, height, tan of half the field of view across and up
    vec4 light;    // ambient; shadow texel in metres; shadow texel in texture units; shadows on
    vec4 range;    // near, far; edges on; metres per pixel at unit depth
    vec4 centre;   // where the target is seen, x and y in clip space
};

const float pi = 3.14159265;
