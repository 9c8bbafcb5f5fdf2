#version 450 core

flat in vec4 point_colour;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint coverage;  // lw::Coverage::reached

void main() {
    colour = vec4(point_colour.rgb, 1.0);  // a display has no alpha
    coverage = 1u;
}
