#version 450 core
// Quads of two triangles, by instances or by counting vertices.
#include "billboard_blocks.h"

layout(std430, binding = kBindingBillboards) readonly buffer Billboards { BillboardRecord billboards[]; };
layout(std430, binding = kBindingActive) readonly buffer Active { uint active_index[]; };
uniform int u_first;

#include "billboards/corner.glsl"

void main() {
#ifdef INSTANCED
    int place = gl_InstanceID;
    int k = gl_VertexID;  // a strip of four
    vec2 corner = vec2(k & 1, k >> 1);
#else
    int place = gl_VertexID / 6;
    int k = gl_VertexID - 6 * place;  // 0 1 2, 2 1 3
    int strip = k < 3 ? k : (k == 3 ? 2 : k - 3);
    vec2 corner = vec2(strip & 1, strip >> 1);
    if (k == 5) corner = vec2(1.0);
#endif
    emit_corner(billboards[active_index[u_first + place]], corner * 2.0 - 1.0);
}
