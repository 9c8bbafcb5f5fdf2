// Light from the sky and the ground below the horizon, by direction in relative space. It depends on nothing else, so
// the sky turns with the head and never moves.

const vec3 kZenith = vec3(0.16, 0.34, 0.72);
const vec3 kHorizon = vec3(0.66, 0.76, 0.86);
const vec3 kGround = vec3(0.27, 0.25, 0.22);

// `up`: the y of a unit direction, at least 0.
vec3 radiance_above(float up) { return mix(kHorizon, kZenith, 1.0 - (1.0 - up) * (1.0 - up) * (1.0 - up)); }

// Without the sun. `direction` is unit.
vec3 sky_radiance(vec3 direction) {
    vec3 above = radiance_above(max(direction.y, 0.0));
    return mix(above, kGround, smoothstep(0.0, kHorizonBlend, -direction.y));
}

// Irradiance over pi: what a white diffuse surface with this normal shows of sky and ground.
vec3 ambient_radiance(vec3 normal) {
    return mix(vec3(0.21, 0.195, 0.175), vec3(0.42, 0.50, 0.62), 0.5 * normal.y + 0.5);
}

float to_the_eighth(float x) {
    float x2 = x * x;
    float x4 = x2 * x2;
    return x4 * x4;
}

// Shares of the sun's irradiance, by the cosine of the angle to it, at least 0. The disc is 2 degrees wide.
float sun_glow(float cosine) { return kSunGlow * to_the_eighth(cosine); }

float sun_halo_and_disc(float cosine) {
    float c8 = to_the_eighth(cosine);
    float c32 = c8 * c8 * c8 * c8;
    return kSunHalo * (c32 * c32 * c32) + smoothstep(0.99980, 0.99990, cosine);
}
