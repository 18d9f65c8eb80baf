// Lights of a map by rule: emissive surfaces, suns and skies (spec of baked light).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>

#include "scene/deform.hpp"
#include "scene/lights_build.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr float kRadiosityOfValue = 0.75f; // of q3map_surfacelight, luxel units
constexpr float kSkyLightHalf = 0.5f;      // mean sine of elevation over the upper hemisphere

vec3 scaleToLargest(const vec3& color) {
    const float largest = std::max({color.x, color.y, color.z});
    return largest > 0.0f ? color / largest : vec3(0.0f);
}

/// The first stage's own picture: not the lightmap, not the plain white one.
vec3 firstStageColor(const Material& material, const TextureLibrary& textures) {
    for (const Stage& stage : material.stages) {
        for (const TextureUnit& unit : stage.unit) {
            if (unit.frames.empty() || unit.isLightmap || unit.isWhite) continue;
            return vec3(textures.get(unit.frames[0]).averageColor);
        }
    }
    return vec3(0.0f);
}

/// Appends a light for each triangle of a surface that has an area; returns how many have none.
size_t appendTriangles(const World& world, const Material& material, int number, TriangleLight light,
                       std::vector<TriangleLight>& out) {
    const WorldSurface& surface = world.surfaces[static_cast<size_t>(number)];
    light.surface = number;
    light.twoSided = material.cull == CullMode::None;
    light.flipped = material.cull == CullMode::Back;
    size_t without = 0;
    for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3) {
        for (uint32_t k = 0; k < 3; ++k)
            light.corner[k] = world.vertices[world.indices[surface.firstIndex + i + k]].position;
        if (light.flipped) std::swap(light.corner[1], light.corner[2]);
        light.triangle = i / 3;
        if (measureTriangle(light))
            out.push_back(light);
        else
            ++without;
    }
    return without;
}

class Extractor {
  public:
    Extractor(const World& world, const MaterialLibrary& materials)
        : m_world(world)
        , m_materials(materials) {}

    LightSet run() {
        for (size_t i = 0; i < m_world.surfaces.size(); ++i) {
            const WorldSurface& surface = m_world.surfaces[i];
            if (!surface.drawn) continue;
            const Material& material = m_materials.get(surface.material);
            // To the compilers surfaceparm sky makes a sky, also without the skyparms that draw one.
            if (material.isSky || (material.surfaceFlags & surfaceParm::kSky)) {
                addSky(static_cast<int>(i), material);
            } else if (material.light.surfaceLight > 0.0f) {
                addEmitter(static_cast<int>(i), material);
            }
        }
        addEntityLights(m_world.entities, m_lights);
        return std::move(m_lights);
    }

  private:
    const World& m_world;
    const MaterialLibrary& m_materials;
    LightSet m_lights;
    std::unordered_map<std::string, vec3> m_colors; // by material name: variants differ in their lightmap only
    std::set<std::string> m_skiesSeen;

    vec3 colorOf(const Material& material) {
        const auto [entry, isNew] = m_colors.try_emplace(material.name, 0.0f);
        if (isNew) entry->second = lightColorOf(material, m_materials);
        return entry->second;
    }

    void addSky(int number, const Material& material) {
        const LightDirectives& light = material.light;
        if (light.surfaceLight > 0.0f) {
            m_lights.skies.push_back({kRadiosityOfValue * light.surfaceLight, colorOf(material), number, false});
        }
        if (light.skyLight > 0.0f) {
            m_lights.skies.push_back({kSkyLightHalf * light.skyLight, colorOf(material), number, true});
        }
        if (!m_skiesSeen.insert(material.name).second) return;
        for (const LightDirectives::Sun& sun : light.suns) {
            m_lights.suns.push_back({directionOfAngles(sun.yawDegrees, sun.pitchDegrees), sun.color * sun.intensity,
                                     glm::radians(sun.devianceDegrees)});
        }
    }

    void addEmitter(int number, const Material& material) {
        TriangleLight light;
        light.radiance =
            colorOf(material) * (kRadiosityOfValue * material.light.surfaceLight / std::numbers::pi_v<float>);
        light.bspModel = m_world.surfaces[static_cast<size_t>(number)].bspModel;
        // A sprite turns with the eye. Light must not depend on who looks: it stays where the map has it.
        light.reachQu = deformsWithView(material) ? 0.0f : deformReachQu(material);
        const size_t before = m_lights.triangles.size();
        m_lights.zeroAreaTriangles += appendTriangles(m_world, material, number, light, m_lights.triangles);
        if (m_lights.triangles.size() > before) ++m_lights.emissiveSurfaces;
    }
};

} // namespace

vec3 lightColorOf(const Material& material, const MaterialLibrary& materials) {
    if (material.light.color) return scaleToLargest(*material.light.color);
    TextureLibrary& textures = materials.textures();
    for (const std::string& image : {material.light.lightImage, material.light.editorImage, material.name}) {
        if (image.empty()) continue;
        const auto mean = textures.averageColorOf(image);
        if (mean && *mean != vec3(0.0f)) return scaleToLargest(*mean);
    }
    const vec3 first = firstStageColor(material, textures);
    return first != vec3(0.0f) ? scaleToLargest(first) : vec3(1.0f);
}

vec3 directionOfAngles(float yawDegrees, float pitchDegrees) {
    const float yaw = glm::radians(yawDegrees), pitch = glm::radians(pitchDegrees);
    return {std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch)};
}

bool isTooFaint(const TriangleLight& light, const vec3& point, const vec3& normal) {
    const vec3 to = (light.corner[0] + light.corner[1] + light.corner[2]) / 3.0f - point;
    const float squared = glm::dot(to, to);
    if (!(light.faintest > 0) || !isFarFrom(light, squared)) return false;
    const float cosines = std::max(0.0f, glm::dot(to, normal)) * std::abs(glm::dot(to, light.normal));
    const float strongest = std::max({light.radiance.x, light.radiance.y, light.radiance.z});
    return strongest * light.areaQu2 * cosines <= light.faintest * squared * squared;
}

bool measureTriangle(TriangleLight& light) {
    // In double: slivers of far away geometry keep a direction.
    const dvec3 a(light.corner[0]), b(light.corner[1]), c(light.corner[2]);
    const dvec3 cross = glm::cross(c - a, b - a);
    const double length = glm::length(cross);
    light.areaQu2 = static_cast<float>(length * 0.5);
    if (!(light.areaQu2 > 0.0f)) return false;
    light.normal = vec3(cross / length);
    return true;
}

std::vector<TriangleLight> skyTriangles(const World& world, const MaterialLibrary& materials, const LightSet& lights) {
    std::vector<TriangleLight> triangles;
    for (const SkyLight& sky : lights.skies) {
        TriangleLight light;
        light.radiance = sky.color * (sky.radiosity / std::numbers::pi_v<float>);
        light.upward = sky.upperHemisphere;
        const MaterialId material = world.surfaces[static_cast<size_t>(sky.surface)].material;
        appendTriangles(world, materials.get(material), sky.surface, light, triangles);
    }
    return triangles;
}

LightSet extractLights(const World& world, const MaterialLibrary& materials) {
    return Extractor(world, materials).run();
}

} // namespace q3rt
