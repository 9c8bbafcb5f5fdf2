#version 450 core
// Second pass of the compute splat: of the source pixels that have a target pixel's key, the last one by index is shown.
// Without it those that tie would race, and the picture would differ from run to run.

#include "warp/splat.glsl"

layout(r32ui, binding = LW_WARP_INDEX_IMAGE) uniform uimage2D indices;  // source index + 1, 0 for a hole

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, source_size_px))) return;
    Splat splat;
    if (!make_splat(at, splat)) return;
    uint index = uint(at.y * source_size_px.x + at.x) + 1u;
    for (int y = splat.first.y; y < splat.last.y; ++y) {
        for (int x = splat.first.x; x < splat.last.x; ++x) {
            uint key = winner_key(splat.depth, vec2(x, y) + 0.5 - splat.place_px);
            if (imageLoad(keys, ivec2(x, y)).r == key) imageAtomicMax(indices, ivec2(x, y), index);
        }
    }
}
