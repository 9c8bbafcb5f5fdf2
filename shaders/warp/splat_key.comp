#version 450 core
// First pass of the compute splat: each target pixel learns the key of the source pixel it will show.

#include "warp/splat.glsl"

void count_if_bad(ivec2 at) {
    if (!is_known(texelFetch(source_object_id, at, 0).r)) {
        atomicAdd(unknown_object_count, 1u);
    } else if (!is_usable_depth(texelFetch(source_depth, at, 0).r)) {
        atomicAdd(bad_depth_count, 1u);
    }
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, source_size_px))) return;
    Splat splat;
    if (!make_splat(at, splat)) {
        count_if_bad(at);
        return;
    }
    for (int y = splat.first.y; y < splat.last.y; ++y) {
        for (int x = splat.first.x; x < splat.last.x; ++x) {
            imageAtomicMax(keys, ivec2(x, y), winner_key(splat.depth, vec2(x, y) + 0.5 - splat.place_px));
        }
    }
}
