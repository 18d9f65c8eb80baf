// Choice of one light a pixel: its light as if nothing stood in the way, and the shadow ray that will tell. No rays are
// traced here: it is one text for all back ends.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/direct_light.glsl"
#include "rt/shadow_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Lights of like numbers share one where there are more lights than bins.
uint binOf(uint light)
{
    uint count = rtFrame.triangleLightCount + rtFrame.pointLightCount + rtFrame.lightCount;
    return count <= kShadowBins ? light : uint(float(light) * (float(kShadowBins) / float(count)));
}

void choosePixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = loadPixel(rtFrame.pixels, index);
    vec3 light = vec3(1.0), ambient = vec3(0.0);
    uint bin = kNoShadowRay;
    if (isLit(pixel)) {
        GridSample grid = gridAt(pixel);
        LightSample lit = chooseLight(pixel, grid.sunSeen, sampleBits(ownRandomKey(pixel), kDimensionChoice));
        light = lit.irradiance / kWhiteIrradiance;
        ambient = ambientLight(pixel, grid);
        if (lightWeight(lit.irradiance) > 0.0) {
            bin = min(binOf(lit.light), kShadowBins - 1u);
            storeShadowRay(
                rtFrame.shadowRays, index,
                RtShadowRay(sideToward(pixel, lit.direction).origin, 0u, lit.direction, lit.fromSky ? 1u : 0u));
        }
    }
    ColorTable(rtFrame.irradiance).at[index] = vec4(light, 1.0);
    ColorTable(rtFrame.ambientL).at[index] = vec4(ambient, 1.0);
    NumberList(rtFrame.shadowBins).at[index] = bin;
}

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, rtFrame.size)))
        choosePixel(gl_GlobalInvocationID.xy);
}
