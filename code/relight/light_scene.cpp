#include "relight/light_scene.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "relight/sampling.hpp"
#include "scene/luxels.hpp"

namespace q3rt {
namespace {

class KindFinder {
  public:
    KindFinder(const World& world, const MaterialLibrary& materials)
        : m_world(world)
        , m_materials(materials) {}

    std::vector<EmitterKind> run(const LightSet& lights) {
        for (size_t i = 0; i < lights.triangles.size(); ++i) {
            const TriangleLight& light = lights.triangles[i];
            if (light.bspModel != 0) continue; // compilers let movers light nothing
            EmitterKind& kind = kindOf(EmitterKind::Type::Surface, light.surface);
            kind.radiosity = std::numbers::pi_v<float> * largestOf(light.radiance);
            kind.color = light.radiance / largestOf(light.radiance);
            kind.triangles.push_back(static_cast<uint32_t>(i));
        }
        for (const SkyLight& sky : lights.skies) {
            EmitterKind& kind =
                kindOf(sky.upperHemisphere ? EmitterKind::Type::SkyDome : EmitterKind::Type::Sky, sky.surface);
            kind.radiosity = sky.radiosity;
            kind.color = sky.color;
        }
        // A sky may have shone when the map was baked, whatever its script says today.
        for (size_t s = 0; s < m_world.surfaces.size(); ++s)
            if (m_world.surfaces[s].drawn && m_materials.get(m_world.surfaces[s].material).isSky)
                kindOf(EmitterKind::Type::Sky, static_cast<int>(s));
        return std::move(m_kinds);
    }

  private:
    const World& m_world;
    const MaterialLibrary& m_materials;
    std::vector<EmitterKind> m_kinds;
    std::map<std::pair<EmitterKind::Type, std::string>, size_t> m_byName;

    EmitterKind& kindOf(EmitterKind::Type type, int surface) {
        const std::string& name = m_materials.get(m_world.surfaces[static_cast<size_t>(surface)].material).name;
        const auto [entry, isNew] = m_byName.try_emplace({type, name}, m_kinds.size());
        if (isNew) {
            m_kinds.emplace_back();
            m_kinds.back().type = type;
            m_kinds.back().material = name;
        }
        return m_kinds[entry->second];
    }
};

std::vector<int> findSkyKinds(const World& world, const MaterialLibrary& materials,
                              const std::vector<EmitterKind>& kinds) {
    std::vector<int> result(world.surfaces.size(), -1);
    for (size_t s = 0; s < world.surfaces.size(); ++s)
        for (size_t k = 0; k < kinds.size(); ++k)
            if (kinds[k].type == EmitterKind::Type::Sky &&
                kinds[k].material == materials.get(world.surfaces[s].material).name)
                result[s] = static_cast<int>(k);
    return result;
}

} // namespace

LightScene::LightScene(const World& w, const MaterialLibrary& m, const LuxelMapSettings& settings,
                       size_t openPointCount)
    : world(w)
    , materials(m)
    , lights(extractLights(w, m))
    , occluders(w, m)
    , open(w, occluders, openPointCount)
    , luxels(buildLuxelMap(w, m, settings))
    , kinds(KindFinder(w, m).run(lights))
    , skyKindOfSurface(findSkyKinds(w, m, kinds)) {
    for (const LuxelPatch& patch : luxels.patches)
        receivers.push_back(receiverOf(patch));
}

bool LightScene::isFront(const OccluderHit& hit, const vec3& direction) const {
    if (materials.get(world.surfaces[hit.surface].material).cull == CullMode::None) return true;
    return glm::dot(normalAt(world, hit.firstIndex, vec3(1.0f / 3)), direction) < 0;
}

LightReceiver LightScene::receiverOf(const PlacedLuxel& luxel) const {
    LightReceiver receiver;
    vec3 tangent, bitangent;
    completeFrame(luxel.normal, tangent, bitangent);
    const float quarter = 0.25f * std::sqrt(luxel.areaQu2);
    const vec3 centre = luxel.position + kSampleOffsetQu * luxel.normal;
    for (int i = 0; i < LightReceiver::kPoints; ++i) {
        const vec3 offset = (i & 1 ? quarter : -quarter) * tangent + (i & 2 ? quarter : -quarter) * bitangent;
        const bool free = world.clusterOf(centre + offset) >= 0 && !occluders.occluded(centre, offset, 1);
        receiver.position[i] = free ? centre + offset : centre;
        receiver.normal[i] = luxel.normal;
    }
    receiver.cluster = world.clusterOf(receiver.position[0]);
    return receiver;
}

LightReceiver LightScene::receiverOf(const LuxelPatch& patch) const {
    if (patch.luxelCount == 1) return receiverOf(luxels.luxels[patch.firstLuxel]);
    LightReceiver receiver;
    for (uint32_t i = 0; i < LightReceiver::kPoints; ++i) { // evenly over its luxels
        const uint32_t number = (2 * i + 1) * patch.luxelCount / (2 * LightReceiver::kPoints);
        const PlacedLuxel& luxel = luxels.luxels[patch.firstLuxel + number];
        receiver.position[i] = luxel.position + kSampleOffsetQu * luxel.normal;
        receiver.normal[i] = luxel.normal;
    }
    receiver.cluster = world.clusterOf(receiver.position[0]);
    return receiver;
}

} // namespace q3rt
