#version 450 core
// One point per source pixel.

#include "warp/source_layer.glsl"

uniform ivec2 source_size_px;
uniform vec2 target_size_px;
uniform float size_px;  // 0: as large as the pixel's surface appears

flat out vec4 point_colour;

#include "warp/footprint.glsl"

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
    gl_PointSize = size_px;
    if (size_px == 0.0) {
        vec2 half_px = half_extent_px(object, at, object_id, depth, h);
        gl_PointSize = 2.0 * max(half_px.x, half_px.y);  // points are squares
    }
    // Row 0 is on top: y_px = (1 - y_ndc) / 2 * height. The near plane clips by z > w.
    gl_Position = vec4(2.0 * h.x / target_size_px.x - h.z, h.z - 2.0 * h.y / target_size_px.y, object.z.w * depth, h.z);
}
