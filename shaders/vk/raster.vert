// Every raster draw: a material stage, a dynamic light over it, or fog over it. Positions are computed the same way in
// all three, so that their depths are equal.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vk/raster_frame.glsl"
#include "vk/raster_generate.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inSt;
layout(location = 3) in vec2 inLightmapSt;
layout(location = 4) in vec4 inColor;

layout(location = 0) out vec4 outColor;
layout(location = 1) out vec2 outSt0;
layout(location = 2) out vec2 outSt1;
layout(location = 3) out float outClip;
layout(location = 4) flat out uvec2 outTextures;
layout(location = 5) flat out uvec3 outLayerTextures;
layout(location = 6) out vec4 outLayerColor[3];
layout(location = 9) out vec2 outLayerSt[3];
invariant gl_Position;

layout(constant_id = 4) const float kGreyscale = 0.0; // of all colours, [0, 1]

vec3 towardGrey(vec3 color) {
    if (kGreyscale == 0.0) return color;
    float luma = floor(dot(color * 255.0, vec3(0.2126, 0.7152, 0.0722)) + 0.001) / 255.0;
    return mix(color, vec3(luma), kGreyscale);
}

vec3 worldPosition() {
    vec4 p = vec4(inPosition, 1.0);
    return vec3(dot(entities[draw.entity].worldRow0, p), dot(entities[draw.entity].worldRow1, p),
                dot(entities[draw.entity].worldRow2, p));
}

vec4 generateColor(uint stage) {
    vec3 rgb = generateRgb(stages[stage].rgbGen, stages[stage].color.rgb, inColor, inNormal, entities[draw.entity]);
    float alpha = generateAlpha(stages[stage].alphaGen, stages[stage].color.a, inColor, inPosition, inNormal,
                                stages[stage].portalRange, entities[draw.entity]);
    return vec4(rgb, alpha);
}

// A stage after the first of the pass.
void generateLayer(uint layer) {
    uint stage = draw.layerStage + layer - 1u;
    outLayerColor[layer - 1u] = generateColor(stage);
    outLayerTextures[layer - 1u] = stages[stage].unit[0].texture;
    outLayerSt[layer - 1u] = unitCoordinates(stage, 0u, inPosition, inNormal, inSt, inLightmapSt,
                                             entities[draw.entity].eyeInModel);
}

void generateStage() {
    uint stage = draw.stage;
    vec3 eye = entities[draw.entity].eyeInModel;
    outColor = generateColor(stage);
    if (draw.useFog != 0u) {
        float keep = 1.0 - fogDensity(fogCoordinates(draw.fog, worldPosition()));
        uint fade = stages[stage].fogFade;
        if (fade == kFadeRgb || fade == kFadeRgba) outColor.rgb = truncateBytes(outColor.rgb * 255.0 * keep);
        if (fade == kFadeAlpha || fade == kFadeRgba) outColor.a = floor(outColor.a * 255.0 * keep) / 255.0;
    }
    outTextures = uvec2(stages[stage].unit[0].texture, stages[stage].unit[1].texture);
    outSt0 = unitCoordinates(stage, 0u, inPosition, inNormal, inSt, inLightmapSt, eye);
    if (stages[stage].combine != kCombineSingle)
        outSt1 = unitCoordinates(stage, 1u, inPosition, inNormal, inSt, inLightmapSt, eye);
    if (kLayers > 1u) generateLayer(1u);
    if (kLayers > 2u) generateLayer(2u);
    if (kLayers > 3u) generateLayer(3u);
}

// The light's picture lies in the x, y plane of the surface's own space, whatever way the wall faces.
void generateLight() {
    vec3 toLight = lights[draw.light].origin - inPosition;
    float radius = lights[draw.light].radius;
    outSt0 = 0.5 + toLight.xy / radius;
    float height = abs(toLight.z);
    float strength = height > radius ? 0.0 : height < radius * 0.5 ? 1.0 : 2.0 * (radius - height) / radius;
    vec3 bytes = floor(255.0 * lights[draw.light].color * strength);
    outColor = vec4(mod(bytes, 256.0) / 255.0, 1.0);
}

void main() {
    gl_Position = entities[draw.entity].clipFromModel * vec4(inPosition, 1.0);
    outColor = vec4(1.0);
    outSt0 = vec2(0.0);
    outSt1 = vec2(0.0);
    outClip = 1.0;
    outTextures = uvec2(0u);
    if (kClipped != 0u) {
        vec4 plane = entities[draw.entity].clipPlane;
        outClip = dot(plane.xyz, worldPosition()) - plane.w;
    }
    if (kPass == kPassStage) {
        generateStage();
    } else if (kPass == kPassLight) {
        generateLight();
    } else if (kPass == kPassFog) {
        outColor = vec4(fogs[draw.fog].color, 1.0);
        outSt0 = fogCoordinates(draw.fog, worldPosition());
    }
    outColor.rgb = towardGrey(outColor.rgb);
    if (kLayers > 1u) outLayerColor[0].rgb = towardGrey(outLayerColor[0].rgb);
    if (kLayers > 2u) outLayerColor[1].rgb = towardGrey(outLayerColor[1].rgb);
    if (kLayers > 3u) outLayerColor[2].rgb = towardGrey(outLayerColor[2].rgb);
}
