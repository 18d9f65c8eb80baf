// The frame's tables: everything is reached from the one address in the push constant.
#ifndef Q3RT_RT_SCENE_GLSL
#define Q3RT_RT_SCENE_GLSL
#include "lib/offset.glsl"
#include "rt/rows.glsl"
#include "shared/constants.h"
#include "shared/rt_scene.h"
#include "shared/stage.h"
#include "shared/vertex.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameTable { RtFrame value; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InstanceTable { RtInstance at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SurfaceTable { RtSurface at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EntityTable { RtEntity at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer NumberTable { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SkyTable { RtSky at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer FogTable { RtFog at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ColorTable { vec4 at[]; };

layout(push_constant, scalar) uniform Push { RtPush push; };
layout(set = 0, binding = 0) uniform sampler2D textures[];

#define rtFrame FrameTable(push.frame).value

uint pixelIndex(uvec2 pixel) { return pixel.y * rtFrame.size.x + pixel.x; }

// A triangle of the scene with all that its hit needs.
struct SceneTriangle {
    uint surface; // in the surface table
    uint entity;
    uvec3 vertex;
    uvec2 vertices;
};

SceneTriangle findTriangle(uint instanceIndex, uint triangle)
{
    RtInstance instance = InstanceTable(rtFrame.instances).at[instanceIndex];
    NumberTable indices = NumberTable(instance.indices);
    SceneTriangle result;
    result.surface = instance.firstSurface + NumberTable(instance.surfaceOfTriangle).at[triangle];
    result.entity = instance.entity;
    result.vertex = uvec3(indices.at[3u * triangle], indices.at[3u * triangle + 1u], indices.at[3u * triangle + 2u]);
    result.vertices = instance.vertices;
    return result;
}

// The search for layers drawn before a solid at distance t ends where one of the highest drawing order could still lie.
float layerReach(float t, vec3 origin)
{
    return t + sameDistanceStep(t, length(origin), kGrazingCosine) * float(rtFrame.layerOrderCount + 1u);
}

#endif
