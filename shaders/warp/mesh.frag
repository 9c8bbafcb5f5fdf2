#version 450 core

#include "warp_blocks.h"

layout(binding = LW_WARP_SMOOTH_COLOUR_UNIT) uniform sampler2D smooth_colour;

in vec2 source_px;
in float usable;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint coverage;  // lw::Coverage::reached

void main() {
    // Interpolation of three ones may miss 1 by its rounding.
    if (usable < 0.9999) discard;
    colour = vec4(texture(smooth_colour, source_px / vec2(textureSize(smooth_colour, 0))).rgb, 1.0);
    coverage = 1u;
}
