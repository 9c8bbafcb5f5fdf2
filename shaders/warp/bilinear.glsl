// Colours between source pixels, bilinear in linear light, as stored bytes again.
// Needs warp/source_layer.glsl and a uniform source_size_px.

#include "warp/srgb.glsl"

// Exactly the stored colour at a pixel's centre, and where all four agree.
vec3 bilinear_colour(vec2 source_px) {
    vec2 place = clamp(source_px - 0.5, vec2(0.0), vec2(source_size_px - 1));
    ivec2 at = ivec2(place);
    ivec2 next = min(at + 1, source_size_px - 1);
    vec2 fraction = place - vec2(at);
    vec3 c00 = texelFetch(source_colour, at, 0).rgb;
    if (fraction == vec2(0.0)) return c00;
    vec3 c10 = texelFetch(source_colour, ivec2(next.x, at.y), 0).rgb;
    vec3 c01 = texelFetch(source_colour, ivec2(at.x, next.y), 0).rgb;
    vec3 c11 = texelFetch(source_colour, next, 0).rgb;
    if (c00 == c10 && c00 == c01 && c00 == c11) return c00;
    vec3 top = mix(linear_from_srgb(c00), linear_from_srgb(c10), fraction.x);
    vec3 bottom = mix(linear_from_srgb(c01), linear_from_srgb(c11), fraction.x);
    return srgb_from_linear(mix(top, bottom, fraction.y));
}
