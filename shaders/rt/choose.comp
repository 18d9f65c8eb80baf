// Choice of one light a pixel: its light as if nothing stood in the way, and the shadow ray that will tell. No rays are
// traced here: it is one text for all back ends. The rays of a tile are listed in the order of their lights, so that
// those traced side by side go the same way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/direct_light.glsl"
#include "rt/shadow_list.glsl"

layout(local_size_x = kChooseGroup, local_size_y = kChooseGroup) in;

shared uint binEnds[kShadowBins];

uint binOf(uint light)
{
    uint count = rtFrame.triangleLightCount + rtFrame.pointLightCount + rtFrame.lightCount;
    return count <= kShadowBins ? light : uint(float(light) * (float(kShadowBins) / float(count)));
}

// The bin of the pixel's ray; kNoShadowRay: it needs none.
uint choosePixel(uvec2 pixelPosition)
{
    if (any(greaterThanEqual(pixelPosition, rtFrame.size)))
        return kNoShadowRay;
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
    return bin;
}

// Inclusive sums over the bins (Hillis and Steele 1986).
void sumBins(uint own)
{
    for (uint step = 1u; step < kShadowBins; step *= 2u) {
        uint before = own >= step ? binEnds[own - step] : 0u;
        barrier();
        binEnds[own] += before;
        barrier();
    }
}

void main()
{
    uint own = gl_LocalInvocationIndex;
    binEnds[own] = 0u;
    barrier();
    uint bins[4];
    uint ranks[4];
    for (uint quarter = 0u; quarter < 4u; ++quarter) {
        uvec2 inTile = gl_LocalInvocationID.xy + kChooseGroup * uvec2(quarter & 1u, quarter >> 1u);
        bins[quarter] = choosePixel(gl_WorkGroupID.xy * kShadowTile + inTile);
        ranks[quarter] = bins[quarter] != kNoShadowRay ? atomicAdd(binEnds[bins[quarter]], 1u) : 0u;
    }
    barrier();
    sumBins(own);
    uint list = listOfTile(gl_WorkGroupID.xy);
    NumberList order = NumberList(rtFrame.shadowOrder);
    for (uint quarter = 0u; quarter < 4u; ++quarter) {
        uvec2 inTile = gl_LocalInvocationID.xy + kChooseGroup * uvec2(quarter & 1u, quarter >> 1u);
        if (bins[quarter] != kNoShadowRay) {
            uint before = bins[quarter] > 0u ? binEnds[bins[quarter] - 1u] : 0u;
            order.at[list + before + ranks[quarter]] = inTile.y * kShadowTile + inTile.x;
        }
        uint place = quarter * kShadowBins + own;
        if (place >= binEnds[kShadowBins - 1u])
            order.at[list + place] = kNoShadowRay;
    }
}
