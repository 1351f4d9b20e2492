// The share of the light that reaches a point, 0..1.
uniform sampler2DShadow shadow_map;

// How far off a surface to sample the light: on a slope, as far as the filter reaches across it.
float off_surface(vec3 normal) {
    float cosine = clamp(dot(normal, to_light.xyz), 0.0, 1.0);
    float sine = sqrt(1.0 - cosine * cosine);
    return light.y * (0.6 + 2.4 * sine);
}

// Light at a place in the map: a 5 x 5 tent over its texels from nine filtered fetches (Castano,
// "Shadow Mapping Summary", The Witness, 2013).
float light_at(vec3 at) {
    if (light.w < 0.5)
        return 1.0;
    float depth = min(at.z, 1.0);
#ifdef HARD_SHADOWS
    return texture(shadow_map, vec3(at.xy, depth));
#else
    float texel = light.z;
    vec2 uv = at.xy / texel;
    vec2 base = floor(uv + 0.5);
    vec2 st = uv + 0.5 - base;
    base = (base - 0.5) * texel;

    vec2 w0 = 4.0 - 3.0 * st;
    vec2 w2 = 1.0 + 3.0 * st;
    vec2 o0 = ((3.0 - 2.0 * st) / w0 - 2.0) * texel + base;
    vec2 o1 = ((3.0 + st) / 7.0) * texel + base;
    vec2 o2 = (st / w2 + 2.0) * texel + base;

    float sum = w0.x * w0.y * texture(shadow_map, vec3(o0.x, o0.y, depth));
    sum += 7.0 * w0.y * texture(shadow_map, vec3(o1.x, o0.y, depth));
    sum += w2.x * w0.y * texture(shadow_map, vec3(o2.x, o0.y, depth));
    sum += w0.x * 7.0 * texture(shadow_map, vec3(o0.x, o1.y, depth));
    sum += 49.0 * texture(shadow_map, vec3(o1.x, o1.y, depth));
    sum += w2.x * 7.0 * texture(shadow_map, vec3(o2.x, o1.y, depth));
    sum += w0.x * w2.y * texture(shadow_map, vec3(o0.x, o2.y, depth));
    sum += 7.0 * w2.y * texture(shadow_map, vec3(o1.x, o2.y, depth));
    sum += w2.x * w2.y * texture(shadow_map, vec3(o2.x, o2.y, depth));
    return sum / 144.0;
#endif
}

// `under` is how far the mesh lies below the surface it approximates there, in metres.
float light_reaching(vec3 position, vec3 normal, float under) {
    vec3 from = position + normal * (under + off_surface(normal));
    return light_at((shadow * vec4(from, 1.0)).xyz);
}

// Ambient light: white from above, cooler from the sides, dim and warm from the ground.
vec3 ambient_light(vec3 normal) {
    const vec3 above = vec3(1.0);
    const vec3 side = vec3(0.76, 0.785, 0.82);
    const vec3 below = vec3(0.48, 0.46, 0.44);
    vec3 other = normal.y > 0.0 ? above : below;
    return light.x * mix(side, other, normal.y * normal.y);
}

const vec3 light_colour = vec3(1.0, 0.98, 0.94);
