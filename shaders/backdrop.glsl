// The studio behind everything: a soft gradient up the picture, brightest behind its middle.
vec3 backdrop(vec2 pixel) {
    vec2 at = pixel / viewport.xy;
    const vec3 bottom = vec3(0.80, 0.81, 0.82);
    const vec3 middle = vec3(0.86, 0.87, 0.88);
    const vec3 top = vec3(0.55, 0.62, 0.70);
    vec3 colour = at.y < 0.5 ? mix(bottom, middle, smoothstep(0.0, 0.5, at.y))
                             : mix(middle, top, smoothstep(0.4, 1.25, at.y));
    vec2 off = at - vec2(0.5, 0.55);
    return colour * (1.0 - 0.16 * dot(off, off));
}
