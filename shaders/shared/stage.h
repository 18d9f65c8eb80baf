// A material stage with all time dependence resolved on the CPU (double precision) for one shader time: what both
// renderers read. One text for C++ and GLSL.
#ifndef Q3RT_SHARED_STAGE_H
#define Q3RT_SHARED_STAGE_H
#include "types.h"
SHARED_BEGIN

// How the vertex or hit colour is generated; constant-like generators are resolved into StageState::color.
SHARED_CONST kColorConstant = 0u;        // identity, const, wave, identityLighting, entity
SHARED_CONST kColorVertex = 1u;          // vertex colour x color.rgb (identity light)
SHARED_CONST kColorOneMinusVertex = 2u;  // (1 - vertex) x color.rgb
SHARED_CONST kColorLightingDiffuse = 3u; // entity light: ambient + n.l directed

SHARED_CONST kAlphaConstant = 0u;
SHARED_CONST kAlphaVertex = 1u;
SHARED_CONST kAlphaOneMinusVertex = 2u;
SHARED_CONST kAlphaLightingSpecular = 3u;
SHARED_CONST kAlphaPortal = 4u;

SHARED_CONST kCoordTexture = 0u;
SHARED_CONST kCoordLightmap = 1u;
SHARED_CONST kCoordEnvironment = 2u;
SHARED_CONST kCoordVector = 3u;

SHARED_CONST kModAffine = 0u; // st' = M st + t
SHARED_CONST kModTurb = 1u;   // matrix.x amplitude, matrix.y phase + time * frequency (already wrapped to [0, 1))

SHARED_CONST kCombineSingle = 0u;
SHARED_CONST kCombineMultiply = 1u;
SHARED_CONST kCombineAdd = 2u;

SHARED_CONST kBakedNone = 0u;
SHARED_CONST kBakedLightmap = 1u;
SHARED_CONST kBakedVertex = 2u;
SHARED_CONST kBakedGrid = 3u;

SHARED_CONST kFadeNone = 0u;
SHARED_CONST kFadeRgb = 1u;
SHARED_CONST kFadeAlpha = 2u;
SHARED_CONST kFadeRgba = 3u;

// Blend factors, alpha tests: the values of q3rt::BlendFactor and q3rt::AlphaTest (asserted in C++).
SHARED_CONST kBlendZero = 0u;
SHARED_CONST kBlendOne = 1u;
SHARED_CONST kBlendSrcColor = 2u;
SHARED_CONST kBlendOneMinusSrcColor = 3u;
SHARED_CONST kBlendDstColor = 4u;
SHARED_CONST kBlendOneMinusDstColor = 5u;
SHARED_CONST kBlendSrcAlpha = 6u;
SHARED_CONST kBlendOneMinusSrcAlpha = 7u;
SHARED_CONST kBlendDstAlpha = 8u;
SHARED_CONST kBlendOneMinusDstAlpha = 9u;
SHARED_CONST kBlendSrcAlphaSaturate = 10u;
SHARED_CONST kTestNone = 0u;
SHARED_CONST kTestGreater0 = 1u;
SHARED_CONST kTestLess128 = 2u;
SHARED_CONST kTestGreaterEqual128 = 3u;

SHARED_CONST kMaxTexMods = 4u; // of the shader language: a fifth is an error

struct TexModState {
    vec4 matrix;    // m00 m01 m10 m11: s' = s m00 + t m10 + translate.x, t' = s m01 + t m11 + translate.y
    vec2 translate; // wrapped to [0, 1) where it only scrolls: repeat textures don't change, precision stays
    uint kind;      // kMod*
    uint reserved;
};

struct TextureUnitState {
    TexModState mods[4];
    vec3 vectorS; // kCoordVector
    uint texture; // index of the bindless texture array
    vec3 vectorT;
    uint coord; // kCoord*
    uint modCount;
    uint isLightmap; // 1: this unit is baked light
    uint clamped;
    uint reserved;
};

struct StageState {
    TextureUnitState unit[2];
    vec4 color; // [0, 1]; constant part of rgbGen (rgb) and alphaGen (a)
    uint rgbGen;
    uint alphaGen;
    uint combine;
    uint bakedLight;
    uint sourceBlend;
    uint destinationBlend;
    uint blended;
    uint alphaTest;
    uint fogFade;
    float portalRange; // qu
    uint depthEqual; // 1: only where an earlier stage wrote depth (depthFunc equal)
    uint depthWrite; // 1: writes depth where its alpha test passes
};

SHARED_END
#endif
