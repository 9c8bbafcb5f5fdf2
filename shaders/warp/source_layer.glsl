// A source layer and the matrices of its objects; counts what cannot be warped.

#include "warp_blocks.h"

layout(binding = LW_WARP_COLOUR_UNIT) uniform sampler2D source_colour;
layout(binding = LW_WARP_DEPTH_UNIT) uniform sampler2D source_depth;
layout(binding = LW_WARP_OBJECT_ID_UNIT) uniform usampler2D source_object_id;

layout(std430, binding = LW_WARP_OBJECTS_BINDING) readonly buffer Objects { WarpObject objects[]; };
layout(std430, binding = LW_WARP_COUNTERS_BINDING) buffer Counters {
    uint bad_depth_count;
    uint unknown_object_count;
};

// NaN fails both comparisons.
bool is_usable_depth(float depth) { return depth >= 0.0 && depth <= 1.0; }

bool is_known(uint object_id) { return object_id < uint(objects.length()) && objects[object_id].one.w != 0.0; }

// (x, y, w) of the homogeneous target pixel.
vec3 homogeneous_target_px(WarpObject object, vec2 source_px, float depth) {
    return object.x.xyz * source_px.x + object.y.xyz * source_px.y + object.one.xyz + object.z.xyz * depth;
}
