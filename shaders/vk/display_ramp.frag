// The finished picture through a table of bytes, as a display's gamma ramp shows it.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 0, binding = 1, scalar) readonly buffer Table { uint table[256]; };
layout(location = 0) out vec4 outColor;

void main() {
    uvec3 bytes = uvec3(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb * 255.0 + 0.5);
    outColor = vec4(vec3(table[bytes.r], table[bytes.g], table[bytes.b]) / 255.0, 1.0);
}
