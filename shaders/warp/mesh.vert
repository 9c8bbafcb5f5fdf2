#version 450 core
// One vertex per source pixel centre, and a ring of vertices on the picture's border that repeat the outermost pixels,
// so that the sheet covers the whole picture. Vertex (0, 0) is the border's corner, vertex (1, 1) pixel (0, 0).

#include "warp/source_layer.glsl"

uniform ivec2 source_size_px;
uniform vec2 target_size_px;

out vec2 source_px;
out float usable;  // below 1 wherever a corner of the triangle is not

void main() {
    ivec2 size_vertices = source_size_px + 2;
    ivec2 vertex = ivec2(gl_VertexID % size_vertices.x, gl_VertexID / size_vertices.x);
    ivec2 at = clamp(vertex - 1, ivec2(0), source_size_px - 1);
    source_px = clamp(vec2(vertex) - 0.5, vec2(0.0), vec2(source_size_px));

    uint object_id = texelFetch(source_object_id, at, 0).r;
    float depth = texelFetch(source_depth, at, 0).r;
    bool known = is_known(object_id);
    bool usable_depth = is_usable_depth(depth);
    usable = known && usable_depth ? 1.0 : 0.0;

    WarpObject object = objects[known ? object_id : 0u];
    float safe_depth = usable_depth ? depth : 0.0;
    vec3 h = homogeneous_target_px(object, source_px, safe_depth);
    // Row 0 is on top: y_px = (1 - y_ndc) / 2 * height. The near plane clips by z > w, also what is behind the eye.
    gl_Position =
        vec4(2.0 * h.x / target_size_px.x - h.z, h.z - 2.0 * h.y / target_size_px.y, object.z.w * safe_depth, h.z);
}
