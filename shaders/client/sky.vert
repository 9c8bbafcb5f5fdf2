#version 450 core
// A part of the picture at depth 0: with GL_EQUAL it draws where nothing was drawn.
#include "client_blocks.h"

layout(location = kAttributeSkyCorner) in vec2 a_corner_ndc;

void main() { gl_Position = vec4(a_corner_ndc, 0.0, 1.0); }
