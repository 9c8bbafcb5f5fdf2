#version 450 core

flat in vec4 point_colour;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint coverage;  // lw::Coverage::reached

void main() {
    colour = point_colour;
    coverage = 1u;
}
