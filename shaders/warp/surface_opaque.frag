#version 450 core
// A patch that covers its target pixels wholly.

#include "warp/surface_patch.glsl"

layout(binding = LW_WARP_SMOOTH_COLOUR_UNIT) uniform sampler2D smooth_colour;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint coverage;  // lw::Coverage::reached

void main() {
    WarpPatch p = patches[patch_index];
    vec2 offset_px;
    float target_depth;
    if (!solve(p, gl_FragCoord.xy, offset_px, target_depth)) discard;
    vec2 source_px = p.plane.xy + 0.5 + offset_px;
    colour = vec4(textureLod(smooth_colour, source_px / vec2(textureSize(smooth_colour, 0)), 0.0).rgb, 1.0);
    coverage = 1u;
}
