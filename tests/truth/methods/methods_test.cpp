// Equality of methods, by enumeration: with frozen sample positions on the lights, the sum over all outcomes of the
// choice of a light, weighted by their probabilities, is the value of all lights with a shadow ray each; and no
// culling changes that value. What runs is the shaders' own text; there is no chance in it.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <unordered_map>
#include <utility>

#include "map_lights.hpp"
#include "renderer_rt/packed_grid.hpp"
#include "shaders/shared/constants.h"
#include "support/game_data.hpp"
#include "tracer/choice_number.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr double kTolerance = 1e-4; ///< relative
constexpr float kCloseCall = 0x1p-22f;
constexpr size_t kPointCount = 2000;
constexpr uint kLongestFullEnumeration = 128; ///< lights of a row

double sumOf(const vec3& v) { return double(v.x) + double(v.y) + double(v.z); }

uint bitsOf(float number) { return static_cast<uint>(number * 0x1p24f) << 8; }

/// Place on the lights, for all of them alike: numbers of [0, 1) that only depend on the point.
vec2 frozenSample(uint32_t point) {
    uint64_t h = (uint64_t(point) + 1) * 0x9e3779b97f4a7c15u;
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
        return recall(direction, [&] { return m_map.isVisible(origin, direction); });
    }
    bool reachesSky(const vec3& origin, const vec3& direction) {
        return recall(direction, [&] { return m_map.reachesSky(origin, direction); });
    }

  private:
    bool recall(const vec3& direction, const auto& trace) {
        uint32_t bits[3];
        std::memcpy(bits, &direction, sizeof bits);
        const uint64_t key = (uint64_t(bits[0]) * 0x9e3779b97f4a7c15u) ^ (uint64_t(bits[1]) << 32 | bits[2]);
        const auto [entry, isNew] = m_known.try_emplace(key, false);
        if (isNew) entry->second = trace();
        return entry->second;
    }

    const MapLights& m_map;
    std::unordered_map<uint64_t, bool> m_known;
};

/// One point's lights and choices. Lights are numbered: triangles, points, then those of no row.
class PointMethods {
  public:
    explicit PointMethods(const MapLights& map)
        : m_map(map)
        , m_shadows(map)
        , m_rowLightCount(static_cast<uint>(map.tables().triangles.size() + map.tables().points.size()))
        , m_otherCount(static_cast<uint>(map.tables().others.size())) {
        m_inputs.visible = [this](const vec3& origin, const vec3& direction) {
            return !m_shadowed || m_shadows.isVisible(origin, direction);
        };
        m_inputs.sky = [this](const vec3& origin, const vec3& direction) {
            return !m_shadowed || m_shadows.reachesSky(origin, direction);
        };
        m_inputs.random = [this](uint) {
            const vec2 sample = frozenSample(m_point);
            return glm::uvec4(bitsOf(sample.x), bitsOf(sample.y), bitsOf(m_keeps), m_start);
        };
    }

    void setPoint(uint32_t number, const RtPixel& pixel) {
        m_point = number;
        m_pixel = pixel;
        m_shadows.clear();
        m_unshadowed.assign(m_rowLightCount + m_otherCount, vec3(0.0f));
        m_lit = m_unshadowed;
        for (uint light = 0; light < m_rowLightCount + m_otherCount; ++light) {
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
    dvec3 enumerateChoices(uint cullLights, uint candidates, float sunSeen);

    /// What outcomes would have added that are rarer than the last bit of a random number, which can't be chosen.
    double takeMissed() { return std::exchange(m_missed, 0.0); }

    /// Lights that the point tries.
    RtLightRow rowOf(uint cullLights) {
        prepare(cullLights, 0);
        return rowOfPixel(m_inputs, m_pixel);
    }

  private:
    void prepare(uint cullLights, uint lightsPerPixel) {
        m_inputs.frame = m_map.describeFrame();
        m_inputs.frame.cullLights = cullLights;
        m_inputs.frame.lightsPerPixel = lightsPerPixel;
        m_shadowed = true;
    }

    vec3 runAlone(uint light, bool shadowed);
    void pickCandidates(const RtLightRow& row, uint candidates, uint start);
    void weighCandidates(const RtLightRow& row, float sunSeen);
    double probabilityOf(size_t kept) const;
    double m_missed = 0;
    dvec3 runKept(size_t kept);

    const MapLights& m_map;
    ShadowCache m_shadows;
    const uint m_rowLightCount, m_otherCount;
    DirectInputs m_inputs;
    uint32_t m_point = 0;
    RtPixel m_pixel{};
    bool m_shadowed = true;
    uint m_slots = 0, m_start = 0; ///< candidates of the row; the number that draws them
    float m_keeps = 0;             ///< the number that keeps one of them
    std::vector<Drawn> m_slot;
    std::vector<double> m_weight; ///< of the candidates, then of the lights of no row
    std::vector<double> m_given;  ///< what each gives without a shadow
    std::vector<vec3> m_unshadowed, m_lit;
};

vec3 PointMethods::runAlone(uint light, bool shadowed) {
    prepare(0, 0);
    m_shadowed = shadowed;
    const uint count = light < m_rowLightCount ? 1 : 0;
    const RtLightEntry entry{light, glm::packUnorm2x16(vec2(1.0f)), 0, 1};
    const RtLightRow row{0, count, count, m_map.tables().rows.outside().seesSky, 0};
    m_inputs.frame.clusterCount = 0;
    m_inputs.frame.lightRows = reinterpret_cast<uint64_t>(&row);
    m_inputs.frame.lightEntries = reinterpret_cast<uint64_t>(&entry);
    m_inputs.frame.lightCount = 1 - count;
    if (count == 0) m_inputs.frame.lights += (light - m_rowLightCount) * sizeof(RtLight);
    return runDirectStage(m_inputs, m_pixel);
}

void PointMethods::pickCandidates(const RtLightRow& row, uint candidates, uint start) {
    m_start = start;
    m_slots = row.facing > 0 ? candidates : 0;
    m_slot.clear();
    for (uint i = 0; i < m_slots; ++i)
        m_slot.push_back(drawFromRow(m_inputs, row, start + i * (~0u / candidates)));
}

void PointMethods::weighCandidates(const RtLightRow& row, float sunSeen) {
    m_weight.clear();
    m_given.clear();
    for (const Drawn& slot : m_slot) {
        m_given.push_back(sumOf(m_unshadowed[slot.light]) * double(slot.weight) / m_slots);
        m_weight.push_back(m_given.back() * double(slot.seen));
    }
    for (uint i = 0; i < m_otherCount; ++i) {
        const bool isSun = m_map.tables().others[i].kind == kLightSun;
        const double seen = row.seesSky != 0 ? std::max(sunSeen, kLeastSunShare) : 0;
        m_given.push_back(sumOf(m_unshadowed[m_rowLightCount + i]));
        m_weight.push_back(isSun ? m_given.back() * seen : m_given.back());
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

/// The stage's value when that candidate is kept, times the probability of it.
dvec3 PointMethods::runKept(size_t kept) {
    const double probability = probabilityOf(kept);
    if (probability <= 0) return dvec3(0);
    m_keeps = numberThatKeeps(m_weight, kept);
    // The shader's own weights differ by their rounding: its number must not be a close call.
    const bool sure =
        keptCandidate(m_weight, m_keeps - kCloseCall) == kept && keptCandidate(m_weight, m_keeps + kCloseCall) == kept;
    if (!sure) {
        EXPECT_LT(probability, 1e-5) << "an outcome that no number gives";
        m_missed += m_given[kept];
        return dvec3(0);
    }
    return dvec3(runDirectStage(m_inputs, m_pixel)) * probability;
}

dvec3 PointMethods::enumerateChoices(uint cullLights, uint candidates, float sunSeen) {
    prepare(cullLights, 1);
    GridCell cell{};
    cell.surfaces.valid = cell.models.valid = true;
    cell.sunSeen = sunSeen;
    m_inputs.frame.candidatesPerChoice = candidates;
    m_inputs.frame.flags |= kFrameGrid;
    const std::vector<glm::uvec4> packed = packGrid({cell});
    m_inputs.frame.grid = reinterpret_cast<uint64_t>(packed.data());
    m_inputs.frame.gridOrigin = shadowOriginOf(m_pixel);
    m_inputs.frame.gridCellSize = vec3(1.0f);
    m_inputs.frame.gridCounts = ivec3(1);
    const RtLightRow row = rowOfPixel(m_inputs, m_pixel);
    // Every candidate goes through all that may be drawn in its place, the others follow from the same number. All
    // candidates are distributed alike: of long rows one of them stands for all.
    const bool all = row.facing <= kLongestFullEnumeration;
    dvec3 sum(0);
    for (uint column = 0; column < row.facing; ++column) {
        const RtLightEntry& entry = m_map.tables().rows.entries[row.first + column];
        const auto chance = double(chanceOfColumn(entry));
        for (const bool own : {true, false}) {
            const double share = (own ? chance : 1 - chance) / row.facing;
            if (share <= 0) continue;
            const double inColumn = own ? 0.5 * chance : 0.5 + 0.5 * chance;
            const auto bits = static_cast<uint>((column + inColumn) * 0x1p32 / row.facing);
            const uint lightWanted = own ? entry.light : m_map.tables().rows.entries[row.first + entry.other].light;
            // The number's last bit may be too coarse for a share: then it must be next to nothing of its light's own.
            if (drawFromRow(m_inputs, row, bits).light != lightWanted) {
                const double weight =
                    double(own ? entry.weight : m_map.tables().rows.entries[row.first + entry.other].weight);
                EXPECT_LT(share * weight, 1e-6);
                continue;
            }
            for (uint slot = all ? 0 : m_point % candidates; slot < candidates; slot += all ? 1 : candidates) {
                pickCandidates(row, candidates, bits - slot * (~0u / candidates));
                weighCandidates(row, sunSeen);
                sum += runKept(slot) * (all ? share : share * candidates);
            }
        }
    }
    // Lights of no row are candidates always, whatever is drawn.
    pickCandidates(row, candidates, 0);
    weighCandidates(row, sunSeen);
    for (uint i = 0; i < m_otherCount; ++i)
        sum += runKept(m_slots + i);
    return sum;
}

/// `floor`: what can't be told from nothing.
double relativeDifference(const dvec3& a, const dvec3& b, double floor = 0) {
    const double size = std::max(glm::length(a), glm::length(b));
    return size > 0 ? std::max(0.0, glm::length(a - b) - floor) / size : 0;
}

struct Report {
    double worstSum = 0, worstChoice = 0, worstCull = 0;
    size_t lit = 0, culledWrongly = 0, enumerations = 0, lights[3] = {}; ///< tried, by rt_cullLights
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
        for (const uint cull : {0u, 1u, 2u}) {
            const RtLightRow row = methods.rowOf(cull);
            const dvec3 culled = methods.runAll(cull);
            report.lights[cull] += row.count;
            const double difference = relativeDifference(all, culled);
            report.worstCull = std::max(report.worstCull, difference);
            if (difference > kTolerance) {
                ++report.culledWrongly;
                const vec3& p = pixel.position;
                std::printf("%s: at %.1f %.1f %.1f rt_cullLights %u changes %.3f to %.3f luxel units\n", name.c_str(),
                            double(p.x), double(p.y), double(p.z), cull, 63.75 * all.x, 63.75 * culled.x);
            }
            const float sunSeen = static_cast<float>(number % 5) * 0.25f;
            for (const uint candidates : {1u, 4u}) {
                const dvec3 chosen = methods.enumerateChoices(cull, candidates, sunSeen);
                const double missed = methods.takeMissed();
                report.worstChoice = std::max(report.worstChoice, relativeDifference(culled, chosen, missed));
                ++report.enumerations;
            }
        }
        ++number;
    }
    std::printf("%s: %u points (%zu lit), mean lights %.1f, by cluster %.1f, facing %.1f; %zu enumerations; worst "
                "relative difference: sum of lights %.1e, choice %.1e, culling %.1e (%zu points beyond)\n",
                name.c_str(), number, report.lit, double(report.lights[0]) / number, double(report.lights[1]) / number,
                double(report.lights[2]) / number, report.enumerations, report.worstSum, report.worstChoice,
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

/// L of a pixel with a fixed place on every light.
vec3 lightOf(const MapLights& map, const RtPixel& pixel, uint lightsPerPixel) {
    DirectInputs inputs;
    inputs.frame = map.describeFrame();
    inputs.frame.lightsPerPixel = lightsPerPixel;
    inputs.frame.candidatesPerChoice = 1;
    inputs.frame.lightScale = 1;
    inputs.visible = [&](const vec3& origin, const vec3& direction) { return map.isVisible(origin, direction); };
    inputs.sky = [&](const vec3& origin, const vec3& direction) { return map.reachesSky(origin, direction); };
    inputs.random = [](uint) { return glm::uvec4(1u << 30, 1u << 31, 1u << 29, 1u << 31); };
    return runDirectStage(inputs, pixel);
}

TEST(DirectStage, ThinSurfacesTakeTheLightOfBothSides) {
    TestGame game;
    const MapLights map(game, squareLightRoom::kName);
    int bothLit = 0;
    for (const RtPixel& wall : map.pickPoints(500)) {
        // A sheet in the middle of the room, as that wall is turned and a little more.
        RtPixel front = wall;
        front.position = wall.position * 0.25f + vec3(0, 0, 80);
        front.normal = front.geometricNormal = glm::normalize(wall.geometricNormal + vec3(0.3f, 0.2f, 0.1f));
        RtPixel back = front, thin = front;
        back.normal = back.geometricNormal = -front.normal;
        thin.lit |= kLitThin;
        for (const uint lightsPerPixel : {0u, 1u}) {
            const vec3 sides[2] = {lightOf(map, front, lightsPerPixel), lightOf(map, back, lightsPerPixel)};
            EXPECT_EQ(lightOf(map, thin, lightsPerPixel), sides[0] + sides[1]);
            if (sides[0].x != sides[1].x && sides[1].x > 0) ++bothLit;
        }
    }
    EXPECT_GT(bothLit, 200);
}

TEST(DirectStage, ModelsHaveTheEnginesLeastLight) {
    TestGame game;
    const MapLights map(game, squareLightRoom::kName);
    for (RtPixel pixel : map.pickPoints(20)) {
        const vec3 light = lightOf(map, pixel, 0);
        pixel.lit |= kLitModel;
        EXPECT_EQ(lightOf(map, pixel, 0), light + vec3(kModelLeastLight));
    }
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
