#version 450 core
// One point per source pixel.

#include "warp/source_layer.glsl"

uniform ivec2 source_size_px;
uniform vec2 target_size_px;
uniform float size_px;  // 0: as large as the pixel's surface appears

flat out vec4 point_colour;

const float kLargestSizePx = 4.0;
const float kSameSurfaceDepthPart = 0.03;  // warp_server/methods/splat_footprint.h
const float kOtherSurface = 8.0;           // farther from any depth than that part

float neighbour_depth(ivec2 at, uint object_id) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, source_size_px))) return kOtherSurface;
    if (texelFetch(source_object_id, at, 0).r != object_id) return kOtherSurface;
    float depth = texelFetch(source_depth, at, 0).r;
    return is_usable_depth(depth) ? depth : kOtherSurface;
}

float one_sided_difference(float depth, float before, float after) {
    float to_before = depth - before;
    float to_after = after - depth;
    float smaller = abs(to_before) < abs(to_after) ? to_before : to_after;
    return abs(smaller) < kSameSurfaceDepthPart * depth ? smaller : 0.0;
}

// Side of the square that leaves no cracks: the row sums of the absolute Jacobian d(target px) / d(source px).
float projected_size_px(WarpObject object, ivec2 at, uint object_id, float depth, vec3 h) {
    vec2 gradient = vec2(one_sided_difference(depth, neighbour_depth(at - ivec2(1, 0), object_id),
                                              neighbour_depth(at + ivec2(1, 0), object_id)),
                         one_sided_difference(depth, neighbour_depth(at - ivec2(0, 1), object_id),
                                              neighbour_depth(at + ivec2(0, 1), object_id)));
    vec3 along_x = object.x.xyz + gradient.x * object.z.xyz;
    vec3 along_y = object.y.xyz + gradient.y * object.z.xyz;
    vec2 place = h.xy / h.z;
    vec2 jacobian_x = (along_x.xy - place * along_x.z) / h.z;
    vec2 jacobian_y = (along_y.xy - place * along_y.z) / h.z;
    vec2 extent = abs(jacobian_x) + abs(jacobian_y);
    return clamp(max(extent.x, extent.y), 1.0, kLargestSizePx);
}

// Outside of the clip volume whatever the depth.
void skip() { gl_Position = vec4(2.0, 2.0, 0.0, 1.0); }

void main() {
    point_colour = vec4(0.0);
    gl_PointSize = 1.0;
    ivec2 at = ivec2(gl_VertexID % source_size_px.x, gl_VertexID / source_size_px.x);
    uint object_id = texelFetch(source_object_id, at, 0).r;
    if (!is_known(object_id)) {
        atomicAdd(unknown_object_count, 1u);
        skip();
        return;
    }
    float depth = texelFetch(source_depth, at, 0).r;
    if (!is_usable_depth(depth)) {
        atomicAdd(bad_depth_count, 1u);
        skip();
        return;
    }
    WarpObject object = objects[object_id];
    vec3 h = homogeneous_target_px(object, vec2(at) + 0.5, depth);
    if (!(h.z > 0.0)) {  // behind the target eye
        skip();
        return;
    }
    point_colour = texelFetch(source_colour, at, 0);
    gl_PointSize = size_px > 0.0 ? size_px : projected_size_px(object, at, object_id, depth, h);
    // Row 0 is on top: y_px = (1 - y_ndc) / 2 * height. The near plane clips by z > w.
    gl_Position = vec4(2.0 * h.x / target_size_px.x - h.z, h.z - 2.0 * h.y / target_size_px.y, object.z.w * depth, h.z);
}
