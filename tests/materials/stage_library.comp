// Every function of the stage library, compiled for the device: what C++ accepts, GLSL may not.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require
#include "lib/material_affine.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Stages { StageState stages[]; };
layout(set = 0, binding = 1, scalar) buffer Results { vec3 results[]; };
layout(set = 1, binding = 0) uniform sampler2D textures[];

vec4 sampleUnit(TextureUnitState unit, VertexIn vertex, vec3 eye)
{
    vec2 st = unitCoordinates(unit, vertex, eye);
    return textureLod(textures[nonuniformEXT(unit.texture)], unit.clamped != 0u ? st : wrapCoordinates(st), 0.0);
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    VertexIn vertex = VertexIn(vec3(index), vec3(0.0, 0.0, 1.0), vec2(0.0), vec2(0.0), vec4(1.0));
    EntityIn entity = EntityIn(vec3(1.0), vec3(1.0), vec3(0.0, 0.0, 1.0), vec3(3.0), vec3(2.0));
    float density = fogDensity(fogCoordinates(1.0, 2.0, 3.0, 4.0));
    AffineColor surface = beginAffine();
    for (uint i = 0u; i < stages.length(); ++i) {
        StageState stage = stages[i];
        vec4 color = fadeColorInFog(stageColor(stage, vertex, entity), stage.fogFade, density);
        surface = addStage(surface, stage, color, sampleUnit(stage.unit[0], vertex, entity.eye),
                           sampleUnit(stage.unit[1], vertex, entity.eye));
    }
    vec3 behind = blendColors(kBlendSrcAlpha, kBlendOneMinusSrcAlpha, vec4(0.5), vec3(1.0));
    results[index] = truncateColor(resolveAffine(surface, vec3(1.0), behind));
}
