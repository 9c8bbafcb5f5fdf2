// IEC 61966-2-1 encoding of linear light in [0, 1]. Targets store the encoded value, so no pass needs
// GL_FRAMEBUFFER_SRGB and one texture serves as a target and as an sRGB texture.
vec3 srgb_from_linear(vec3 linear) {
    // 1.055 x^(1/2.4) - 0.055 as a polynomial of x^(1/4), off by 1.4e-6 at most: 0.0004 of a level of 255. A software GL
    // takes a quarter of the time of a power for it, and the power was half of what the sky cost.
    vec3 t = sqrt(sqrt(linear));
    vec3 high = 0.06820781 * t - 0.31841536;
    high = high * t + 0.65718737;
    high = high * t - 0.85295676;
    high = high * t + 1.36592077;
    high = high * t + 0.13960419;
    high = high * t - 0.05954661;
    return mix(high, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}
