#include "scene/lost_lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "scene/lights_build.hpp"

namespace q3rt {
namespace {

constexpr float kPointScale = 7500.0f;      // intensity of light 1
constexpr float kRadiosityOfValue = 0.75f;  // of q3map_surfacelight 1, luxel units
constexpr float kSkyLightHalf = 0.5f;       // of q3map_skylight 1
constexpr float kTargetDistanceQu = 256.0f; // from a spot light to its target: whole units are fine enough there
constexpr float kLargestNumber = 1e9f;      // of a file: products of two such numbers are still finite

float largest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

std::string numbers(std::initializer_list<float> values, int digits) {
    std::string text;
    for (const float value : values)
        text += formatText("%s%.*g", text.empty() ? "" : " ", digits, double(value));
    return text;
}

std::string pair(std::string_view key, const std::string& value) {
    return "\"" + std::string(key) + "\" \"" + value + "\"";
}

std::string color(const vec3& c) { return numbers({c.x, c.y, c.z}, 2); }

std::string floorText(const vec3& floor) {
    return floor == vec3(floor.x) ? numbers({floor.x}, 4) : numbers({floor.x, floor.y, floor.z}, 4);
}

std::string wholeUnits(const vec3& point) {
    const vec3 whole = glm::round(point) + 0.0f; // no -0
    return formatText("%.0f %.0f %.0f", double(whole.x), double(whole.y), double(whole.z));
}

std::string sunText(const SunLight& sun) {
    const float irradiance = largest(sun.irradiance);
    const vec3 c = irradiance > 0 ? sun.irradiance / irradiance : vec3(1);
    const float degrees = glm::degrees(std::atan2(sun.direction.y, sun.direction.x)),
                elevation = glm::degrees(std::asin(std::clamp(sun.direction.z, -1.0f, 1.0f)));
    return color(c) + " " + numbers({irradiance}, 3) + " " + numbers({degrees, elevation}, 4) + " " +
           numbers({glm::degrees(sun.halfAngleRadians)}, 2);
}

std::string pointText(const PointLight& light, size_t number) {
    const float intensity = largest(light.intensity);
    std::string text = "{ " + pair("classname", "light") + " " + pair("origin", wholeUnits(light.origin)) + " " +
                       pair("light", numbers({intensity / kPointScale}, 3));
    if (const vec3 c = light.intensity / intensity; c != vec3(1)) text += " " + pair("_color", color(c));
    if (!light.spot) return text + " }\n";
    const std::string target = formatText("t%zu", number);
    text +=
        " " + pair("target", target) + " " + pair("radius", numbers({kTargetDistanceQu * light.tangent()}, 3)) + " }\n";
    return text + "{ " + pair("classname", "info_null") + " " + pair("targetname", target) + " " +
           pair("origin", wholeUnits(light.origin + kTargetDistanceQu * light.direction)) + " }\n";
}

/// Words of a value that must be numbers.
std::vector<float> parseNumbers(std::string_view text, size_t least, size_t most, const std::string& where) {
    std::vector<float> values;
    int line = 1;
    while (const auto token = nextScriptToken(text, line, false)) {
        char* end = nullptr;
        const float value = std::strtof(token->c_str(), &end);
        if (*end != 0 || !(std::abs(value) <= kLargestNumber))
            throw ContentError(formatText("%s: '%s' is not a number up to 1e9; correct the line, or delete the file",
                                          where.c_str(), token->c_str()));
        values.push_back(value);
    }
    if (values.size() < least || values.size() > most)
        throw ContentError(formatText("%s: %zu numbers are needed, not %zu; correct the line, or delete the file",
                                      where.c_str(), least, values.size()));
    return values;
}

class Reader {
  public:
    Reader(std::string_view text, std::string_view name)
        : m_rest(text)
        , m_name(name) {}

    LostLights run() {
        while (const auto token = nextScriptToken(m_rest, m_line, false)) {
            if (*token != "{") fail("'" + *token + "' stands where { should");
            readEntity();
        }
        checkTargets();
        LightSet found;
        addEntityLights(m_entities, found);
        m_lights.points = std::move(found.points);
        m_lights.suns.insert(m_lights.suns.end(), found.suns.begin(), found.suns.end());
        return std::move(m_lights);
    }

  private:
    std::string_view m_rest;
    std::string_view m_name;
    int m_line = 1;
    LostLights m_lights;
    std::vector<MapEntity> m_entities;
    std::vector<int> m_lineOfEntity;

    std::string where() const { return formatText("%.*s, line %d", int(m_name.size()), m_name.data(), m_line); }
    [[noreturn]] void fail(const std::string& what) const {
        throw ContentError(where() + ": " + what + "; correct the line, or delete the file");
    }

    void readEntity() {
        MapEntity entity;
        const int first = m_line;
        while (true) {
            auto key = nextScriptToken(m_rest, m_line, false);
            if (!key) fail(formatText("the entity of line %d does not end", first));
            if (*key == "}") break;
            auto value = nextScriptToken(m_rest, m_line, false);
            if (!value || *value == "}" || *value == "{") fail("the key '" + *key + "' has no value");
            readKey(*key, *value);
            entity.pairs.emplace_back(std::move(*key), std::move(*value));
        }
        if (entity.className() == "worldspawn") m_lights.ambientColor = entity.vector("_color").value_or(vec3(1));
        if (entity.className() == "light" && !entity.value("origin")) fail("a light without an origin");
        m_entities.push_back(std::move(entity));
        m_lineOfEntity.push_back(first);
    }

    /// A spot light whose target is missing would shine all around.
    void checkTargets() {
        for (size_t i = 0; i < m_entities.size(); ++i) {
            const auto target = m_entities[i].value("target");
            if (!target || std::any_of(m_entities.begin(), m_entities.end(), [&](const MapEntity& other) {
                    return other.value("targetname") == target && other.value("origin");
                }))
                continue;
            m_line = m_lineOfEntity[i];
            fail("no entity has the targetname '" + std::string(*target) + "' and an origin");
        }
    }

    /// Keys mean the same in every entity: a worldspawn has no origin and a light no sun. Their case means nothing, as
    /// to MapEntity: whatever that finds was checked here.
    void readKey(std::string_view written, const std::string& value) {
        const auto given = [&](size_t least, size_t most) { return parseNumbers(value, least, most, where()); };
        const std::string key = toLowerAscii(written);
        const size_t space = key.find(' ');
        const std::string_view keyword = std::string_view(key).substr(0, space);
        if (key == "_lightmap") {
            m_lights.lightmap = value;
        } else if (key == "_compensate") {
            m_lights.compensate = given(1, 1)[0];
            if (!(m_lights.compensate > 0)) fail("_compensate must be above 0");
        } else if (key == "_faintest") {
            m_lights.faintest = std::max(0.0f, given(1, 1)[0]);
        } else if (key == "_faintestsurface") {
            m_lights.faintestSurface = std::max(0.0f, given(1, 1)[0]);
        } else if (key == "_bounce") {
            m_lights.bounce = std::max(0.0f, given(1, 1)[0]);
        } else if (key == "_stage") {
            const std::vector<float> v = given(2, 2);
            m_lights.stage = static_cast<size_t>(std::max(0.0f, v[0]));
            m_lights.budget = static_cast<size_t>(std::max(0.0f, v[1]));
        } else if (key == "ambient") {
            m_lights.ambientValue = std::max(0.0f, given(1, 1)[0]);
        } else if (key == "_minlight") {
            const std::vector<float> v = given(1, 3);
            if (v.size() == 2) fail("_minlight has one number, or three");
            m_lights.floor = glm::max(v.size() == 3 ? vec3(v[0], v[1], v[2]) : vec3(v[0]), vec3(0));
        } else if (keyword == "q3map_surfacelight" || keyword == "q3map_skylight") {
            if (space == std::string_view::npos) fail("no shader after " + std::string(keyword));
            const std::vector<float> v = given(4, 4);
            auto& list = keyword == "q3map_surfacelight" ? m_lights.surfaceLights : m_lights.skyLights;
            list.push_back({std::string(written.substr(space + 1)), std::max(0.0f, v[0]),
                            glm::max(vec3(v[1], v[2], v[3]), vec3(0))});
        } else if (key == "q3map_sun") {
            const std::vector<float> v = given(6, 7);
            m_lights.suns.push_back({directionOfAngles(v[4], v[5]), glm::max(vec3(v[0], v[1], v[2]) * v[3], vec3(0)),
                                     v.size() > 6 ? glm::radians(v[6]) : 0.0f});
        } else if (key == "origin") {
            given(3, 3);
        } else if (key == "_color") {
            const std::vector<float> v = given(3, 3);
            if (std::min({v[0], v[1], v[2]}) < 0) fail("a colour below 0");
        } else if (key == "light" || key == "_light" || key == "radius" || key == "_sun" || key == "_deviance") {
            given(1, 1);
        }
    }
};

} // namespace

std::string lightmapFingerprint(const Bsp& bsp) {
    uint64_t hash = 14695981039346656037u; // FNV-1a
    for (const uint8_t byte : bsp.lightmaps)
        hash = (hash ^ byte) * 1099511628211u;
    return formatText("%016llx", static_cast<unsigned long long>(hash));
}

std::string formatLostLights(const LostLights& lights, std::string_view map) {
    std::string text = "// Light of " + std::string(map) + " as its lightmap has it: q3rt relight\n{\n";
    text += pair("classname", "worldspawn") + "\n" + pair("_lightmap", lights.lightmap) + "\n";
    if (lights.compensate != 1) text += pair("_compensate", numbers({lights.compensate}, 4)) + "\n";
    if (lights.faintest > 0) text += pair("_faintest", numbers({lights.faintest}, 4)) + "\n";
    if (lights.faintestSurface > 0) text += pair("_faintestSurface", numbers({lights.faintestSurface}, 4)) + "\n";
    if (lights.bounce > 0) text += pair("_bounce", numbers({lights.bounce}, 2)) + "\n";
    if (lights.stage > 0) text += pair("_stage", formatText("%zu %zu", lights.stage, lights.budget)) + "\n";
    if (lights.ambientValue > 0)
        text += pair("ambient", numbers({lights.ambientValue}, 3)) + " " + pair("_color", color(lights.ambientColor)) +
                "\n";
    if (lights.floor != vec3(0)) text += pair("_minlight", floorText(lights.floor)) + "\n";
    for (const auto& [keyword, list] :
         {std::pair("q3map_surfacelight ", &lights.surfaceLights), {"q3map_skylight ", &lights.skyLights}})
        for (const LostLights::Strength& strength : *list)
            text +=
                pair(keyword + strength.material, numbers({strength.value}, 3) + " " + color(strength.color)) + "\n";
    for (const SunLight& sun : lights.suns)
        text += pair("q3map_sun", sunText(sun)) + "\n";
    text += "}\n";
    for (size_t i = 0; i < lights.points.size(); ++i)
        text += pointText(lights.points[i], i);
    return text;
}

LostLights parseLostLights(std::string_view text, std::string_view name) { return Reader(text, name).run(); }

namespace {

/// Skies whose scripts say nothing of light today.
void addLostSkies(const World& world, const MaterialLibrary& materials,
                  const std::unordered_map<std::string_view, const LostLights::Strength*>& strengths, float scale,
                  LightSet& lights) {
    std::vector<bool> shines(world.surfaces.size(), false);
    for (const SkyLight& sky : lights.skies)
        if (sky.surface >= 0 && !sky.upperHemisphere) shines[static_cast<size_t>(sky.surface)] = true;
    for (size_t s = 0; s < world.surfaces.size(); ++s) {
        const Material& material = materials.get(world.surfaces[s].material);
        if (!world.surfaces[s].drawn || !material.isSky || shines[s]) continue;
        const auto found = strengths.find(material.name);
        if (found != strengths.end() && found->second->value > 0)
            lights.skies.push_back(
                {scale * kRadiosityOfValue * found->second->value, found->second->color, static_cast<int>(s), false});
    }
}

} // namespace

void applyLostLights(const LostLights& lost, const World& world, const MaterialLibrary& materials, LightSet& lights) {
    // The file has the compiler's own numbers; the bake was darkened after it had added them up.
    const float scale = 1 / lost.compensate;
    std::unordered_map<std::string_view, const LostLights::Strength*> surfaceLights, skyLights;
    for (const LostLights::Strength& strength : lost.surfaceLights)
        surfaceLights.emplace(strength.material, &strength);
    for (const LostLights::Strength& strength : lost.skyLights)
        skyLights.emplace(strength.material, &strength);
    const auto find = [&](const auto& list, int surface) -> const LostLights::Strength* {
        if (surface < 0) return nullptr;
        const auto found = list.find(materials.get(world.surfaces[static_cast<size_t>(surface)].material).name);
        return found != list.end() ? found->second : nullptr;
    };
    for (TriangleLight& light : lights.triangles) {
        light.radiance *= scale;
        light.faintest = scale * lost.faintestSurface;
        if (const auto* strength = find(surfaceLights, light.surface))
            light.radiance =
                strength->color * (scale * kRadiosityOfValue * strength->value / std::numbers::pi_v<float>);
    }
    for (SkyLight& sky : lights.skies) {
        sky.radiosity *= scale;
        const auto* strength = find(sky.upperHemisphere ? skyLights : surfaceLights, sky.surface);
        if (!strength) continue;
        sky.radiosity = scale * strength->value * (sky.upperHemisphere ? kSkyLightHalf : kRadiosityOfValue);
        sky.color = strength->color;
    }
    std::erase_if(lights.triangles, [](const TriangleLight& light) { return light.radiance == vec3(0); });
    std::erase_if(lights.skies, [](const SkyLight& sky) { return !(sky.radiosity > 0); });
    addLostSkies(world, materials, surfaceLights, scale, lights);
    lights.ambient = scale * lost.ambientValue * lost.ambientColor;
    lights.floor = scale * lost.floor;
    lights.suns = lost.suns;
    lights.points = lost.points;
    for (SunLight& sun : lights.suns)
        sun.irradiance *= scale;
    for (PointLight& point : lights.points) {
        point.intensity *= scale;
        point.faintest = scale * lost.faintest;
    }
}

} // namespace q3rt
