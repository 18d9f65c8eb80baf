// The material of a hit, fully evaluated: all stages as A x L + B + P x (what is behind), textures filtered by the
// footprint of the ray.
#ifndef Q3RT_RT_MATERIAL_GLSL
#define Q3RT_RT_MATERIAL_GLSL
#include "lib/color.glsl"
#include "lib/material_affine.glsl"
#include "rt/surface.glsl"

struct MaterialColor {
    vec3 albedo;  // A
    vec3 glow;    // B
    vec3 through; // P
};

// Colours of the content are display values; in linear light they are decoded first.
vec3 shadingColor(vec3 color) { return (rtFrame.flags & kFrameLinear) != 0u ? linearFromSrgb(color) : color; }
vec4 shadingColor(vec4 color) { return vec4(shadingColor(color.rgb), color.a); }

// Stages are read where they are needed, in rows of 16 bytes: a copy of one would hold its eight tcMods, few of which
// exist.
const uint kStageRows = 26u;
const uint kUnitRows = 11u;
const uint kModRows = 2u;

uvec4 stageRow(uint stage, uint row) { return RowTable(rtFrame.stages).at[stage * kStageRows + row]; }

// What its texture coordinates take of a unit, but for its mods.
struct UnitState {
    uint firstRow;
    uint texture;
    uint coord; // kCoord*
    vec3 vectorS;
    vec3 vectorT;
    uint modCount;
    bool clamped;
};

UnitState loadUnit(uint stage, uint unit)
{
    uint first = unit * kUnitRows + kMaxTexMods * kModRows;
    uvec4 s = stageRow(stage, first), t = stageRow(stage, first + 1u), rest = stageRow(stage, first + 2u);
    return UnitState(stage * kStageRows + unit * kUnitRows, s.w, t.w, vectorOf(s), vectorOf(t), rest.x, rest.z != 0u);
}

TexModState loadMod(UnitState unit, uint number)
{
    uvec4 matrix = RowTable(rtFrame.stages).at[unit.firstRow + number * kModRows],
          rest = RowTable(rtFrame.stages).at[unit.firstRow + number * kModRows + 1u];
    return TexModState(uintBitsToFloat(matrix), uintBitsToFloat(rest.xy), rest.z, 0u);
}

vec2 generateUnit(UnitState unit, VertexIn vertex, vec3 eye)
{
    TextureUnitState generator; // what generateCoordinates reads of it
    generator.coord = unit.coord;
    generator.vectorS = unit.vectorS;
    generator.vectorT = unit.vectorT;
    return generateCoordinates(generator, vertex, eye);
}

// Repeating textures take coordinates in [0, 1).
vec2 wrapUnit(UnitState unit, vec2 st) { return unit.clamped ? st : wrapCoordinates(st); }

// A unit's texel with the footprint of a pixel: the coordinates of the neighbours' points go through the same chain.
vec4 sampleFiltered(uint stage, uint number, VertexIn vertex, VertexIn vertexX, VertexIn vertexY, vec3 eye)
{
    UnitState unit = loadUnit(stage, number);
    vec2 st = generateUnit(unit, vertex, eye);
    vec2 stX = generateUnit(unit, vertexX, eye);
    vec2 stY = generateUnit(unit, vertexY, eye);
    for (uint i = 0u; i < unit.modCount; ++i) {
        TexModState mod = loadMod(unit, i);
        st = applyTexMod(st, mod, vertex.position);
        stX = applyTexMod(stX, mod, vertexX.position);
        stY = applyTexMod(stY, mod, vertexY.position);
    }
    return textureGrad(textures[nonuniformEXT(unit.texture)], wrapUnit(unit, st), stX - st, stY - st);
}

// A unit's texel at the finest resolution.
vec4 sampleFinest(uint stage, uint number, VertexIn vertex, vec3 eye)
{
    UnitState unit = loadUnit(stage, number);
    vec2 st = generateUnit(unit, vertex, eye);
    for (uint i = 0u; i < unit.modCount; ++i)
        st = applyTexMod(st, loadMod(unit, i), vertex.position);
    return textureLod(textures[nonuniformEXT(unit.texture)], wrapUnit(unit, st), 0.0);
}

// All but the texture units, of which the blend needs to know only whether the first is baked light.
StageState loadStage(uint stage)
{
    uvec4 generators = stageRow(stage, 2u * kUnitRows + 1u), blend = stageRow(stage, 2u * kUnitRows + 2u),
          rest = stageRow(stage, 2u * kUnitRows + 3u);
    StageState result;
    result.color = uintBitsToFloat(stageRow(stage, 2u * kUnitRows));
    result.rgbGen = generators.x;
    result.alphaGen = generators.y;
    result.combine = generators.z;
    result.bakedLight = generators.w;
    result.sourceBlend = blend.x;
    result.destinationBlend = blend.y;
    result.blended = blend.z;
    result.alphaTest = blend.w;
    result.fogFade = rest.x;
    result.portalRange = uintBitsToFloat(rest.y);
    result.depthEqual = rest.z;
    result.depthWrite = rest.w;
    result.unit[0].isLightmap = stageRow(stage, kUnitRows - 1u).y;
    result.unit[0].coord = stageRow(stage, kUnitRows - 2u).w;
    return result;
}

// A point of the world in the model space of an entity whose axes are orthogonal and of one length.
vec3 pointToModel(RtEntity entity, vec3 p)
{
    vec4 r0 = entity.worldFromModel[0], r1 = entity.worldFromModel[1], r2 = entity.worldFromModel[2];
    vec3 moved = p - vec3(r0.w, r1.w, r2.w);
    float size2 = r0.x * r0.x + r1.x * r1.x + r2.x * r2.x;
    return (vec3(r0) * moved.x + vec3(r1) * moved.y + vec3(r2) * moved.z) * (size2 > 0.0 ? inversesqrt(size2) : 0.0);
}

// `eye`: the view's, or its image in a mirror.
EntityIn entityInputs(RtEntity entity, vec3 eye)
{
    EntityIn inputs;
    inputs.ambient = entity.ambient;
    inputs.directed = entity.directed;
    inputs.lightDirection = entity.lightDirection;
    inputs.eye = eye == rtFrame.eye ? entity.eyeInModel : pointToModel(entity, eye);
    inputs.viewOrigin = eye;
    return inputs;
}

// `reflects`: a ray brings what the fake environment stages stand for; they are left out.
AffineColor addStages(AffineColor color, uint first, uint count, VertexIn vertex, VertexIn vertexX, VertexIn vertexY,
                      EntityIn entity, float density, bool reflects)
{
    for (uint i = 0u; i < count; ++i) {
        StageState stage = loadStage(first + i);
        if (reflects && stage.unit[0].coord == kCoordEnvironment)
            continue;
        bool bakedCounts = stage.bakedLight != kBakedLightmap || multipliesLight(stage, color);
        vec4 texel0 = vec4(1.0), texel1 = vec4(1.0);
        if (bakedCounts || stage.unit[0].isLightmap == 0u)
            texel0 = shadingColor(sampleFiltered(first + i, 0u, vertex, vertexX, vertexY, entity.eye));
        if (stage.combine != kCombineSingle && (bakedCounts || stage.unit[0].isLightmap != 0u))
            texel1 = shadingColor(sampleFiltered(first + i, 1u, vertex, vertexX, vertexY, entity.eye));
        vec4 generated = shadingColor(fadeColorInFog(stageColor(stage, vertex, entity), stage.fogFade, density));
        color = addStage(color, stage, generated, texel0, texel1);
    }
    return color;
}

// Weight of the fog's colour at a point of the world, from the eye of a view.
float fogAt(RtFog fog, vec3 position, vec3 eye, vec3 forward)
{
    float depth = fog.hasSurface != 0u ? fog.distance - dot(fog.normal, position) : 0.0;
    float eyeDepth = fog.hasSurface != 0u ? fog.distance - dot(fog.normal, eye) : 1.0;
    float along = dot(position - eye, forward);
    return fogDensity(fogCoordinates(along, fog.depthForOpaque, depth, eyeDepth));
}

VertexIn neighbour(VertexIn vertex, SurfacePoint point, int axis)
{
    vertex.st += point.stPerPixel[axis];
    vertex.lightmapSt += point.lightmapStPerPixel[axis];
    vertex.position += point.positionPerPixel[axis];
    return vertex;
}

MaterialColor shadeSurface(SurfacePoint point, vec3 eye, vec3 forward)
{
    VertexIn vertex = VertexIn(point.modelPosition, point.modelNormal, point.st, point.lightmapSt, point.color);
    EntityIn entity = entityInputs(EntityTable(rtFrame.entities).at[point.entity], eye);
    float density = 0.0;
    RtFog fog;
    if (point.surface.fog != 0u) {
        fog = FogTable(rtFrame.fogs).at[point.surface.fog];
        density = fogAt(fog, point.hit.position, eye, forward);
    }
    AffineColor color = addStages(beginAffine(), point.surface.firstStage, point.surface.stageCount, vertex,
                                  neighbour(vertex, point, 0), neighbour(vertex, point, 1), entity, density,
                                  (point.surface.flags & (kSurfaceWater | kSurfaceGlass)) != 0u);
    MaterialColor result = MaterialColor(color.lit, color.unlit, color.through);
    if (density > 0.0 && (point.surface.flags & kSurfaceFogged) != 0u) {
        result.albedo *= 1.0 - density;
        result.glow = result.glow * (1.0 - density) + shadingColor(fog.color) * density;
        result.through *= 1.0 - density;
    }
    return result;
}

// Does any stage that covers what is behind pass its alpha test here? At the finest texels: rays of all kinds agree.
bool isCovered(SceneTriangle triangle, RtSurface surface, vec2 barycentric)
{
    Vertex v0 = loadVertex(triangle.vertices, triangle.vertex.x);
    Vertex v1 = loadVertex(triangle.vertices, triangle.vertex.y);
    Vertex v2 = loadVertex(triangle.vertices, triangle.vertex.z);
    vec4 c0 = unpackUnorm4x8(v0.color), c1 = unpackUnorm4x8(v1.color), c2 = unpackUnorm4x8(v2.color);
    vec3 position =
        v0.position + (v1.position - v0.position) * barycentric.x + (v2.position - v0.position) * barycentric.y;
    VertexIn vertex = VertexIn(position, v0.normal, interpolate(v0.st, v1.st, v2.st, barycentric), vec2(0.0),
                               c0 + (c1 - c0) * barycentric.x + (c2 - c0) * barycentric.y);
    EntityIn entity = entityInputs(EntityTable(rtFrame.entities).at[triangle.entity], rtFrame.eye);
    for (uint i = 0u; i < surface.stageCount; ++i) {
        StageState stage = loadStage(surface.firstStage + i);
        if (stage.blended != 0u || stage.depthEqual != 0u)
            continue;
        vec4 texel0 = sampleFinest(surface.firstStage + i, 0u, vertex, entity.eye);
        vec4 texel1 = stage.combine != kCombineSingle
                          ? sampleFinest(surface.firstStage + i, 1u, vertex, entity.eye)
                          : vec4(1.0);
        float alpha = combineTexels(stage.combine, stageColor(stage, vertex, entity), texel0, texel1).a;
        if (passesAlphaTest(stage.alphaTest, alpha))
            return true;
    }
    return false;
}

#endif
