#version 450 core
// Takes the lights out of each tile's mask that reach none of the depths drawn there: what looks down a street sees a
// lamp in the air before it in most tiles, and few of them are lit by it. One work group per tile, one invocation per
// column of pixels.
#include "client_blocks.h"

layout(local_size_x = kLightTilePx) in;

layout(binding = kUnitGDepth) uniform sampler2D u_depth;
layout(std430, binding = kBindingTiles) buffer Tiles { uvec2 tile_lights[]; };

// Positive floats are ordered as their bits are.
shared uint s_nearest_bits;   // largest depth
shared uint s_farthest_bits;  // smallest depth of a surface
shared uint s_mask[2];

void keep_if_reached(uint light, float nearest_m, float farthest_m) {
    vec4 position_range = lights.position_range[light];
    float distance_m = dot(frame.clip_w.xyz, position_range.xyz);
    // A thousandth more for rounding: beyond its range a light adds exactly nothing.
    float reach_m = position_range.w * 1.001 + 1e-3 * abs(distance_m);
    if (distance_m - reach_m <= farthest_m && distance_m + reach_m >= nearest_m) {
        atomicOr(s_mask[light / 32u], 1u << (light % 32u));
    }
}

void main() {
    uint column = gl_LocalInvocationID.x;
    if (column == 0u) {
        s_nearest_bits = 0u;
        s_farthest_bits = 0xFFFFFFFFu;
        s_mask[0] = 0u;
        s_mask[1] = 0u;
    }
    barrier();

    ivec2 size_px = textureSize(u_depth, 0);
    ivec2 pixel = ivec2(gl_WorkGroupID.xy) * kLightTilePx + ivec2(column, 0);
    int end_y = min(pixel.y + kLightTilePx, size_px.y);
    float nearest = 0.0;
    float farthest = 2.0;
    if (pixel.x < size_px.x) {
        for (; pixel.y < end_y; ++pixel.y) {
            float depth = texelFetch(u_depth, pixel, 0).r;
            nearest = max(nearest, depth);
            farthest = min(farthest, depth > 0.0 ? depth : 2.0);
        }
    }
    atomicMax(s_nearest_bits, floatBitsToUint(nearest));
    atomicMin(s_farthest_bits, floatBitsToUint(farthest));
    barrier();

    if (s_nearest_bits != 0u) {
        float nearest_m = frame.near_m.x / uintBitsToFloat(s_nearest_bits);
        float farthest_m = frame.near_m.x / uintBitsToFloat(s_farthest_bits);
        keep_if_reached(column, nearest_m, farthest_m);
        keep_if_reached(column + 32u, nearest_m, farthest_m);
    }
    barrier();

    if (column == 0u) {
        uint tile = gl_WorkGroupID.y * uint(frame.tiles.x) + gl_WorkGroupID.x;
        tile_lights[tile] &= uvec2(s_mask[0], s_mask[1]);
    }
}
