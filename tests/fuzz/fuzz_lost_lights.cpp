#include <cmath>

#include "fuzz_input.hpp"
#include "scene/lost_lights.hpp"

using namespace q3rt;

namespace {

bool isFinite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    return fuzz::runParser([&] {
        const LostLights lights = parseLostLights(fuzz::asText(data, size), "lights/m.ent");
        for (const PointLight& light : lights.points)
            fuzz::require(isFinite(light.origin) && isFinite(light.intensity) && isFinite(light.direction) &&
                          std::isfinite(light.cosOuter) && glm::all(glm::greaterThanEqual(light.intensity, vec3(0))));
        for (const SunLight& sun : lights.suns)
            fuzz::require(isFinite(sun.direction) && isFinite(sun.irradiance) && std::isfinite(sun.halfAngleRadians));
        for (const auto* list : {&lights.surfaceLights, &lights.skyLights})
            for (const LostLights::Strength& strength : *list)
                fuzz::require(std::isfinite(strength.value) && strength.value >= 0 && isFinite(strength.color));
    });
}
