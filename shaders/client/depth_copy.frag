#version 450 core
// A depth texture as colour: a layer's depth is R32F.
#include "client_blocks.h"

layout(binding = kUnitSource) uniform sampler2D u_source;
layout(location = 0) out float o_depth;

void main() {
    o_depth = texelFetch(u_source, ivec2(gl_FragCoord.xy), 0).r;
}
