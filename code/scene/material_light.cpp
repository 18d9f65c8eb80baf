// Keywords that only map compilers read; the ray tracer's lights come from them (spec of baked light).
#include <algorithm>

#include "formats/text_case.hpp"
#include "scene/material_compile.hpp"

namespace q3rt {
namespace {

/// Scaled so that the largest component is 1, as the compilers do. Black stays black.
vec3 normalizeColor(const vec3& color) {
    const float largest = std::max({color.x, color.y, color.z});
    return largest > 0 ? color / largest : vec3(0);
}

LightDirectives::Sun readSunDirective(const ScriptLine& line) {
    LightDirectives::Sun sun;
    sun.color = normalizeColor({numberAt(line, 0), numberAt(line, 1), numberAt(line, 2)});
    sun.intensity = numberAt(line, 3);
    sun.yawDegrees = numberAt(line, 4);
    sun.pitchDegrees = numberAt(line, 5);
    sun.devianceDegrees = numberAt(line, 6);
    return sun;
}

} // namespace

LightDirectives readLightDirectives(const ScriptDefinition& definition) {
    LightDirectives light;
    for (const ScriptLine& line : definition.lines) {
        const std::string& keyword = line.keyword;
        if (keyword == "q3map_surfacelight") {
            light.surfaceLight = numberAt(line, 0);
        } else if (keyword == "q3map_lightrgb") {
            light.color = normalizeColor({numberAt(line, 0), numberAt(line, 1), numberAt(line, 2)});
        } else if (keyword == "q3map_lightimage") {
            light.lightImage = argumentAt(line, 0);
        } else if (keyword == "qer_editorimage") {
            light.editorImage = argumentAt(line, 0);
        } else if (keyword == "q3map_skylight") {
            light.skyLight = numberAt(line, 0);
            light.skyLightIterations = static_cast<int>(numberAt(line, 1));
        } else if (keyword == "q3map_backsplash") {
            light.backsplashPercent = numberAt(line, 0);
            if (line.arguments.size() > 1) light.backsplashDistance = numberAt(line, 1);
        } else if (keyword == "q3map_sun" || keyword == "q3map_sunext" || keyword == "sun") {
            light.suns.push_back(readSunDirective(line));
        } else if (keyword == "surfaceparm" && equalsIgnoringCase(argumentAt(line, 0), "alphashadow")) {
            light.alphaShadow = true;
        }
    }
    return light;
}

} // namespace q3rt
