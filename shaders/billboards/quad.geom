#version 450 core
// Makes the quad of a billboard from its one vertex.
#include "billboard_blocks.h"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(std430, binding = kBindingBillboards) readonly buffer Billboards { BillboardRecord billboards[]; };
flat in uint p_billboard[];

#include "billboards/corner.glsl"

void main() {
    BillboardRecord billboard = billboards[p_billboard[0]];
    for (int k = 0; k < 4; ++k) {
        emit_corner(billboard, vec2(k & 1, k >> 1) * 2.0 - 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
