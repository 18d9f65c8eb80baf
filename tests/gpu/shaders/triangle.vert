#version 460
// One triangle over the left half of the target: corners top left, bottom left, and a far right one cut by x < 0.
void main() {
    const vec2 corners[3] = vec2[](vec2(-1.0, -1.0), vec2(-1.0, 3.0), vec2(0.0, 1.0));
    gl_Position = vec4(corners[gl_VertexIndex], 0.5, 1.0);
}
