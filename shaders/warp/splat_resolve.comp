#version 450 core
// Last pass of the compute splat: each target pixel shows its source pixel.

#include "warp/source_layer.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(r32ui, binding = LW_WARP_INDEX_IMAGE) readonly uniform uimage2D indices;
layout(rgba8, binding = LW_WARP_COLOUR_IMAGE) writeonly uniform image2D colour;
layout(r32f, binding = LW_WARP_DEPTH_IMAGE) writeonly uniform image2D depth;
layout(r8ui, binding = LW_WARP_COVERAGE_IMAGE) writeonly uniform uimage2D coverage;

uniform ivec2 source_size_px;
uniform ivec2 target_size_px;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, target_size_px))) return;
    uint index = imageLoad(indices, pixel).r;
    if (index == 0u) {
        imageStore(colour, pixel, vec4(0.0));
        imageStore(depth, pixel, vec4(0.0));
        imageStore(coverage, pixel, uvec4(0u));
        return;
    }
    int source = int(index - 1u);
    ivec2 at = ivec2(source % source_size_px.x, source / source_size_px.x);
    WarpObject object = objects[texelFetch(source_object_id, at, 0).r];
    float source_z = texelFetch(source_depth, at, 0).r;
    vec3 h = homogeneous_target_px(object, vec2(at) + 0.5, source_z);
    imageStore(colour, pixel, vec4(texelFetch(source_colour, at, 0).rgb, 1.0));
    imageStore(depth, pixel, vec4(object.z.w * source_z / h.z));
    imageStore(coverage, pixel, uvec4(1u));  // lw::Coverage::reached
}
