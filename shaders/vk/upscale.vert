// A rectangle over the viewport, and the part of the world's picture that it shows.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(push_constant, scalar) uniform Push {
    vec2 origin;
    vec2 size;
} part;
layout(location = 0) out vec2 outSt;

void main() {
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
    outSt = part.origin + corner * part.size;
}
