#version 450 core
// Deferred light of the surfaces in the G-buffer.
#include "client_blocks.h"
#include "client/surface_light.glsl"

layout(binding = kUnitGAlbedo) uniform sampler2D u_albedo_roughness;
layout(binding = kUnitGNormal) uniform sampler2D u_normal;
layout(binding = kUnitGEmissive) uniform sampler2D u_emissive_metallic;
layout(binding = kUnitGDepth) uniform sampler2D u_depth;

layout(location = 0) out vec4 o_colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 shown = lit_surface(texelFetch(u_albedo_roughness, pixel, 0), texelFetch(u_normal, pixel, 0).rg,
                             texelFetch(u_emissive_metallic, pixel, 0), texelFetch(u_depth, pixel, 0).r);
    o_colour = vec4(shown, 1.0);
}
