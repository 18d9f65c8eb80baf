// Temporal anti-aliasing of the composed picture: the mean of jittered frames. Each pixel finds its place in the
// previous result by the motion of what it shows; old colours that the neighbourhood makes implausible are clipped.
// The result may have more pixels than are traced: a sample belongs to the one in which it lies, so that the mean tends
// to the same box filter at any size. Pixels without a sample keep their history, or interpolate.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/denoise.glsl"
#include "lib/ray.glsl"
#include "lib/taa.glsl"
#include "rt/motion.glsl"
#include "shared/rt_denoise.h"
#include "shared/rt_exposure.h"
#include "shared/rt_taa.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer TaaTable { RtTaa value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ColorTable { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ExposureTable { RtExposure value; };
layout(push_constant, scalar) uniform Push { RtTaaPush push; };

#define taa TaaTable(push.taa).value

uint indexOf(ivec2 pixel)
{
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(taa.size) - 1);
    return uint(inside.y) * taa.size.x + uint(inside.x);
}

uint outputIndexOf(ivec2 pixel)
{
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(taa.outputSize) - 1);
    return uint(inside.y) * taa.outputSize.x + uint(inside.x);
}

vec3 pictureAt(ivec2 pixel)
{
    vec3 color = ColorTable(taa.picture).at[indexOf(pixel)].rgb;
    return any(isnan(color)) || any(isinf(color)) ? vec3(0.0) : color;
}

struct NewColor {
    vec3 color;
    bool sampled; // a sample lies in the pixel
};

// What this frame knows of an output pixel. `center`: of it, in traced pixels.
NewColor findColor(ivec2 pixel, vec2 center)
{
    if (taa.size == taa.outputSize)
        return NewColor(pictureAt(pixel), true);
    vec2 place = center - taa.jitter; // sample i lies at i
    ivec2 near = ivec2(ceil(place - 0.5));
    vec2 apart = vec2(near) - place, reach = 0.5 * vec2(taa.size) / vec2(taa.outputSize);
    if (all(greaterThanEqual(apart, -reach)) && all(lessThan(apart, reach)))
        return NewColor(pictureAt(near), true);
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    vec3 upper = mix(pictureAt(base), pictureAt(base + ivec2(1, 0)), part.x);
    vec3 lower = mix(pictureAt(base + ivec2(0, 1)), pictureAt(base + 1), part.x);
    return NewColor(mix(upper, lower, part.y), false);
}

// The pixel among 3 x 3 that shows what is nearest: edges move with what is in front.
ivec2 findNearest(ivec2 pixel)
{
    ivec2 nearest = pixel;
    vec3 away = loadGuide(taa.guides, indexOf(pixel)).position - taa.camera.eye;
    float best = dot(away, away);
    for (int i = 0; i < 9; ++i) {
        ivec2 tap = pixel + ivec2(i % 3 - 1, i / 3 - 1);
        away = loadGuide(taa.guides, indexOf(tap)).position - taa.camera.eye;
        float squared = dot(away, away);
        if (squared < best) {
            best = squared;
            nearest = clamp(tap, ivec2(0), ivec2(taa.size) - 1);
        }
    }
    return nearest;
}

struct Shift {
    vec2 pixels; // of the result
    bool known;
};

// How far what a pixel shows was from here in the previous picture.
Shift findShift(ivec2 pixel)
{
    RtPast past = loadPast(taa.pasts, indexOf(pixel));
    vec3 here = projectTo(taa.camera, loadGuide(taa.guides, indexOf(pixel)).position);
    vec3 there = projectTo(taa.previousCamera, past.position);
    return Shift((there.xy - here.xy) * vec2(taa.outputSize), past.normal != kNoPast && here.z > 0.0 && there.z > 0.0);
}

// Radiance and frames of the previous result at a place between texel centres.
vec4 sampleHistory(vec2 place)
{
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    vec4 wx = catmullRom(part.x), wy = catmullRom(part.y);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            float weight = wx[x] * wy[y];
            if (weight == 0.0)
                continue;
            sum += weight * ColorTable(taa.previousHistory).at[outputIndexOf(base + ivec2(x, y) - 1)];
        }
    // The filter's negative lobes must not make darkness negative.
    return max(sum, vec4(vec3(0.0), kGuessWeight));
}

// In a still picture what the pixel itself shows is always plausible: without noise it passes unchanged. `pixel` is a
// traced one.
vec3 clipToNeighbours(ivec2 pixel, vec3 color, vec3 own, bool still)
{
    vec3 first = vec3(0.0), second = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 tap = pixel + ivec2(i % 3 - 1, i / 3 - 1);
        vec3 c = yCoCgFromRgb(pictureAt(tap));
        first += c / 9.0;
        second += c * c / 9.0;
    }
    vec3 deviation = sqrt(max(second - first * first, vec3(0.0)));
    vec3 extent = still ? max(deviation * kStillSigmas, abs(yCoCgFromRgb(own) - first)) : deviation * kMovingSigmas;
    return max(rgbFromYCoCg(clipToBox(yCoCgFromRgb(color), first, extent)), vec3(0.0));
}

// The part of the old picture that the denoiser knows to be lit otherwise. Small changes pass the clipping.
float lightLoss(uvec2 pixel)
{
    if (taa.gradients == uvec2(0u))
        return 0.0;
    uvec2 stratum = pixel / kStratumPixels;
    return historyLoss(ColorTable(taa.gradients).at[stratum.y * taa.strata.x + stratum.x].xyz);
}

// By how much the exposure has changed since the previous picture.
float exposureChange()
{
    if (taa.autoExposure == uvec2(0u))
        return 1.0;
    RtExposure exposure = ExposureTable(taa.autoExposure).value;
    return exp2(exposure.stops - exposure.previousStops);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(taa.outputSize))))
        return;
    vec2 center = (vec2(pixel) + 0.5) * vec2(taa.size) / vec2(taa.outputSize);
    ivec2 traced = min(ivec2(center), ivec2(taa.size) - 1);
    NewColor new = findColor(pixel, center);
    vec4 result = vec4(new.color, new.sampled ? 1.0 : kGuessWeight);
    Shift shift = findShift(findNearest(traced));
    vec2 place = vec2(pixel) + shift.pixels;
    bool inside = all(greaterThanEqual(place, vec2(-0.5))) && all(lessThan(place, vec2(taa.outputSize) - 0.5));
    if (taa.hasHistory != 0u && shift.known && inside) {
        vec4 history = sampleHistory(place);
        history.rgb *= exposureChange();
        bool still = shift.pixels == vec2(0.0);
        float kept = min(history.w, (still ? kTaaStillLimit : kTaaMovingLimit) - 1.0);
        // A still pixel that has samples needs no guess, and no doubt: what is thin shows in some frames only.
        bool waits = still && !new.sampled && kept >= 1.0;
        float weight = new.sampled ? 1.0 : waits ? 0.0 : kGuessWeight;
        float fresh = weight / (kept + weight), loss = lightLoss(uvec2(traced));
        vec3 old = waits ? history.rgb : clipToNeighbours(traced, history.rgb, new.color, still);
        result = vec4(mix(old, new.color, max(fresh, loss)),
                      loss > fresh ? max(weight, kGuessWeight) / loss : kept + weight);
    }
    ColorTable(taa.history).at[outputIndexOf(pixel)] = result;
}
