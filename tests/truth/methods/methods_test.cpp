// Equality of methods, by enumeration: with frozen sample positions on the lights, the sum over all outcomes of the
// choice of a light, weighted by their probabilities, is the value of all lights with a shadow ray each; and no
// culling changes that value. What runs is the shaders' own text; there is no chance in it.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <unordered_map>

#include "map_lights.hpp"
#include "support/game_data.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr double kTolerance = 1e-4;      ///< relative
constexpr float kBelowOne = 0.99999994f; ///< largest of the shader's random numbers
constexpr size_t kPointCount = 2000;
constexpr size_t kLongestFullEnumeration = 128; ///< lights; beyond that only candidates are enumerated

double sumOf(const vec3& v) { return double(v.x) + double(v.y) + double(v.z); }

/// Numbers of [0, 1) that only depend on their key.
vec2 frozenSample(uint32_t point, uint32_t light) {
    uint64_t h = (uint64_t(point) << 32 | light) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
    h *= 0xbf58476d1ce4e5b9u;
    h ^= h >> 32;
    return {float(h & 0xffffff) * 0x1p-24f, float(h >> 24 & 0xffffff) * 0x1p-24f};
}

/// Shadow rays of one point: each is traced once.
class ShadowCache {
  public:
    explicit ShadowCache(const MapLights& map)
        : m_map(map) {}
    void clear() { m_known.clear(); }
    bool isVisible(const vec3& origin, const vec3& direction) {
        uint32_t bits[3];
        std::memcpy(bits, &direction, sizeof bits);
        const uint64_t key = (uint64_t(bits[0]) * 0x9e3779b97f4a7c15u) ^ (uint64_t(bits[1]) << 32 | bits[2]);
        const auto [entry, isNew] = m_known.try_emplace(key, false);
        if (isNew) entry->second = m_map.isVisible(origin, direction);
        return entry->second;
    }

  private:
    const MapLights& m_map;
    std::unordered_map<uint64_t, bool> m_known;
};

/// One point's lights and choices.
class PointMethods {
  public:
    explicit PointMethods(const MapLights& map)
        : m_map(map)
        , m_shadows(map)
        , m_triangleCount(static_cast<uint>(map.tables().triangles.size()))
        , m_otherCount(static_cast<uint>(map.tables().others.size())) {
        m_inputs.visible = [this](const vec3& origin, const vec3& direction) {
            return !m_shadowed || m_shadows.isVisible(origin, direction);
        };
        m_inputs.random = [this](uint dimension) { return randomOf(dimension - kFirstLightDimension); };
    }

    void setPoint(uint32_t number, const RtPixel& pixel) {
        m_point = number;
        m_pixel = pixel;
        m_shadows.clear();
        m_unshadowed.assign(m_triangleCount + m_otherCount, vec3(0.0f));
        m_lit = m_unshadowed;
        for (uint light = 0; light < m_triangleCount + m_otherCount; ++light) {
            m_unshadowed[light] = runAlone(light, false);
            if (m_unshadowed[light] != vec3(0.0f)) m_lit[light] = runAlone(light, true);
        }
    }

    /// Sum of the lights, each run alone, in double.
    dvec3 sumOfLights() const {
        dvec3 sum(0);
        for (const vec3& light : m_lit)
            sum += dvec3(light);
        return sum;
    }

    dvec3 runAll(uint cullLights) {
        prepare(cullLights, 0);
        return dvec3(runDirectStage(m_inputs, m_pixel));
    }

    /// Sum of all outcomes of one choice among `candidates`, each times its probability.
    dvec3 enumerateChoices(uint cullLights, uint candidates, float skySeen);

    /// An outcome rarer than the last bit of a random number can't be chosen: what that may take away, for each
    /// candidate.
    double resolution() const {
        dvec3 sum(0);
        for (const vec3& light : m_unshadowed)
            sum += dvec3(light);
        return glm::length(sum) * 0x1p-24;
    }

    /// Lights that the point's row tries.
    RtLightRow rowOf(uint cullLights);

  private:
    vec4 randomOf(uint dimension) const {
        const bool isTriangle = dimension < m_triangleCount;
        if (!m_choosing || !isTriangle) {
            const uint light = m_alone ? *m_alone : dimension;
            const float reservoir = m_choosing && dimension - m_triangleCount + m_slots > m_kept ? kBelowOne : 0.0f;
            return {frozenSample(m_point, light), reservoir, 0};
        }
        const Slot& slot = m_slot[dimension];
        return {frozenSample(m_point, slot.light), dimension > m_kept ? kBelowOne : 0.0f, slot.random};
    }

    void prepare(uint cullLights, uint lightsPerPixel) {
        m_inputs.frame = m_map.describeFrame();
        m_inputs.frame.cullLights = cullLights;
        m_inputs.frame.lightsPerPixel = lightsPerPixel;
        m_shadowed = true;
        m_alone.reset();
        m_choosing = false;
    }

    vec3 runAlone(uint light, bool shadowed);
    void pickCandidates(const RtLightRow& row, uint candidates, uint round);
    double probabilityOf(size_t kept) const;

    struct Slot {
        uint light = 0, count = 1; ///< the light that it stands for, and how many it was taken from
        float random = 0;          ///< number that takes it
    };
    const MapLights& m_map;
    ShadowCache m_shadows;
    const uint m_triangleCount, m_otherCount;
    DirectInputs m_inputs;
    uint32_t m_point = 0;
    RtPixel m_pixel{};
    bool m_shadowed = true, m_choosing = false;
    std::optional<uint> m_alone;
    uint m_slots = 0, m_kept = 0; ///< triangle candidates; the candidate that is to win
    std::vector<Slot> m_slot;
    std::vector<double> m_weight; ///< of triangle candidates, then of the other lights
    std::vector<vec3> m_unshadowed, m_lit;
};

vec3 PointMethods::runAlone(uint light, bool shadowed) {
    prepare(0, 0);
    m_shadowed = shadowed;
    m_alone = light;
    const bool isTriangle = light < m_triangleCount;
    const RtLightRow row{0, isTriangle ? 1u : 0u, m_map.tables().rows.back().seesSky};
    m_inputs.frame.clusterCount = 0;
    m_inputs.frame.lightRows = reinterpret_cast<uint64_t>(&row);
    m_inputs.frame.lightIndices = reinterpret_cast<uint64_t>(&light);
    m_inputs.frame.lightCount = isTriangle ? 0 : 1;
    if (!isTriangle) m_inputs.frame.lights += (light - m_triangleCount) * sizeof(RtLight);
    return runDirectStage(m_inputs, m_pixel);
}

RtLightRow PointMethods::rowOf(uint cullLights) {
    const LightTables& tables = m_map.tables();
    if (cullLights == 0) return tables.rows.back();
    const vec3 origin = shadowOriginOf(m_pixel);
    int node = tables.nodes.empty() ? -1 : 0;
    while (node >= 0) {
        const RtNode& at = tables.nodes[static_cast<size_t>(node)];
        node = glm::dot(at.plane.normal, origin) - at.plane.distance > 0 ? at.front : at.back;
    }
    const int cluster = -2 - node;
    return cluster >= 0 && cluster < static_cast<int>(m_map.clusterCount()) ? tables.rows[static_cast<size_t>(cluster)]
                                                                            : tables.rows.back();
}

void PointMethods::pickCandidates(const RtLightRow& row, uint candidates, uint round) {
    m_slots = std::min(row.count, candidates);
    m_slot.assign(m_slots, {});
    const float share = m_slots > 0 ? static_cast<float>(row.count) / static_cast<float>(m_slots) : 0.0f;
    for (uint i = 0; i < m_slots; ++i) {
        const auto first = static_cast<uint>(static_cast<float>(i) * share);
        const uint end = i + 1 == m_slots ? row.count : static_cast<uint>(static_cast<float>(i + 1) * share);
        const uint pick = round % (end - first);
        m_slot[i] = {m_map.tables().indices[row.first + first + pick], end - first,
                     (static_cast<float>(pick) + 0.5f) / static_cast<float>(end - first)};
    }
}

/// Of the candidate that is kept: it wins against those before it and loses to none after it.
double PointMethods::probabilityOf(size_t kept) const {
    double before = 0, probability = 1;
    for (size_t i = 0; i < m_weight.size(); ++i) {
        before += m_weight[i];
        if (m_weight[i] <= 0) continue;
        if (i == kept) probability = m_weight[i] / before;
        if (i > kept) probability *= 1 - m_weight[i] / before;
    }
    return m_weight[kept] > 0 ? probability : 0;
}

dvec3 PointMethods::enumerateChoices(uint cullLights, uint candidates, float skySeen) {
    const RtLightRow row = rowOf(cullLights);
    const RtGridCell cell{vec3(0.0f), 1, vec3(0.0f), vec3(0.0f), skySeen};
    dvec3 sum(0);
    uint rounds = 1;
    for (uint round = 0; round < rounds; ++round) {
        pickCandidates(row, candidates, round);
        for (const Slot& slot : m_slot)
            rounds = std::max(rounds, slot.count);
        m_weight.clear();
        for (const Slot& slot : m_slot)
            m_weight.push_back(sumOf(m_unshadowed[slot.light]) * slot.count);
        for (uint i = 0; i < m_otherCount; ++i) {
            const bool fromSky = m_map.tables().others[i].kind != kLightSphere;
            const double weight = sumOf(m_unshadowed[m_triangleCount + i]);
            const double sky = row.seesSky != 0 ? std::max(skySeen, kLeastSkyShare) : 0;
            m_weight.push_back(fromSky ? weight * sky : weight);
        }
        for (size_t kept = 0; kept < m_weight.size(); ++kept) {
            // A share's lights are equally likely; shorter shares have gone through all of theirs.
            const bool isTriangle = kept < m_slots;
            if (isTriangle && round >= m_slot[kept].count) continue;
            const double probability = probabilityOf(kept);
            if (probability <= 0) continue;
            prepare(cullLights, 1);
            m_inputs.frame.candidatesPerChoice = candidates;
            m_inputs.frame.flags |= kFrameGrid;
            m_inputs.frame.grid = reinterpret_cast<uint64_t>(&cell);
            m_inputs.frame.gridOrigin = shadowOriginOf(m_pixel);
            m_inputs.frame.gridCellSize = vec3(1.0f);
            m_inputs.frame.gridCounts = ivec3(1);
            m_choosing = true;
            m_kept = static_cast<uint>(kept);
            const double share = 1.0 / (isTriangle ? m_slot[kept].count : rounds);
            sum += dvec3(runDirectStage(m_inputs, m_pixel)) * (probability * share);
        }
    }
    return sum;
}

/// `floor`: what can't be told from nothing.
double relativeDifference(const dvec3& a, const dvec3& b, double floor = 0) {
    const double size = std::max(glm::length(a), glm::length(b));
    return size > 0 ? std::max(0.0, glm::length(a - b) - floor) / size : 0;
}

struct Report {
    double worstSum = 0, worstChoice = 0, worstCull = 0;
    size_t lit = 0, culledWrongly = 0, enumerations = 0, lightsAll = 0, lightsCulled = 0;
};

Report checkMap(FileSource& files, const std::string& name) {
    const MapLights map(files, name);
    PointMethods methods(map);
    Report report;
    uint32_t number = 0;
    for (const RtPixel& pixel : map.pickPoints(kPointCount)) {
        methods.setPoint(number, pixel);
        const dvec3 all = methods.runAll(0);
        if (all != dvec3(0)) ++report.lit;
        report.worstSum = std::max(report.worstSum, relativeDifference(all, methods.sumOfLights()));
        report.lightsAll += methods.rowOf(0).count;
        report.lightsCulled += methods.rowOf(1).count;
        for (const uint cull : {0u, 1u}) {
            const RtLightRow row = methods.rowOf(cull);
            const dvec3 culled = methods.runAll(cull);
            const double difference = relativeDifference(all, culled);
            report.worstCull = std::max(report.worstCull, difference);
            if (difference > kTolerance) {
                ++report.culledWrongly;
                const vec3& p = pixel.position;
                std::printf("%s: at %.1f %.1f %.1f culling changes %.3f to %.3f luxel units\n", name.c_str(),
                            double(p.x), double(p.y), double(p.z), 63.75 * all.x, 63.75 * culled.x);
            }
            const float skySeen = static_cast<float>(number % 5) * 0.25f;
            for (const uint candidates : {1u, 16u, 4096u}) {
                if (candidates > 16 && row.count > kLongestFullEnumeration) continue;
                const dvec3 chosen = methods.enumerateChoices(cull, candidates, skySeen);
                const double floor =
                    methods.resolution() * (std::min(candidates, row.count) + map.tables().others.size());
                report.worstChoice = std::max(report.worstChoice, relativeDifference(culled, chosen, floor));
                ++report.enumerations;
            }
        }
        ++number;
    }
    std::printf("%s: %u points (%zu lit), mean lights %.1f, with culling %.1f; %zu enumerations; worst relative "
                "difference: sum of lights %.1e, choice %.1e, culling %.1e (%zu points beyond)\n",
                name.c_str(), number, report.lit, double(report.lightsAll) / number,
                double(report.lightsCulled) / number, report.enumerations, report.worstSum, report.worstChoice,
                report.worstCull, report.culledWrongly);
    return report;
}

void expectEqualMethods(const Report& report) {
    EXPECT_GT(report.lit, kPointCount / 10);
    EXPECT_LE(report.worstSum, kTolerance);
    EXPECT_LE(report.worstChoice, kTolerance);
    EXPECT_LE(report.worstCull, kTolerance) << report.culledWrongly << " points";
}

TEST(MethodsOfLightChoice, AgreeInTheTestMaps) {
    TestGame game;
    for (const char* map : {squareLightRoom::kName, threeClusterCorridor::kName})
        expectEqualMethods(checkMap(game, map));
}

class MapMethods : public testing::TestWithParam<const char*> {};

TEST_P(MapMethods, Agree) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    expectEqualMethods(checkMap(*files, GetParam()));
}
INSTANTIATE_TEST_SUITE_P(OpenArena, MapMethods, testing::Values("oa_dm1", "oa_shouse", "oacmpctf3"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace q3rt::test
