// White, which blending adds as much of as there is: the picture twice as bright.
#version 460

layout(location = 0) out vec4 outColor;

void main() { outColor = vec4(1.0); }
