// Light entities that survived in the entity lump: on most maps the compilers stripped them (spec of baked light).

#include <algorithm>
#include <cmath>

#include "scene/lights_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kDefaultValue = 300.0f;       // of a light without a value
constexpr float kPointScale = 7500.0f;        // intensity of value 1
constexpr float kDefaultSpotRadiusQu = 64.0f; // of the cone, at the target

const MapEntity* findTarget(const std::vector<MapEntity>& entities, const MapEntity& light) {
    const auto target = light.value("target");
    if (!target) return nullptr;
    const auto found = std::find_if(entities.begin(), entities.end(),
                                    [&](const MapEntity& e) { return e.value("targetname") == target; });
    return found != entities.end() ? &*found : nullptr;
}

vec3 colorOf(const MapEntity& light) {
    const vec3 color = light.vector("_color").value_or(vec3(1.0f));
    const float largest = std::max({color.x, color.y, color.z});
    return largest > 0.0f ? color / largest : vec3(1.0f);
}

void addLight(const std::vector<MapEntity>& entities, const MapEntity& entity, LightSet& lights) {
    const float value = entity.number("_light", entity.number("light", kDefaultValue));
    const auto origin = entity.vector("origin");
    if (!(value > 0.0f) || !origin) return;
    const MapEntity* target = findTarget(entities, entity);
    const vec3 toTarget = target ? target->vector("origin").value_or(*origin) - *origin : vec3(0.0f);
    if (target && entity.number("_sun", 0.0f) != 0.0f) {
        const vec3 direction = normalizeOrZero(-toTarget);
        const float deviance = glm::radians(entity.number("_deviance", 0.0f));
        if (direction != vec3(0.0f)) lights.suns.push_back({direction, colorOf(entity) * value, deviance});
        return;
    }
    PointLight light;
    light.origin = *origin;
    light.intensity = colorOf(entity) * (kPointScale * value);
    const float distance = glm::length(toTarget);
    light.spot = target && distance > 0.0f;
    if (light.spot) {
        light.direction = toTarget / distance;
        const float radius = entity.number("radius", kDefaultSpotRadiusQu);
        light.cosOuter = distance / std::hypot(distance, radius);
    }
    lights.points.push_back(light);
}

} // namespace

void addEntityLights(const std::vector<MapEntity>& entities, LightSet& lights) {
    for (const MapEntity& entity : entities) {
        if (entity.className() == "light") addLight(entities, entity, lights);
    }
}

} // namespace q3rt
