#version 450 core
// Depth alone is cleared: nobody looks at a texel without one.
void main() {}
