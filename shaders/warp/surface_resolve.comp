#version 450 core
// Puts what covers pixels in part over what covers them wholly. The CPU's twin is warp_server/methods/surface_canvas.cpp.

#include "warp_blocks.h"
#include "warp/srgb.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(binding = LW_WARP_DRAWN_COLOUR_UNIT) uniform sampler2D drawn_colour;
layout(binding = LW_WARP_DRAWN_DEPTH_UNIT) uniform sampler2D drawn_depth;
layout(binding = LW_WARP_DRAWN_COVERAGE_UNIT) uniform usampler2D drawn_coverage;
layout(r32ui, binding = LW_WARP_INDEX_IMAGE) readonly uniform uimage2D newest_fragment;
layout(rgba8, binding = LW_WARP_COLOUR_IMAGE) writeonly uniform image2D colour;
layout(r32f, binding = LW_WARP_DEPTH_IMAGE) writeonly uniform image2D depth;
layout(r8ui, binding = LW_WARP_COVERAGE_IMAGE) writeonly uniform uimage2D coverage;

layout(std430, binding = LW_WARP_FRAGMENTS_BINDING) readonly buffer Fragments {
    uint fragment_count;
    WarpFragment fragments[];
};

uniform ivec2 target_size_px;

// A total order, so that the picture does not depend on the order in which fragments arrived: nearer first. Those that
// only their indices tell apart are equal, so their order does not matter either.
bool comes_before(uint a, uint b) {
    if (fragments[a].depth != fragments[b].depth) return fragments[a].depth > fragments[b].depth;
    vec4 x = fragments[a].linear_coverage.wxyz;
    vec4 y = fragments[b].linear_coverage.wxyz;
    for (int i = 0; i < 4; ++i) {
        if (x[i] != y[i]) return x[i] > y[i];
    }
    return a < b;
}

// The first fragment of a pixel's list in order, or the first one after `last`; kNoFragment at the end. Lists are two or
// three long: searching them again and again is cheaper than keeping them sorted.
uint next_in_order(uint newest, uint last) {
    uint next = kNoFragment;
    for (uint i = newest; i != kNoFragment; i = fragments[i].next) {
        bool is_later = last == kNoFragment || comes_before(last, i);
        if (is_later && (next == kNoFragment || comes_before(i, next))) next = i;
    }
    return next;
}

void write(ivec2 pixel, vec3 linear, float shown_depth, bool reached) {
    imageStore(colour, pixel, reached ? vec4(srgb_from_linear(clamp(linear, 0.0, 1.0)), 1.0) : vec4(0.0));
    imageStore(depth, pixel, vec4(shown_depth));
    imageStore(coverage, pixel, uvec4(reached ? 1u : 0u));  // lw::Coverage
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, target_size_px))) return;
    bool is_drawn = texelFetch(drawn_coverage, pixel, 0).r != 0u;
    vec3 drawn_linear = texelFetch(drawn_colour, pixel, 0).rgb;
    float shown_depth = texelFetch(drawn_depth, pixel, 0).r;

    uint newest = imageLoad(newest_fragment, pixel).r;
    float covered = is_drawn ? 1.0 : 0.0;
    for (uint i = newest; i != kNoFragment; i = fragments[i].next) covered += fragments[i].linear_coverage.w;
    if (newest == kNoFragment || covered < 0.5) {  // of what is hardly covered the fill knows more
        write(pixel, drawn_linear, shown_depth, is_drawn);
        return;
    }
    vec3 sum = vec3(0.0);
    float left = 1.0;
    float largest_share = 0.0;
    uint after = kNoFragment;
    for (uint i = next_in_order(newest, kNoFragment); i != kNoFragment; i = after) {
        after = next_in_order(newest, i);
        vec4 linear_coverage = fragments[i].linear_coverage;
        // The surfaces of one place fill it together: the farthest takes what is left.
        bool takes_rest = !is_drawn && after == kNoFragment;
        float share = takes_rest ? left : left * linear_coverage.w;
        sum += share * linear_coverage.xyz;
        left -= share;
        if (share > largest_share) {
            largest_share = share;
            shown_depth = fragments[i].depth;
        }
    }
    if (is_drawn) {
        sum += left * drawn_linear;
        if (left >= largest_share) shown_depth = texelFetch(drawn_depth, pixel, 0).r;
    }
    write(pixel, sum, shown_depth, true);
}
