#version 450 core
// One vertex per billboard, for the geometry shader.
flat out uint p_billboard;

void main() {
    p_billboard = uint(gl_VertexID);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
