// The finished picture through a table of bytes, as a display's gamma ramp shows it.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform readonly image2D picture;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D shown;
layout(set = 0, binding = 2, scalar) readonly buffer Table { uint table[256]; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(shown)))) return;
    uvec3 bytes = uvec3(imageLoad(picture, at).rgb * 255.0 + 0.5);
    vec3 ramped = vec3(table[bytes.r], table[bytes.g], table[bytes.b]);
    imageStore(shown, at, vec4(ramped / 255.0, 1.0));
}
