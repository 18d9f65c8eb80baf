// Forward projection (A-SVGF, section 4.1): of each stratum of the previous frame one lit sample looks for its pixel in
// this frame. The lowest number wins a stratum that several reach, so a fixed seed repeats bit for bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// A sample that was itself carried is not carried on: its random numbers would follow the surface for ever.
bool mayCarry(uvec2 position)
{
    if (!isInside(ivec2(position)))
        return false;
    uint index = pixelIndex(position);
    RtPixel pixel = loadPixel(denoise.previousPixels, index);
    return pixel.lit != 0u && pixel.keyFrame == denoise.previousFrame;
}

void projectSample(uint stratum, uint number)
{
    uvec2 from = pixelOfStratum(stratum, number);
    RtPixel old = loadPixel(denoise.previousPixels, pixelIndex(from));
    vec3 oldSeen = loadGuide(denoise.previousGuides, pixelIndex(from)).position;
    RtMotion motion = MotionTable(denoise.motionToCurrent).at[old.instance];
    // What moves in a mirror is not followed: the way there is not kept.
    if (motion.kind == kMotionUnknown || (motion.kind != kMotionNone && (old.lit & kLitTurned) != 0u))
        return;
    vec3 point =
        movePoint(motion, old.triangle, unpackUnorm2x16(old.barycentric), HitPoint(oldSeen, old.error)).position;
    vec3 before = projectTo(denoise.previousCamera, oldSeen);
    vec3 after = projectTo(denoise.camera, point);
    if (before.z <= 0.0 || after.z <= 0.0)
        return;
    ivec2 to = ivec2(floor(vec2(from) + 0.5 + (after.xy - before.xy) * vec2(denoise.size)));
    if (!isInside(to))
        return;
    RtGuide guide = loadGuide(denoise.guides, pixelIndex(uvec2(to)));
    if (guide.normal == kNoNormal)
        return;
    vec3 normal = unpackNormal(guide.normal);
    if (!isSameSurface(guide.position, normal, point, moveDirection(motion, old.normal), denoise.pixelTangent * after.z,
                       cosineFrom(denoise.camera, guide.position, normal)))
        return;
    uvec2 toStratum = uvec2(to) / kStratumPixels;
    uvec2 inStratum = uvec2(to) % kStratumPixels;
    atomicMin(WinnerTable(denoise.winners).at[stratumIndex(toStratum)],
              packWinner(stratum, number, inStratum.y * kStratumPixels + inStratum.x));
}

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, denoise.strata)))
        return;
    uint stratum = stratumIndex(gl_GlobalInvocationID.xy);
    const uint count = kStratumPixels * kStratumPixels;
    uint first = hashPcg4d(uvec4(gl_GlobalInvocationID.xy, denoise.frame, 0u)).x % count;
    for (uint i = 0u; i < count; ++i) {
        uint number = (first + i) % count;
        if (!mayCarry(pixelOfStratum(stratum, number)))
            continue;
        projectSample(stratum, number);
        return;
    }
}
