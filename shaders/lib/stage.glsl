// One stage of a material: its colour, its texture coordinates, and how texels and colour combine. Pure functions; the
// includer samples the textures. Everything that depends on time was resolved on the CPU (shared/stage.h).
// Behaviour: spec of materials, sections 2.3, 2.7 and 3.3. Colours in [0, 1]; positions in qu.
#ifndef Q3RT_LIB_STAGE_GLSL
#define Q3RT_LIB_STAGE_GLSL
#include "lib/blend.glsl"
#include "lib/fog.glsl"
#include "shared/stage.h"

// What a generator reads of a vertex or hit, in model space.
struct VertexIn {
    vec3 position;
    vec3 normal; // unit
    vec2 st;
    vec2 lightmapSt;
    vec4 color; // of the vertex; baked light (shifted) or the caller's
};

// What a generator reads of the entity; all 0 for the world.
struct EntityIn {
    vec3 ambient; // 0..255
    vec3 directed;
    vec3 lightDirection; // model space, toward the light, unit or 0
    vec3 eye;            // model space
    vec3 viewOrigin;     // world space; alphaGen portal measures to it from the model-space position
};

// Colours are bytes in the original, cut off below. Values that are bytes already stay what they are.
vec3 truncateColor(vec3 color)
{
    return floor(clamp(color, vec3(0.0f), vec3(1.0f)) * 255.0f) / 255.0f;
}

vec3 nearestBytes(vec3 color)
{
    return floor(clamp(color, vec3(0.0f), vec3(1.0f)) * 255.0f + 0.5f);
}

// rgbGen lightingDiffuse; [0, 1].
vec3 diffuseLight(vec3 normal, EntityIn entity)
{
    float incoming = dot(normal, entity.lightDirection);
    vec3 light = incoming <= 0.0f ? entity.ambient : entity.ambient + entity.directed * incoming;
    return floor(min(light, vec3(255.0f))) / 255.0f;
}

// alphaGen lightingSpecular: one light at a fixed place in model space.
float specularAlpha(VertexIn vertex, vec3 eye)
{
    const vec3 lightPosition = vec3(-960.0f, 1980.0f, 96.0f);
    vec3 toLight = normalize(lightPosition - vertex.position);
    vec3 reflected = vertex.normal * (2.0f * dot(vertex.normal, toLight)) - toLight;
    vec3 toEye = eye - vertex.position;
    float eyeDistance2 = dot(toEye, toEye);
    float along = eyeDistance2 > 0.0f ? dot(reflected, toEye) / sqrt(eyeDistance2) : 0.0f;
    if (along < 0.0f)
        return 0.0f;
    float squared = along * along;
    return min(255.0f, floor(255.0f * squared * squared)) / 255.0f;
}

// alphaGen portal: fades in with distance, opaque from the range on.
float portalAlpha(vec3 position, vec3 viewOrigin, float rangeQu)
{
    float distanceQu = length(position - viewOrigin);
    return distanceQu >= rangeQu ? 1.0f : floor(255.0f * distanceQu / rangeQu) / 255.0f;
}

// The colour that multiplies the texels, before fog.
vec4 stageColor(StageState s, VertexIn v, EntityIn e)
{
    vec4 color = s.color;
    vec3 rgb = vec3(color);
    if (s.rgbGen == kColorVertex)
        rgb = floor(nearestBytes(vec3(v.color)) * rgb) / 255.0f;
    else if (s.rgbGen == kColorOneMinusVertex)
        rgb = floor((vec3(255.0f) - nearestBytes(vec3(v.color))) * rgb) / 255.0f;
    else if (s.rgbGen == kColorLightingDiffuse)
        rgb = diffuseLight(v.normal, e);
    float alpha = color.a;
    if (s.alphaGen == kAlphaVertex)
        alpha = v.color.a;
    else if (s.alphaGen == kAlphaOneMinusVertex)
        alpha = 1.0f - v.color.a;
    else if (s.alphaGen == kAlphaLightingSpecular)
        alpha = specularAlpha(v, e.eye);
    else if (s.alphaGen == kAlphaPortal)
        alpha = portalAlpha(v.position, e.viewOrigin, s.portalRange);
    return vec4(rgb, alpha);
}

// A blended stage in fog loses what it adds (spec of world, 6.5); density from fogDensity.
vec4 fadeColorInFog(vec4 color, uint fogFade, float density)
{
    if (fogFade == kFadeNone)
        return color;
    vec3 rgb = floor(nearestBytes(vec3(color)) * (1.0f - density)) / 255.0f;
    float alpha = floor(floor(color.a * 255.0f + 0.5f) * (1.0f - density)) / 255.0f;
    if (fogFade == kFadeRgb)
        return vec4(rgb, color.a);
    if (fogFade == kFadeAlpha)
        return vec4(vec3(color), alpha);
    return vec4(rgb, alpha);
}

// The sine table of the language has 1,024 entries and a period of 1,023.
float sineOfTable(float cycles)
{
    const float kRadiansPerEntry = 6.28318530717958648f / 1023.0f;
    return sin(float(int(cycles * 1024.0f) & 1023) * kRadiansPerEntry);
}

vec2 applyTexMod(vec2 st, TexModState mod, vec3 position)
{
    if (mod.kind == kModTurb) {
        float amplitude = mod.matrix.x, now = mod.matrix.y;
        return st + vec2(sineOfTable((position.x + position.z) / 1024.0f + now),
                         sineOfTable(position.y / 1024.0f + now)) * amplitude;
    }
    return vec2(st.x * mod.matrix.x + st.y * mod.matrix.z, st.x * mod.matrix.y + st.y * mod.matrix.w) + mod.translate;
}

// tcGen environment: the direction to the eye mirrored at the normal.
vec2 environmentCoordinates(VertexIn vertex, vec3 eye)
{
    vec3 toEye = eye - vertex.position;
    float length2 = dot(toEye, toEye);
    toEye = length2 > 0.0f ? toEye / sqrt(length2) : vec3(0.0f);
    vec3 reflected = vertex.normal * (2.0f * dot(vertex.normal, toEye)) - toEye;
    return vec2(0.5f + reflected.y * 0.5f, 0.5f - reflected.z * 0.5f);
}

vec2 generateCoordinates(TextureUnitState unit, VertexIn vertex, vec3 eye)
{
    if (unit.coord == kCoordLightmap)
        return vertex.lightmapSt;
    if (unit.coord == kCoordEnvironment)
        return environmentCoordinates(vertex, eye);
    if (unit.coord == kCoordVector)
        return vec2(dot(vertex.position, unit.vectorS), dot(vertex.position, unit.vectorT));
    return vertex.st;
}

// Texture coordinates of one unit. Unrolled: a dynamically indexed copy of the mods would go through memory.
vec2 unitCoordinates(TextureUnitState unit, VertexIn vertex, vec3 eye)
{
    vec2 st = generateCoordinates(unit, vertex, eye);
    if (unit.modCount > 0u)
        st = applyTexMod(st, unit.mods[0], vertex.position);
    if (unit.modCount > 1u)
        st = applyTexMod(st, unit.mods[1], vertex.position);
    if (unit.modCount > 2u)
        st = applyTexMod(st, unit.mods[2], vertex.position);
    if (unit.modCount > 3u)
        st = applyTexMod(st, unit.mods[3], vertex.position);
    return st;
}

// Into [0, 1) for repeating textures: coordinates of content reach 2.9e9, where samplers lose their way.
vec2 wrapCoordinates(vec2 st)
{
    return st - floor(st);
}

// The fragment before alpha test and blend. `texel1` is read only by stages of two units.
vec4 combineTexels(uint combine, vec4 color, vec4 texel0, vec4 texel1)
{
    if (combine == kCombineMultiply)
        return texel0 * texel1 * color;
    if (combine == kCombineAdd)
        return vec4(min(vec3(1.0f), vec3(texel0) * vec3(color) + vec3(texel1)), texel0.a * texel1.a * color.a);
    return texel0 * color;
}

bool passesAlphaTest(uint test, float alpha)
{
    if (test == kTestGreater0)
        return alpha > 0.0f;
    if (test == kTestLess128)
        return alpha < 0.5f;
    if (test == kTestGreaterEqual128)
        return alpha >= 0.5f;
    return true;
}
#endif
