// The world's picture, interpolated; at an even division of its size, the mean.
#version 460

layout(set = 0, binding = 0) uniform sampler2D world;
layout(location = 0) in vec2 inSt;
layout(location = 0) out vec4 outColor;

void main() { outColor = texture(world, inSt); }
