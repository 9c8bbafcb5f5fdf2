#version 450 core
// One surface of a cell in which surfaces meet: weighs its own corners alone, and covers as much as they weigh. What
// covers a part of a pixel is kept in a list per pixel until all is known.

#include "warp/surface_patch.glsl"

layout(binding = LW_WARP_SMOOTH_COLOUR_UNIT) uniform sampler2D smooth_colour;
layout(binding = LW_WARP_DRAWN_DEPTH_UNIT) uniform sampler2D drawn_depth;
layout(binding = LW_WARP_DRAWN_COVERAGE_UNIT) uniform usampler2D drawn_coverage;
layout(r32ui, binding = LW_WARP_INDEX_IMAGE) uniform uimage2D newest_fragment;  // of each pixel

layout(std430, binding = LW_WARP_FRAGMENTS_BINDING) buffer Fragments {
    uint fragment_count;  // goes on counting when the list is full
    WarpFragment fragments[];
};

const float kSmallestCoverage = 1.0 / 512.0;  // less changes no 8-bit colour

void main() {
    WarpPatch p = patches[patch_index];
    vec2 offset_px;
    float target_depth;
    if (!solve(p, gl_FragCoord.xy, offset_px, target_depth)) return;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bool is_drawn = texelFetch(drawn_coverage, pixel, 0).r != 0u;
    if (is_drawn && texelFetch(drawn_depth, pixel, 0).r >= target_depth) return;

    vec2 at = clamp(offset_px, 0.0, 1.0);
    vec4 weights = vec4((1.0 - at.x) * (1.0 - at.y), at.x * (1.0 - at.y), (1.0 - at.x) * at.y, at.x * at.y);
    ivec2 first = ivec2(p.plane.xy);
    ivec2 last = textureSize(smooth_colour, 0) - 1;
    vec3 linear = vec3(0.0);
    float coverage = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        if ((p.corners >> corner & 1u) == 0u) continue;
        ivec2 source = min(first + ivec2(corner & 1, corner >> 1), last);
        coverage += weights[corner];
        linear += weights[corner] * texelFetch(smooth_colour, source, 0).rgb;
    }
    if (coverage < kSmallestCoverage) return;
    uint index = atomicAdd(fragment_count, 1u);
    if (index >= uint(fragments.length())) return;
    fragments[index].linear_coverage = vec4(linear / coverage, coverage);
    fragments[index].depth = target_depth;
    fragments[index].next = imageAtomicExchange(newest_fragment, pixel, index);
}
