// What the fragment shaders of a patch share: the exact place in the source of a target pixel on the patch's plane.

#include "warp_blocks.h"

layout(std430, binding = LW_WARP_PATCHES_BINDING) readonly buffer Patches { WarpPatch patches[]; };

flat in uint patch_index;
flat in vec3 origin;
flat in vec2 w_slope;
flat in mat2 inverse_map;
flat in float depth_factor;

// The plane's homography, solved: with e from the origin's place, k = inverse_map * e, share = 1 - w_slope . k, the
// offset in the source is w / share * k. False outside of the patch, behind the eye and before the near plane.
bool solve(WarpPatch p, vec2 target_px, out vec2 offset_px, out float target_depth) {
    vec2 k = inverse_map * (target_px - origin.xy);
    float share = 1.0 - dot(w_slope, k);
    float place_w = origin.z / share;
    offset_px = place_w * k;
    float source_depth = p.plane.z + p.plane.w * offset_px.x + p.gradient_y * offset_px.y;
    target_depth = max(depth_factor * share * source_depth, 0.0);
    return all(greaterThanEqual(offset_px, p.limits.xz)) && all(lessThanEqual(offset_px, p.limits.yw)) &&
           place_w > 0.0 && target_depth <= 1.0;
}
