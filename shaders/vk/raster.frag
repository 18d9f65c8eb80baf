// Colour of every raster draw: texture x colour, alpha test, the layers over it.
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
layout(location = 5) flat in uvec3 inLayerTextures;
layout(location = 6) in vec4 inLayerColor[3];
layout(location = 9) in vec2 inLayerSt[3];
layout(location = 0) out vec4 outColor;

layout(constant_id = 6) const uint kLayer1 = 0u; // kLayer*
layout(constant_id = 7) const uint kLayer2 = 0u;
layout(constant_id = 8) const uint kLayer3 = 0u;
layout(constant_id = 9) const uint kBlueFirst = 0u; // 1: the target's red is its blue

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

bool alphaPasses(uint test, float alpha) {
    if (test == kTestGreater0) return alpha > 0.0;
    if (test == kTestLess128) return alpha < 0.5;
    if (test == kTestGreaterEqual128) return alpha >= 0.5;
    return true;
}

// Layers are blended in whole bytes, as a frame buffer of bytes does it: all colours of layers are multiples of 1/255.
vec3 wholeBytes(vec3 color) { return floor(color * 255.0 + 0.5) * (1.0 / 255.0); }

// Part of `color` that a blend factor keeps. The frame buffer's alpha is 1.
vec3 blendPart(vec3 color, uint factor, vec4 source, vec3 destination) {
    if (factor == kBlendZero || factor == kBlendOneMinusDstAlpha || factor == kBlendSrcAlphaSaturate) return vec3(0.0);
    if (factor == kBlendSrcColor) return wholeBytes(color * source.rgb);
    if (factor == kBlendOneMinusSrcColor) return wholeBytes(color * (1.0 - source.rgb));
    if (factor == kBlendDstColor) return wholeBytes(color * destination);
    if (factor == kBlendOneMinusDstColor) return wholeBytes(color * (1.0 - destination));
    if (factor == kBlendSrcAlpha) return wholeBytes(color * source.aaa);
    if (factor == kBlendOneMinusSrcAlpha) return wholeBytes(color * (1.0 - source.aaa));
    return color;
}

vec3 layOver(vec3 below, uint state, uint number, vec2 st, vec4 color) {
    vec4 source = texture(textures[number], st); // whole bytes where a filter gives such: a processor's
    float alpha = source.a;
    if ((state & kLayerWhite) == 0u) {
        source *= color;
        alpha = source.a;
        source = vec4(wholeBytes(source.rgb), wholeBytes(source.aaa).x);
    }
    vec3 blended = blendPart(source.rgb, state & 15u, source, below) +
                   blendPart(below, (state >> kLayerDestinationShift) & 15u, source, below);
    bool passes = alphaPasses((state >> kLayerTestShift) & 3u, alpha);
    return passes ? min(blended, 1.0) : below;
}

vec3 layersOver(vec4 first) {
    vec3 color = wholeBytes(first.rgb);
    color = layOver(color, kLayer1, inLayerTextures.x, inLayerSt[0], inLayerColor[0]);
    if (kLayers > 2u) color = layOver(color, kLayer2, inLayerTextures.y, inLayerSt[1], inLayerColor[1]);
    if (kLayers > 3u) color = layOver(color, kLayer3, inLayerTextures.z, inLayerSt[2], inLayerColor[2]);
    return color;
}

void main() {
    if (kPass == kPassStage)
        outColor = stageColor();
    else if (kPass == kPassLight)
        outColor = texture(textures[kTextureDlight], inSt0) * inColor;
    else
        outColor = texture(textures[kTextureFog], inSt0) * inColor;
    if (kLayers > 1u) outColor.rgb = layersOver(outColor); // before pixels end: they have parts in derivatives
    if (kClipped != 0u && inClip < 0.0) discard;
    if (kAlphaTest != kTestNone && !alphaPasses(kAlphaTest, outColor.a)) discard;
    if (kBlueFirst != 0u) outColor.rgb = outColor.bgr; // blending treats each colour alone
}
