// Colour of every raster draw: texture x colour, alpha test.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require
#include "vk/raster_frame.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) in vec4 inColor;
layout(location = 1) in vec2 inSt0;
layout(location = 2) in vec2 inSt1;
layout(location = 3) in float inClip;
layout(location = 4) flat in uvec2 inTextures; // equal all over a draw
layout(location = 0) out vec4 outColor;

// Fixed ids of the texture library.
const uint kTextureDlight = 3u;
const uint kTextureFog = 4u;

vec4 stageColor() {
    vec4 first = texture(textures[inTextures.x], inSt0);
    if (kCombine == kCombineSingle) return first * inColor;
    vec4 second = texture(textures[inTextures.y], inSt1);
    if (kCombine == kCombineMultiply) return first * second * inColor;
    return vec4(min(vec3(1.0), first.rgb * inColor.rgb + second.rgb), first.a * second.a * inColor.a);
}

bool alphaPasses(float alpha) {
    if (kAlphaTest == kTestGreater0) return alpha > 0.0;
    if (kAlphaTest == kTestLess128) return alpha < 0.5;
    if (kAlphaTest == kTestGreaterEqual128) return alpha >= 0.5;
    return true;
}

void main() {
    if (kPass == kPassStage)
        outColor = stageColor();
    else if (kPass == kPassLight)
        outColor = texture(textures[kTextureDlight], inSt0) * inColor;
    else
        outColor = texture(textures[kTextureFog], inSt0) * inColor;
    if (kClipped != 0u && inClip < 0.0) discard;
    if (kAlphaTest != kTestNone && !alphaPasses(outColor.a)) discard;
}
