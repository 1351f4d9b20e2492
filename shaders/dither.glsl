// A pattern of less than half an 8-bit step, which hides banding in slow gradients (Jimenez,
// "Interleaved gradient noise", 2014).
vec3 dither(vec3 colour, vec2 pixel) {
    float noise = fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
    // One step of sRGB is about this much light.
    return colour + (noise - 0.5) * (0.0088 * sqrt(max(colour, 0.0)));
}
