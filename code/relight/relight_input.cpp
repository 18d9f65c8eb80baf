#include "relight/relight_input.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "relight/lost_units.hpp"

namespace q3rt {
namespace {

/// A residual this small says nothing: rounding and filtering, and what dirt and the compilers' approximations do.
constexpr float kToleranceLuxels = 3, kToleranceShare = 0.1f;
/// A map whose brightest luxel is below this was darkened; below that, it is just dark.
constexpr float kSaturatedLuxel = 250, kDarkestBright = 60;
/// Rounding of a luxel at the floor.
constexpr float kFloorSlack = 0.6f;
constexpr size_t kDarkestOneIn = 50;

float findCompensation(const Bsp& bsp) {
    uint8_t brightest = 0;
    for (const uint8_t byte : bsp.lightmaps)
        brightest = std::max(brightest, byte);
    return brightest < kSaturatedLuxel && brightest >= kDarkestBright ? 255.0f / brightest : 1.0f;
}

/// Light of the worldspawn, in its colour: `_minlight`, `ambient`, luxel units before the bake was darkened.
vec3 worldLight(const World& world, std::initializer_list<std::string_view> keys) {
    if (world.entities.empty()) return vec3(0);
    const MapEntity& spawn = world.entities[0];
    const vec3 color = glm::max(spawn.vector("_color").value_or(vec3(1)), vec3(0));
    const float largest = largestOf(color);
    for (const std::string_view key : keys)
        if (const float value = spawn.number(key, 0); value > 0)
            return value * (largest > 0 ? color / largest : vec3(1));
    return vec3(0);
}

} // namespace

RelightInput::RelightInput(const World& world, const MaterialLibrary& materials, const RelightSettings& s)
    : settings(s)
    , scene(world, materials, s.luxels, s.openPoints)
    , rays(scene, scene.receivers, s.hemisphereRays)
    , kindColumns(traceEmitters(scene, scene.receivers, std::vector<float>(scene.kinds.size(), 0)))
    , eyes(openEyes(scene))
    , compensation(findCompensation(world.bsp))
    , floor(worldLight(world, {"_minlight"}) / compensation)
    , ambient(worldLight(world, {"_ambient", "ambient"}))
    , fingerprint(lightmapFingerprint(world.bsp)) {
    std::vector<LightColumn> skies = rays.skyColumns(scene);
    for (size_t k = 0; k < skies.size(); ++k)
        if (scene.kinds[k].type != EmitterKind::Type::Surface) kindColumns[k] = std::move(skies[k]);
    findShown();
    findAmbientLimit();
    price = settings.price * LightFit(makeTargets()).cost() / kIntensityOfValue;
}

std::vector<LightColumn> RelightInput::kindColumnsOf(const std::vector<float>& radiosities, float faintest) const {
    std::vector<LightColumn> columns = kindColumns;
    if (!(faintest > 0)) return columns;
    std::vector<float> ends(scene.kinds.size(), -1);
    for (size_t k = 0; k < ends.size(); ++k)
        if (scene.kinds[k].type == EmitterKind::Type::Surface)
            ends[k] = faintest / (radiosities[k] > 0 ? radiosities[k] : scene.kinds[k].radiosity);
    std::vector<LightColumn> ended = traceEmitters(scene, scene.receivers, ends);
    for (size_t k = 0; k < ends.size(); ++k)
        if (ends[k] >= 0) columns[k] = std::move(ended[k]);
    return columns;
}

void RelightInput::findShown() {
    std::vector<char> seen(scene.receivers.size(), 0);
    parallelFor(seen.size(), [&](size_t i) {
        const LightReceiver& receiver = scene.receivers[i];
        const int surface = scene.luxels.patches[i].surface;
        const Material& material = scene.materials.get(scene.world.surfaces[static_cast<size_t>(surface)].material);
        if (material.light.surfaceLight > 0) return; // emitters glow, whatever their luxels say
        for (int p = 0; p < LightReceiver::kPoints && !seen[i]; ++p)
            seen[i] = scene.open.sees(receiver.position[p], receiver.normal[p]) ? 1 : 0;
    });
    isShown.assign(seen.begin(), seen.end());
}

void RelightInput::findAmbientLimit() {
    std::vector<float> values;
    for (size_t i = 0; i < isShown.size(); ++i)
        if (isShown[i] && scene.luxels.patches[i].areaQu2 > 0) values.push_back(largestOf(bakedIrradiance(i)));
    if (values.empty()) return;
    const auto darkest = values.begin() + static_cast<std::ptrdiff_t>(values.size() / kDarkestOneIn);
    std::nth_element(values.begin(), darkest, values.end());
    ambientLimit = std::max(*darkest, largestOf(ambient));
}

vec3 RelightInput::luxelOf(const vec3& irradiance) const {
    const float largest = largestOf(irradiance);
    const vec3 clamped = largest > 255 ? irradiance * (255 / largest) : irradiance;
    return glm::max(clamped / compensation, floor);
}

std::vector<FitTarget> RelightInput::makeTargets() const {
    std::vector<FitTarget> targets;
    for (size_t i = 0; i < scene.luxels.patches.size(); ++i) {
        const LuxelPatch& patch = scene.luxels.patches[i];
        FitTarget target;
        target.light = bakedIrradiance(i);
        target.weight = isShown[i] ? patch.areaQu2 : 0;
        target.tolerance = compensation * (kToleranceLuxels + kToleranceShare * largestOf(patch.baked));
        target.atLeast = patch.saturated;
        target.atMost = floor != vec3(0) && largestOf(patch.baked) <= largestOf(floor) + kFloorSlack;
        targets.push_back(target);
    }
    return targets;
}

LostLights RelightInput::scripted() const {
    LostLights lights;
    lights.lightmap = fingerprint;
    lights.compensate = compensation;
    for (const EmitterKind& kind : scene.kinds) {
        auto& list = kind.type == EmitterKind::Type::SkyDome ? lights.skyLights : lights.surfaceLights;
        list.push_back({kind.material, kind.radiosity / radiosityOfValue(kind.type), kind.color});
    }
    lights.floor = compensation * floor;
    lights.ambientValue = largestOf(ambient);
    if (lights.ambientValue > 0) lights.ambientColor = ambient / lights.ambientValue;
    lights.suns = scene.lights.suns;
    lights.points = scene.lights.points;
    return lights;
}

} // namespace q3rt
