// What one sampled light gives to a surface point without its shadow, and how one of many is chosen.
// Units: luxel units (spec in scene/lights.hpp): irradiance 63.75 shows a texture at its own brightness.
#ifndef Q3RT_LIB_LIGHT_GLSL
#define Q3RT_LIB_LIGHT_GLSL
#include "lib/sampling.glsl"
#include "lib/spherical_triangle.glsl"
#include "shared/constants.h"
#include "shared/rt_lights.h"

struct LightSample {
    vec3 irradiance; // unshadowed estimate, already divided by the density of the sampled point
    vec3 direction;  // from the shaded point to the sampled point; the shadow ray covers t in [0, 1)
    bool fromSky;    // the ray must end on a sky; else its way must be free
    uint light;      // its number: whoever chooses among several sets it
};

LightSample darkSample(vec3 direction)
{
    LightSample result;
    result.irradiance = vec3(0.0f);
    result.direction = direction;
    result.fromSky = false;
    result.light = 0u;
    return result;
}

// Is a point of the triangle above the horizon of the shaded point, which is off its plane on a side that shines?
bool triangleMayShine(vec3 position, vec3 normal, vec3 corner, vec3 edge1, vec3 edge2, vec3 lightNormal, bool twoSided)
{
    vec3 toCorner = corner - position;
    float height = -dot(lightNormal, toCorner);
    float highest = dot(normal, toCorner) + max(max(dot(normal, edge1), dot(normal, edge2)), 0.0f);
    return highest > 0.0f && (height > 0.0f || (height < 0.0f && twoSided));
}

// Lambertian triangle, a point uniform by solid angle: E = L x solid angle x cos(receiver), however near the light is.
// `normal` and `lightNormal` are unit; `position` is the shaded point; in the light's plane it takes nothing.
LightSample sampleTriangleLight(vec3 position, vec3 normal, vec3 corner, vec3 edge1, vec3 edge2, vec3 lightNormal,
                                float areaQu2, vec3 radiance, bool twoSided, float u, float v)
{
    LightSample result = darkSample(corner - position);
    if (!triangleMayShine(position, normal, corner, edge1, edge2, lightNormal, twoSided))
        return result;
    float height = abs(dot(lightNormal, result.direction));
    SphericalTriangle seen = makeSphericalTriangle(result.direction, edge1, edge2, height, areaQu2);
    result.direction = sampleSphericalTriangle(seen, u, v);
    float cosReceiver = dot(normal, result.direction) * inversesqrt(dot(result.direction, result.direction));
    if (cosReceiver > 0.0f)
        result.irradiance = radiance * (2.0f * seen.halfAngle * cosReceiver);
    return result;
}

// The same, a point uniform by area: less work, and noise without bound as the light comes near.
LightSample sampleTriangleLightByArea(vec3 position, vec3 normal, vec3 corner, vec3 edge1, vec3 edge2, vec3 lightNormal,
                                      float areaQu2, vec3 radiance, bool twoSided, float u, float v)
{
    LightSample result = darkSample(corner - position);
    if (!triangleMayShine(position, normal, corner, edge1, edge2, lightNormal, twoSided))
        return result;
    float height = abs(dot(lightNormal, result.direction));
    float fromCorner = sqrt(u);
    result.direction += edge1 * (fromCorner * (1.0f - v)) + edge2 * (fromCorner * v);
    float distance2 = dot(result.direction, result.direction);
    float along = dot(normal, result.direction);
    if (along > 0.0f)
        result.irradiance = radiance * (areaQu2 * (height / distance2) * (along / distance2));
    return result;
}

// A sphere of radius `radiusQu` with intensity I (irradiance I cos / d^2 far away): radiance I / (pi r^2), sampled
// uniformly over the cone it fills. Inside the sphere the light comes from all of the upper hemisphere.
// A radius of 0 is a point with the map compilers' closest distance.
LightSample sampleSphereLight(vec3 position, vec3 normal, vec3 center, float radiusQu, vec3 intensity, float u, float v)
{
    vec3 toCenter = center - position;
    float distance2 = dot(toCenter, toCenter);
    float radius2 = radiusQu * radiusQu;
    LightSample result = darkSample(toCenter);
    if (radiusQu <= 0.0f) {
        float cosReceiver = distance2 > 0.0f ? dot(normal, toCenter) / sqrt(distance2) : 0.0f;
        float clamped = max(distance2, kLightMinDistanceQu * kLightMinDistanceQu);
        result.irradiance = intensity * (max(0.0f, cosReceiver) / clamped);
        return result;
    }
    if (distance2 <= radius2) {
        // Cosine density: E = pi L of a uniform surround. The ray stays inside the sphere.
        result.direction = sampleCosine(normal, u, v) * max(radiusQu - sqrt(distance2), 0.0f);
        result.irradiance = intensity / radius2;
        return result;
    }
    float sine2 = radius2 / distance2;
    float oneMinusCos = sine2 / (1.0f + sqrt(1.0f - sine2));
    vec3 direction = sampleCone(toCenter / sqrt(distance2), oneMinusCos, u, v);
    float along = dot(direction, toCenter);
    float nearest = along - sqrt(max(0.0f, radius2 - (distance2 - along * along)));
    result.direction = direction * nearest;
    float cosReceiver = dot(normal, direction);
    if (cosReceiver > 0.0f)
        result.irradiance = intensity * (2.0f * oneMinusCos * cosReceiver / radius2);
    return result;
}

// Does the map compilers' rule leave this out: nothing of it is above the faintest light that they count?
bool isFaint(vec3 irradiance, float faintest) { return max(irradiance.x, max(irradiance.y, irradiance.z)) <= faintest; }

// The same of a triangle, only far from it and by the unshadowed light of its middle: one answer for all its samples.
bool isTriangleFaint(vec3 position, vec3 normal, vec3 corner, vec3 edge1, vec3 edge2, vec3 lightNormal, float areaQu2,
                     vec3 radiance, float faintest)
{
    vec3 way = corner + (edge1 + edge2) * (1.0f / 3.0f) - position;
    float distance2 = dot(way, way);
    if (faintest <= 0.0f || distance2 <= kFarTriangleSizes * kFarTriangleSizes * areaQu2)
        return false;
    float cosines = max(0.0f, dot(normal, way)) / distance2 * (abs(dot(lightNormal, way)) / distance2);
    return isFaint(radiance * (areaQu2 * cosines), faintest);
}

// A sun: `irradiance` at normal incidence; soft if it has an angle. The direction has length `farQu`.
LightSample sampleSun(vec3 normal, vec3 toSun, float oneMinusCosAngle, vec3 irradiance, float farQu, float u, float v)
{
    vec3 direction = oneMinusCosAngle > 0.0f ? sampleCone(toSun, oneMinusCosAngle, u, v) : toSun;
    LightSample result = darkSample(direction * farQu);
    result.irradiance = irradiance * max(0.0f, dot(normal, direction));
    result.fromSky = true;
    return result;
}

// Share of a spot light that shines on a point `way` from it: all inside its cone, none outside, less over the border
// of the disc that the cone cuts at the point's distance. `radius`: of the cone at distance 1.
float spotShare(vec3 axis, float radius, vec3 way)
{
    float along = dot(way, axis);
    vec3 off = way - axis * along;
    return along > 0.0f ? clamp((along * radius - sqrt(dot(off, off))) / kSpotBorderQu, 0.0f, 1.0f) : 0.0f;
}

// --- choice of one light: weighted reservoir over the unshadowed irradiance (Chao 1982; Talbot et al. 2005, resampled
// importance sampling, with every candidate its own sample). Given the sampled points, light i is kept with probability
// w_i / sum w, and its irradiance is divided by that: the mean over all choices is the sum of all lights, exactly.
// One random number decides all steps: the part of it that a step has not used is the next one's number.
struct LightChoice {
    LightSample kept;
    float weight; // of the kept sample
    float weightSum;
    float random; // [0, 1)
};

// The choice follows the sum of the channels: positive wherever any channel is.
float lightWeight(vec3 irradiance) { return irradiance.x + irradiance.y + irradiance.z; }

LightChoice beginChoice(float random)
{
    LightChoice choice;
    choice.random = random;
    choice.kept = darkSample(vec3(0.0f));
    choice.weight = 0.0f;
    choice.weightSum = 0.0f;
    return choice;
}

// Any weight will do that is positive wherever the irradiance is: only the noise depends on it.
LightChoice considerWeighted(LightChoice choice, LightSample candidate, float weight)
{
    if (!(weight > 0.0f))
        return choice;
    choice.weightSum += weight;
    float share = weight / choice.weightSum;
    if (choice.random < share) {
        choice.kept = candidate;
        choice.weight = weight;
        choice.random = choice.random / share;
    } else {
        choice.random = (choice.random - share) / (1.0f - share);
    }
    choice.random = min(choice.random, kBelowOne);
    return choice;
}

// The kept sample, divided by the probability of keeping it.
LightSample chosenSample(LightChoice choice)
{
    LightSample result = choice.kept;
    result.irradiance = choice.weight > 0.0f ? result.irradiance * (choice.weightSum / choice.weight) : vec3(0.0f);
    return result;
}

#endif
