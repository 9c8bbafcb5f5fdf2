// IEC 61966-2-1 encoding of linear light in [0, 1]. Targets store the encoded value, so no pass needs
// GL_FRAMEBUFFER_SRGB and one texture serves as a target and as an sRGB texture.
vec3 srgb_from_linear(vec3 linear) {
    vec3 high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}
