#version 450 core
// Counts the source pixels that cannot be warped, for methods that do not visit each source pixel exactly once.

#include "warp/source_layer.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

uniform ivec2 source_size_px;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, source_size_px))) return;
    if (!is_known(texelFetch(source_object_id, at, 0).r)) {
        atomicAdd(unknown_object_count, 1u);
    } else if (!is_usable_depth(texelFetch(source_depth, at, 0).r)) {
        atomicAdd(bad_depth_count, 1u);
    }
}
