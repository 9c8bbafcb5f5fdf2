#version 450 core
// The sky, and the ground below the horizon. A part of the picture is drawn with the terms that show there.
#include "client_blocks.h"
#include "client/srgb.glsl"
#include "client/sky.glsl"
#include "client/tone.glsl"

layout(location = 0) out vec4 o_colour;

#ifndef GROUND
vec3 radiance_of(vec3 direction) {
#ifdef ABOVE
    return radiance_above(direction.y);
#else
    float cosine = max(dot(direction, frame.sun_direction.xyz), 0.0);
    vec3 radiance = sky_radiance(direction);
    radiance += frame.sun_irradiance.rgb * sun_glow(cosine);
#ifdef SUN
    radiance += frame.sun_irradiance.rgb * sun_halo_and_disc(cosine);
#endif
    return radiance;
#endif
}
#endif

void main() {
#ifdef GROUND
    vec3 radiance = kGround;
#else
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_per_px_x.xyz + gl_FragCoord.y * frame.ray_per_px_y.xyz;
    vec3 radiance = radiance_of(normalize(ray));
#endif
    o_colour = vec4(srgb_from_linear(displayed(radiance)), 1.0);
}
