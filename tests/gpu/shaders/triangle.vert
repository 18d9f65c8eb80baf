#version 460
// A triangle along the left edge of the target, reaching beyond its lower end; its right edge ends in the middle of the
// lower edge. Depth 0.5.
void main() {
    const vec2 corners[3] = vec2[](vec2(-1.0, -1.0), vec2(-1.0, 3.0), vec2(0.0, 1.0));
    gl_Position = vec4(corners[gl_VertexIndex], 0.5, 1.0);
}
