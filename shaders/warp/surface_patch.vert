#version 450 core
// Two triangles per patch: a piece of plane of one object, laid over the target.

#include "warp/source_layer.glsl"

layout(std430, binding = LW_WARP_PATCHES_BINDING) readonly buffer Patches { WarpPatch patches[]; };

uniform vec2 target_size_px;
uniform uint first_patch;

// For every target pixel of the patch to find its place in the source by itself, whatever the rasteriser rounds.
flat out uint patch_index;
flat out vec3 origin;   // where the patch's origin lands: x_px, y_px, w
flat out vec2 w_slope;  // of w, per source pixel
flat out mat2 inverse_map;
flat out float depth_factor;  // target depth = factor * share * source depth

const int kVertices = 6;
const vec2 kPlaces[kVertices] = vec2[](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));

// Larger than what the rasteriser's grid of 1/256 px can cut off; the fragment shader decides what is inside.
const float kMarginPx = 0.02;
// Target pixels per source pixel, in area, below which a plane counts as seen edge-on; negative: from its back.
const float kSmallestArea = 1e-4;

void skip() { gl_Position = vec4(2.0, 2.0, 0.0, 1.0); }

void main() {
    patch_index = first_patch + uint(gl_VertexID / kVertices);
    WarpPatch p = patches[patch_index];
    origin = vec3(0.0);
    w_slope = vec2(0.0);
    inverse_map = mat2(0.0);
    depth_factor = 0.0;
    if (!is_known(p.object_id)) {
        skip();
        return;
    }
    WarpObject object = objects[p.object_id];
    vec2 source_px = p.plane.xy + 0.5;
    vec3 h = homogeneous_target_px(object, source_px, p.plane.z);
    vec3 along_x = object.x.xyz + p.plane.w * object.z.xyz;
    vec3 along_y = object.y.xyz + p.gradient_y * object.z.xyz;

    origin = vec3(h.xy / h.z, h.z);
    w_slope = vec2(along_x.z, along_y.z);
    mat2 map = mat2(along_x.xy - origin.xy * along_x.z, along_y.xy - origin.xy * along_y.z);
    float area = determinant(map);
    // An origin behind the eye turns the sign; its visible part, if any, is cut out by the clipper.
    if (!(area * sign(h.z) > kSmallestArea * h.z * h.z)) {
        skip();
        return;
    }
    inverse_map = inverse(map);
    depth_factor = object.z.w / h.z;

    vec2 offset = mix(p.limits.xz - kMarginPx, p.limits.yw + kMarginPx, kPlaces[gl_VertexID % kVertices]);
    vec3 place = h + offset.x * along_x + offset.y * along_y;
    float depth = p.plane.z + p.plane.w * offset.x + p.gradient_y * offset.y;
    gl_Position = vec4(2.0 * place.x / target_size_px.x - place.z, place.z - 2.0 * place.y / target_size_px.y,
                       object.z.w * max(depth, 0.0), place.z);
}
