// Light from the sky and the ground below the horizon, by direction in relative space. It depends on nothing else, so
// the sky turns with the head and never moves.

const vec3 kZenith = vec3(0.16, 0.34, 0.72);
const vec3 kHorizon = vec3(0.66, 0.76, 0.86);
const vec3 kGround = vec3(0.27, 0.25, 0.22);

// Without the sun's disc. `direction` is unit.
vec3 sky_radiance(vec3 direction) {
    float up = max(direction.y, 0.0);
    vec3 above = mix(kHorizon, kZenith, 1.0 - (1.0 - up) * (1.0 - up) * (1.0 - up));
    return mix(above, kGround, smoothstep(0.0, 0.06, -direction.y));
}

// Irradiance over pi: what a white diffuse surface with this normal shows of sky and ground.
vec3 ambient_radiance(vec3 normal) {
    return mix(vec3(0.21, 0.195, 0.175), vec3(0.42, 0.50, 0.62), 0.5 * normal.y + 0.5);
}

// The disc is 2 degrees wide, with a glow around it.
vec3 sun_radiance(vec3 direction, vec3 sun_direction, vec3 sun_irradiance) {
    float cosine = max(dot(direction, sun_direction), 0.0);
    float disc = smoothstep(0.99980, 0.99990, cosine);
    float c2 = cosine * cosine;
    float c8 = c2 * c2 * c2 * c2;
    float c32 = c8 * c8 * c8 * c8;
    return sun_irradiance * (disc + 0.12 * c32 * c32 * c32 + 0.04 * c8);
}
