#version 450 core
#include "client_blocks.h"
#include "client/srgb.glsl"
#include "client/sky.glsl"
#include "client/tone.glsl"

layout(location = 0) out vec4 o_colour;

void main() {
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_per_px_x.xyz + gl_FragCoord.y * frame.ray_per_px_y.xyz;
    vec3 direction = normalize(ray);
    vec3 radiance = sky_radiance(direction) +
                    sun_radiance(direction, frame.sun_direction.xyz, frame.sun_irradiance.rgb);
    o_colour = vec4(srgb_from_linear(displayed(radiance)), 1.0);
}
