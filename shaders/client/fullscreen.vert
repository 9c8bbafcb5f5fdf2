#version 450 core
// One triangle over everything, at depth 0: with GL_LESS it draws where something was drawn, with GL_EQUAL where nothing
// was.
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
