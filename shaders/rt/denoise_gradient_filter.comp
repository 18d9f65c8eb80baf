// One level of the gradient's a-trous filter, at the strata's resolution (A-SVGF, section 4.3). Change and reference
// are filtered alike and divided afterwards, so that strata without a sample are filled by their neighbours;
// variances take the weights' squares.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// The middle of a stratum stands for it.
RtGuide guideOfStratum(uvec2 stratum)
{
    return loadGuide(denoise.guides, pixelIndex(min(stratum * kStratumPixels + 1u, denoise.size - 1u)));
}

void main()
{
    uvec2 stratum = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(stratum, denoise.strata)))
        return;
    RtGuide center = guideOfStratum(stratum);
    bool guided = center.normal != kNoNormal;
    vec3 normal = unpackNormal(center.normal);
    float footprint = denoise.pixelTangent * float(kStratumPixels) * length(center.position - denoise.camera.eye);
    int step = 1 << push.level;
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = ivec2(stratum) + ivec2(x, y) * step;
            if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(denoise.strata))))
                continue;
            float weight = tentKernel(x) * tentKernel(y);
            RtGuide guide = guideOfStratum(uvec2(tap));
            if (guided && guide.normal != kNoNormal)
                weight *= normalWeight(dot(normal, unpackNormal(guide.normal))) *
                          planeWeight(dot(normal, guide.position - center.position), footprint);
            sum += vec3(weight, weight, weight * weight) *
                   ColorTable(denoise.gradients[push.level & 1u]).at[stratumIndex(uvec2(tap))].xyz;
        }
    ColorTable(denoise.gradients[push.level + 1u & 1u]).at[stratumIndex(stratum)] = vec4(sum, 0.0);
}
