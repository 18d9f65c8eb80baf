// The material of a hit, fully evaluated: all stages as A x L + B + P x (what is behind), textures filtered by the
// footprint of the ray.
#ifndef Q3RT_RT_MATERIAL_GLSL
#define Q3RT_RT_MATERIAL_GLSL
#include "lib/material_affine.glsl"
#include "rt/surface.glsl"

struct MaterialColor {
    vec3 albedo;  // A
    vec3 glow;    // B
    vec3 through; // P
};

vec4 sampleUnit(TextureUnitState unit, vec2 st, vec2 stX, vec2 stY)
{
    vec2 at = unit.clamped != 0u ? st : wrapCoordinates(st);
    return textureGrad(textures[nonuniformEXT(unit.texture)], at, stX, stY);
}

// A unit's texel with the footprint of a pixel: the coordinates of the neighbours' points go through the same chain.
vec4 sampleFiltered(TextureUnitState unit, VertexIn vertex, VertexIn vertexX, VertexIn vertexY, vec3 eye)
{
    vec2 st = unitCoordinates(unit, vertex, eye);
    return sampleUnit(unit, st, unitCoordinates(unit, vertexX, eye) - st, unitCoordinates(unit, vertexY, eye) - st);
}

// Part by part: copying whole stages would fetch their four tcMods for every pixel, and few stages have any.
TextureUnitState loadUnit(StageTable stages, uint stage, uint unit)
{
    TextureUnitState result;
    result.coord = stages.at[stage].unit[unit].coord;
    result.texture = stages.at[stage].unit[unit].texture;
    result.clamped = stages.at[stage].unit[unit].clamped;
    result.isLightmap = stages.at[stage].unit[unit].isLightmap;
    result.modCount = stages.at[stage].unit[unit].modCount;
    if (result.coord == kCoordVector) {
        result.vectorS = stages.at[stage].unit[unit].vectorS;
        result.vectorT = stages.at[stage].unit[unit].vectorT;
    }
    for (uint i = 0u; i < kMaxTexMods; ++i)
        if (i < result.modCount)
            result.mods[i] = stages.at[stage].unit[unit].mods[i];
    return result;
}

StageState loadStage(uint stage)
{
    StageTable stages = StageTable(rtFrame.stages);
    StageState result;
    result.color = stages.at[stage].color;
    result.rgbGen = stages.at[stage].rgbGen;
    result.alphaGen = stages.at[stage].alphaGen;
    result.combine = stages.at[stage].combine;
    result.bakedLight = stages.at[stage].bakedLight;
    result.sourceBlend = stages.at[stage].sourceBlend;
    result.destinationBlend = stages.at[stage].destinationBlend;
    result.blended = stages.at[stage].blended;
    result.alphaTest = stages.at[stage].alphaTest;
    result.fogFade = stages.at[stage].fogFade;
    result.portalRange = stages.at[stage].portalRange;
    result.depthEqual = stages.at[stage].depthEqual;
    result.depthWrite = stages.at[stage].depthWrite;
    result.unit[0] = loadUnit(stages, stage, 0u);
    result.unit[1].isLightmap = 0u;
    if (result.combine != kCombineSingle)
        result.unit[1] = loadUnit(stages, stage, 1u);
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
        vec4 texel0 = sampleFiltered(stage.unit[0], vertex, vertexX, vertexY, entity.eye);
        vec4 texel1 = stage.combine != kCombineSingle
                          ? sampleFiltered(stage.unit[1], vertex, vertexX, vertexY, entity.eye)
                          : vec4(1.0);
        vec4 generated = fadeColorInFog(stageColor(stage, vertex, entity), stage.fogFade, density);
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
        result.glow = result.glow * (1.0 - density) + fog.color * density;
        result.through *= 1.0 - density;
    }
    return result;
}

// Does any stage that covers what is behind pass its alpha test here? At the finest texels: rays of all kinds agree.
bool isCovered(SceneTriangle triangle, RtSurface surface, vec2 barycentric)
{
    VertexTable vertices = VertexTable(triangle.vertices);
    Vertex v0 = vertices.at[triangle.vertex.x], v1 = vertices.at[triangle.vertex.y];
    Vertex v2 = vertices.at[triangle.vertex.z];
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
        vec4 texel0 = sampleUnit(stage.unit[0],
                                 unitCoordinates(stage.unit[0], vertex, entity.eye), vec2(0.0), vec2(0.0));
        vec4 texel1 = vec4(1.0);
        if (stage.combine != kCombineSingle)
            texel1 = sampleUnit(stage.unit[1],
                                unitCoordinates(stage.unit[1], vertex, entity.eye), vec2(0.0), vec2(0.0));
        float alpha = combineTexels(stage.combine, stageColor(stage, vertex, entity), texel0, texel1).a;
        if (passesAlphaTest(stage.alphaTest, alpha))
            return true;
    }
    return false;
}

#endif
