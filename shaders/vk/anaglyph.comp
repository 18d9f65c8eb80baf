// Each colour of the picture from the eye whose glass lets it through.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform readonly image2D leftEye;
layout(set = 0, binding = 1, rgba8) uniform image2D picture; // the right eye's, before
layout(push_constant, scalar) uniform Push {
    vec3 left;
    vec3 right;
} shows;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(picture)))) return;
    vec3 color = imageLoad(leftEye, at).rgb * shows.left + imageLoad(picture, at).rgb * shows.right;
    imageStore(picture, at, vec4(color, 1.0));
}
