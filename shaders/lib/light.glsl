// What one sampled light gives to a surface point without its shadow, and how one of many is chosen.
// Units: luxel units (spec in scene/lights.hpp): irradiance 63.75 shows a texture at its own brightness.
#ifndef Q3RT_LIB_LIGHT_GLSL
#define Q3RT_LIB_LIGHT_GLSL
#include "lib/sampling.glsl"
#include "lib/spherical_triangle.glsl"
#include "shared/constants.h"

struct LightSample {
    vec3 irradiance; // unshadowed estimate, already divided by the density of the sampled point
    vec3 direction;  // from the shaded point to the sampled point; the shadow ray covers t in [0, 1)
};

// Lambertian triangle, a point uniform by solid angle: E = L x solid angle x cos(receiver), however near the light is.
// `normal` and `lightNormal` are unit; `position` is the shaded point.
LightSample sampleTriangleLight(vec3 position, vec3 normal, vec3 corner, vec3 edge1, vec3 edge2, vec3 lightNormal,
                                float areaQu2, vec3 radiance, bool twoSided, float u, float v)
{
    LightSample result;
    result.direction = corner - position;
    result.irradiance = vec3(0.0f);
    float height = -dot(lightNormal, result.direction);
    float above = dot(normal, result.direction);
    float highest = above + max(max(dot(normal, edge1), dot(normal, edge2)), 0.0f);
    if (highest <= 0.0f || (height <= 0.0f && !twoSided))
        return result;
    SphericalTriangle seen = makeSphericalTriangle(result.direction, edge1, edge2, abs(height), areaQu2);
    result.direction = sampleSphericalTriangle(seen, u, v);
    float cosReceiver = dot(normal, result.direction) * inversesqrt(dot(result.direction, result.direction));
    if (cosReceiver > 0.0f)
        result.irradiance = radiance * (2.0f * seen.halfAngle * cosReceiver);
    return result;
}

// A sphere of radius `radiusQu` with intensity I (irradiance I cos / d^2 far away): radiance I / (pi r^2), sampled
// uniformly over the cone it fills. Inside the sphere the light comes from all of the upper hemisphere.
// A radius of 0 is a point with the map compilers' closest distance.
LightSample sampleSphereLight(vec3 position, vec3 normal, vec3 center, float radiusQu, vec3 intensity, float u, float v)
{
    LightSample result;
    vec3 toCenter = center - position;
    float distance2 = dot(toCenter, toCenter);
    float radius2 = radiusQu * radiusQu;
    result.direction = toCenter;
    result.irradiance = vec3(0.0f);
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

// A sun: `irradiance` at normal incidence; soft if it has an angle. The direction has length `farQu`.
LightSample sampleSun(vec3 normal, vec3 toSun, float oneMinusCosAngle, vec3 irradiance, float farQu, float u, float v)
{
    LightSample result;
    vec3 direction = oneMinusCosAngle > 0.0f ? sampleCone(toSun, oneMinusCosAngle, u, v) : toSun;
    result.direction = direction * farQu;
    result.irradiance = irradiance * max(0.0f, dot(normal, direction));
    return result;
}

// A uniform sky of radiosity `irradiance` (pi x its radiance), one direction of cosine density.
LightSample sampleSkyDome(vec3 normal, vec3 irradiance, float farQu, float u, float v)
{
    LightSample result;
    result.direction = sampleCosine(normal, u, v) * farQu;
    result.irradiance = irradiance;
    return result;
}

// --- choice of one light: weighted reservoir over the unshadowed irradiance (Chao 1982; Talbot et al. 2005, resampled
// importance sampling, with every candidate its own sample). Given the sampled points, light i is kept with probability
// w_i / sum w, and its irradiance is divided by that: the mean over all choices is the sum of all lights, exactly.
struct LightChoice {
    vec3 irradiance; // of the kept sample, before the division
    vec3 direction;
    float weight;    // of the kept sample
    float weightSum;
};

// The choice follows the sum of the channels: positive wherever any channel is.
float lightWeight(vec3 irradiance) { return irradiance.x + irradiance.y + irradiance.z; }

LightChoice emptyChoice()
{
    LightChoice choice;
    choice.irradiance = vec3(0.0f);
    choice.direction = vec3(0.0f);
    choice.weight = 0.0f;
    choice.weightSum = 0.0f;
    return choice;
}

// `random` in [0, 1). Any weight will do that is positive wherever the irradiance is: only the noise depends on it.
LightChoice considerWeighted(LightChoice choice, LightSample candidate, float weight, float random)
{
    if (!(weight > 0.0f))
        return choice;
    choice.weightSum += weight;
    if (random * choice.weightSum < weight) {
        choice.irradiance = candidate.irradiance;
        choice.direction = candidate.direction;
        choice.weight = weight;
    }
    return choice;
}

// A candidate that was drawn at random brings its weight in its irradiance.
LightChoice considerLight(LightChoice choice, LightSample candidate, float random)
{
    return considerWeighted(choice, candidate, lightWeight(candidate.irradiance), random);
}

vec3 chosenIrradiance(LightChoice choice)
{
    return choice.weight > 0.0f ? choice.irradiance * (choice.weightSum / choice.weight) : vec3(0.0f);
}

#endif
