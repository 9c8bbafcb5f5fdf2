#version 450 core
// Box average of NxN samples in linear light: the source is an sRGB texture, so a fetch is linear already.
#include "client_blocks.h"
#include "client/srgb.glsl"

layout(binding = kUnitSource) uniform sampler2D u_source;
uniform int u_samples_per_axis;
layout(location = 0) out vec4 o_colour;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * u_samples_per_axis;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < u_samples_per_axis; ++y) {
        for (int x = 0; x < u_samples_per_axis; ++x) sum += texelFetch(u_source, first + ivec2(x, y), 0).rgb;
    }
    o_colour = vec4(srgb_from_linear(sum / float(u_samples_per_axis * u_samples_per_axis)), 1.0);
}
