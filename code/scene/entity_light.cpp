// Lighting of an entity: light grid, minimum light, dynamic lights (spec of models 2.9).

#include <algorithm>
#include <cmath>

#include "scene/entity_geometry.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kUnlitGrey = 150.0f;     // 0..255, without a light grid
constexpr float kMinimumAmbient = 32.0f; // added to every entity
constexpr float kNearestLightQu = 16.0f; // dynamic lights get no brighter than at this distance
constexpr float kLightScale = 16.0f;     // strength = this * radius^2 / distance^2

} // namespace

EntityLight computeEntityLight(const World* world, const vec3& sunDirection, const SceneEntity& entity,
                               const FrameCommands& frame, const SceneView& view,
                               const ViewGeometrySettings& settings) {
    const vec3 position =
        entity.flags & entityFlag::kLightingOrigin ? entity.lightingOrigin : entity.orientation.origin;
    GridLight base;
    if (world && !(view.flags & viewFlag::kNoWorldModel) && !world->grid.empty()) {
        base = world->grid.sample(position);
        base.ambient *= settings.ambientScale;
        base.directed *= settings.directedScale;
    } else {
        base.ambient = base.directed = vec3(kUnlitGrey * settings.identityLight);
        base.direction = sunDirection;
    }
    EntityLight light;
    light.ambient = base.ambient + kMinimumAmbient * settings.identityLight;
    light.directed = base.directed;
    vec3 direction = base.direction * glm::length(base.directed);
    for (uint32_t i = 0; i < view.lightCount; ++i) {
        const SceneLight& source = frame.lights[view.firstLight + i];
        const vec3 toLight = source.origin - position;
        const float distance = std::max(glm::length(toLight), kNearestLightQu);
        const float strength = kLightScale * source.radius * source.radius / (distance * distance);
        light.directed += strength * source.color;
        direction += strength * normalizeOrZero(toLight);
    }
    light.ambient = glm::min(light.ambient, vec3(std::floor(255.0f * settings.identityLight)));
    direction = normalizeOrZero(direction);
    for (int i = 0; i < 3; ++i) { // not renormalised: scaled axes scale the directed light
        light.direction[i] = glm::dot(direction, entity.orientation.axis[i]);
    }
    return light;
}

} // namespace q3rt
