#version 450 core
// Quads over slots, two triangles each, at depth 0: one draw clears any number of them.
layout(location = 0) in vec4 a_rect_ndc;  // left, bottom, right, top; per instance

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(mix(a_rect_ndc.xy, a_rect_ndc.zw, corner), 0.0, 1.0);
}
