// Temporal accumulation: the mean of a surface point's light over frames, found again by back projection, with first
// and second moments of its luminance and the number of samples. The gradient shortens what has changed (A-SVGF,
// section 4.4). What is accumulated here is never filtered: blur cannot grow from frame to frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

struct History {
    vec4 light; // w: samples
    vec2 moments;
    float weight;
};

struct Searched {
    vec3 position; // world of the previous frame
    vec3 normal;
    float footprint;
    float cosine;
};

void addTap(inout History history, Searched searched, ivec2 tap, float weight)
{
    if (weight <= 0.0 || !isInside(tap))
        return;
    uint index = pixelIndex(uvec2(tap));
    RtGuide guide = loadGuide(denoise.previousGuides, index);
    if (guide.normal == kNoNormal || !isSameSurface(searched.position, searched.normal, guide.position,
                                                    unpackNormal(guide.normal), searched.footprint, searched.cosine))
        return;
    history.light += weight * ColorTable(denoise.previousLight).at[index];
    history.moments += weight * PairTable(denoise.previousMoments).at[index];
    history.weight += weight;
}

// Bilinear among the four pixels around the place; if none of them shows the surface, any of the nine nearest does.
History gatherHistory(Searched searched, vec2 place)
{
    History history = History(vec4(0.0), vec2(0.0), 0.0);
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - part, part, vec2(corner));
        addTap(history, searched, base + corner, share.x * share.y);
    }
    ivec2 nearest = ivec2(floor(place + 0.5));
    if (history.weight == 0.0)
        for (int i = 0; i < 9; ++i)
            addTap(history, searched, nearest + ivec2(i % 3 - 1, i / 3 - 1), 1.0);
    if (history.weight > 0.0) {
        history.light /= history.weight;
        history.moments /= history.weight;
    }
    return history;
}

History findHistory(uvec2 pixel, RtGuide guide)
{
    History none = History(vec4(0.0), vec2(0.0), 0.0);
    if ((denoise.flags & kDenoiseHistory) == 0u)
        return none;
    RtPast past = loadPast(denoise.pasts, pixelIndex(pixel));
    vec3 now = projectTo(denoise.camera, guide.position);
    vec3 before = projectTo(denoise.previousCamera, past.position);
    if (past.normal == kNoPast || now.z <= 0.0 || before.z <= 0.0)
        return none;
    Searched searched;
    searched.position = past.position;
    searched.normal = unpackNormal(past.normal);
    searched.footprint = denoise.pixelTangent * before.z;
    searched.cosine = cosineFrom(denoise.previousCamera, searched.position, searched.normal);
    // The difference of both projections, not the second alone: pixels jittered within their area stay in place.
    return gatherHistory(searched, vec2(pixel) + (before.xy - now.xy) * vec2(denoise.size));
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, denoise.size)))
        return;
    uint index = pixelIndex(pixel);
    RtGuide guide = loadGuide(denoise.guides, index);
    vec3 light = ColorTable(denoise.irradiance).at[index].rgb;
    if (guide.normal == kNoNormal) {
        ColorTable(denoise.light).at[index] = vec4(light, 0.0);
        PairTable(denoise.moments).at[index] = vec2(0.0);
        return;
    }
    History history = findHistory(pixel, guide);
    if (!isFinite(light))
        light = history.light.rgb;
    float luminance = luminanceOf(light);
    float share = 1.0;
    if (history.weight > 0.0) {
        float loss = kFixedShare;
        if ((denoise.flags & kDenoiseGradient) != 0u)
            loss = historyLoss(
                ColorTable(denoise.gradients[kGradientLevels & 1u]).at[stratumIndex(pixel / kStratumPixels)].xyz);
        share = blendFactor(min(history.light.w, kHistoryLimit - 1.0), loss);
    }
    ColorTable(denoise.light).at[index] = vec4(mix(history.light.rgb, light, share), 1.0 / share);
    PairTable(denoise.moments).at[index] = mix(history.moments, vec2(luminance, luminance * luminance), share);
}
