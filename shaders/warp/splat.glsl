// Common to the passes of the compute splat: one invocation per source pixel visits the target pixels that its point
// covers. The winner rule is that of warp_server/methods/winner_rule.h, cut to 32 bits: from the top
//   15 bits  depth step (0.4 %), nearer wins,
//    8 bits  closeness to the pixel centre, 1 to 255, so no key is 0,
//    9 bits  what follows in the depth.

#include "warp/source_layer.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(r32ui, binding = LW_WARP_KEY_IMAGE) uniform uimage2D keys;

uniform ivec2 source_size_px;
uniform ivec2 target_size_px;

#include "warp/footprint.glsl"

const float kFarthestTold2_px = 4.0;

uint winner_key(float depth, vec2 offset_px) {
    uint bits = floatBitsToUint(depth);
    uint farness = uint(min(254.0, dot(offset_px, offset_px) * (254.0 / kFarthestTold2_px)));
    return ((bits >> 15) << 17) | ((255u - farness) << 9) | ((bits & 0x7FFFu) >> 6);
}

// A source pixel's point in the target.
struct Splat {
    vec2 place_px;
    float depth;
    ivec2 first;  // target pixels [first, last)
    ivec2 last;
};

// False where there is nothing to draw.
bool make_splat(ivec2 at, out Splat splat) {
    uint object_id = texelFetch(source_object_id, at, 0).r;
    float depth = texelFetch(source_depth, at, 0).r;
    if (!is_known(object_id) || !is_usable_depth(depth)) return false;
    WarpObject object = objects[object_id];
    vec3 h = homogeneous_target_px(object, vec2(at) + 0.5, depth);
    if (!(h.z > 0.0)) return false;
    splat.place_px = h.xy / h.z;
    splat.depth = object.z.w * depth / h.z;
    if (splat.depth > 1.0) return false;
    vec2 half_px = half_extent_px(object, at, object_id, depth, h);
    // Pixels whose centres lie in [place - half, place + half); clamped before the conversion, which is undefined for
    // large numbers.
    vec2 limit = vec2(target_size_px);
    splat.first = ivec2(clamp(ceil(splat.place_px - half_px - 0.5), vec2(0.0), limit));
    splat.last = ivec2(clamp(ceil(splat.place_px + half_px - 0.5), vec2(0.0), limit));
    return true;
}
