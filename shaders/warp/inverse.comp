#version 450 core
// For each target pixel a fixed-point search for the source place that lands on it: s += p - q(s). The CPU's twin is
// warp_server/methods/inverse.cpp.

#include "warp/source_layer.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(rgba8, binding = LW_WARP_COLOUR_IMAGE) writeonly uniform image2D colour;
layout(r32f, binding = LW_WARP_DEPTH_IMAGE) writeonly uniform image2D depth;
layout(r8ui, binding = LW_WARP_COVERAGE_IMAGE) writeonly uniform uimage2D coverage;

uniform ivec2 source_size_px;
uniform ivec2 target_size_px;
uniform mat3 source_px_from_target_px;  // of things infinitely far away: where the search begins
uniform int steps;

#include "warp/bilinear.glsl"

const float kAcceptedErrorPx = 1.0;

// Depth after placing, or below 0 for pixels that cannot be placed.
float place(vec2 source_px, out vec2 target_px) {
    ivec2 at = ivec2(source_px);
    uint object_id = texelFetch(source_object_id, at, 0).r;
    float source_z = texelFetch(source_depth, at, 0).r;
    if (!is_known(object_id) || !is_usable_depth(source_z)) return -1.0;
    WarpObject object = objects[object_id];
    vec3 h = homogeneous_target_px(object, source_px, source_z);
    if (!(h.z > 0.0)) return -1.0;
    target_px = h.xy / h.z;
    return object.z.w * source_z / h.z;
}

// False when no surface was found.
bool search(vec2 target_px, out vec2 source_px, out float target_depth) {
    vec3 h = source_px_from_target_px * vec3(target_px, 1.0);
    if (!(h.z > 0.0)) return false;
    vec2 limit = vec2(source_size_px) - 1e-3;
    source_px = clamp(h.xy / h.z, vec2(0.0), limit);
    for (int taken = 0;; ++taken) {
        vec2 landed_px;
        target_depth = place(source_px, landed_px);
        if (target_depth < 0.0) return false;
        vec2 error_px = target_px - landed_px;
        if (taken == steps) return target_depth <= 1.0 && dot(error_px, error_px) <= kAcceptedErrorPx * kAcceptedErrorPx;
        source_px = clamp(source_px + error_px, vec2(0.0), limit);
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, target_size_px))) return;
    vec2 source_px;
    float target_depth;
    bool reached = search(vec2(pixel) + 0.5, source_px, target_depth);
    imageStore(colour, pixel, reached ? vec4(bilinear_colour(source_px), 1.0) : vec4(0.0));
    imageStore(depth, pixel, vec4(reached ? target_depth : 0.0));
    imageStore(coverage, pixel, uvec4(reached ? 1u : 0u));  // lw::Coverage
}
