// A frame does only what its map requires: counted on the device, for eight maps that lack one thing or another.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host/inspect/census.hpp"
#include "host/packaged/engine_process.hpp"
#include "host/trade/session.hpp"
#include "metrics/statistics.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

constexpr PictureSize kSize{96, 72};
constexpr int kSettle = 3; ///< frames until the statistics are those of the view: two in flight
/// Looked at from three player starts each.
const char* const kMaps[] = {"fan",      "q3dm6ish",  "czest1tourney", "oacmpdm5",
                             "oa_minia", "oacmpctf2", "dm4ish",        "oa_dm1"};

MapCensus takeCensusOf(FileSource& files, const std::string& map) {
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + map + ".bsp", materials, WorldSettings{});
    return takeCensus(*world, materials);
}

/// What a frame may do beyond opaque surfaces, in the order of kKindNames.
constexpr size_t kKindCount = 8;
constexpr const char* kKindNames[kKindCount] = {"any hit",         "layers",       "turned rays",        "sky looks",
                                                "triangle lights", "other lights", "searches of layers", "near ranges"};

/// What a map can need, by the census of its scripts.
std::array<bool, kKindCount> needsOf(const MapCensus& census) {
    const auto has = [&](const char* what) { return census.requirements.contains(what); };
    return {has("alpha test"), has("blending") || has("polygon offset") || has("fog"),
            // Panes are blended surfaces with a fake reflection.
            has("portal or mirror") || has("water") || has("slime") || (has("environment mapping") && has("blending")),
            has("sky"), census.triangleLights + census.skyLights > 0,
            census.suns + census.skyLights + census.pointLights > 0,
            has("blending") || has("polygon offset") || has("fog"), false}; // no view weapon here
}

struct Work {
    std::array<uint64_t, kKindCount> counts{};
    std::vector<double> seeingMs; ///< of the passes that make RtPixel
    std::vector<uint8_t> picture; ///< of all views
};

Work measure(TradeSession& session, size_t viewCount, const char* onlyRequired, bool count, int frames) {
    session.apply({kSize,
                   {{"rt_backend", "compute"},
                    {"rt_denoiser", "0"},
                    {"rt_taa", "0"},
                    {"rt_lostLights", "0"}, // the census is of the map's own lights
                    {"rt_countWork", count ? "1" : "0"},
                    {"rt_onlyRequired", onlyRequired}}});
    Work work;
    for (size_t view = 0; view < viewCount; ++view) {
        session.approach(view, kSettle);
        for (int i = 0; i < frames; ++i) {
            const DrawnFrame drawn = session.draw(view, true);
            const auto stats = nlohmann::json::parse(session.stats());
            double seeing = 0;
            for (const char* pass : {"look", "shade", "primary"})
                seeing += stats.at("passes").at(pass).get<double>();
            work.seeingMs.push_back(seeing);
            if (i > 0) continue;
            work.picture.insert(work.picture.end(), drawn.picture->rgb.begin(), drawn.picture->rgb.end());
            if (!count) continue;
            const auto& counted = stats.at("work");
            const std::array<uint64_t, kKindCount> counts = {counted.at("any_hit"),
                                                             counted.at("layers"),
                                                             counted.at("turned_rays"),
                                                             counted.at("sky_looks"),
                                                             stats.at("lights"),
                                                             stats.at("other_lights"),
                                                             stats.at("looks_for").at("layers"),
                                                             stats.at("looks_for").at("near_entities")};
            for (size_t k = 0; k < kKindCount; ++k)
                work.counts[k] += counts[k];
        }
    }
    return work;
}

TEST(OnlyRequired, EightMapsDoNoMoreThanTheyNeed) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    std::array<uint64_t, kKindCount> all{};
    std::array<size_t, kKindCount> lacking{};
    for (const std::string map : kMaps) {
        const std::array<bool, kKindCount> needs = needsOf(takeCensusOf(*files, map));
        const auto source = openMapSource({.map = map, .places = {"spawn:0..2"}}, {});
        TradeSession session(*source, findModule("rt"), false);
        const Work work = measure(session, source->viewNames().size(), "1", true, 1);
        std::printf("%-14s", map.c_str());
        for (size_t k = 0; k < kKindCount; ++k) {
            std::printf(" %s %llu%s", kKindNames[k], static_cast<unsigned long long>(work.counts[k]),
                        needs[k] ? "," : " (not needed),");
            if (!needs[k]) {
                EXPECT_EQ(work.counts[k], 0u) << map << ": " << kKindNames[k];
            }
            lacking[k] += !needs[k];
            all[k] += work.counts[k];
        }
        std::printf("\n");
    }
    EXPECT_EQ(all[kKindCount - 1], 0u);
    for (size_t k = 0; k + 1 < kKindCount; ++k) {
        EXPECT_GT(all[k], 0u) << kKindNames[k] << ": the counter never counts";
        EXPECT_GT(lacking[k], 0u) << kKindNames[k] << ": every map needs it, the test says nothing";
    }
}

/// What rt_onlyRequired can look for all the same, as the statistics call it.
constexpr std::pair<const char*, const char*> kSought[] = {
    {"2", "layers"}, {"3", "near_entities"}, {"4", "several_skies"}};

// The passes from look to primary with and without each search that the map does not require, by turns: other work
// comes and goes.
TEST(OnlyRequired, EachThatIsLeftOutSavesItsTime) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const int rounds = std::getenv("Q3RT_LONG_TESTS") ? 3 : 1;
    size_t leftOut = 0;
    for (const std::string map : kMaps) {
        const auto source = openMapSource({.map = map, .places = {"spawn:0..1"}}, {});
        TradeSession session(*source, findModule("rt"), false);
        measure(session, 1, "1", false, 1);
        const auto stats = nlohmann::json::parse(session.stats());
        for (const auto& [name, ms] : stats.at("passes").items())
            EXPECT_TRUE(
                std::set<std::string>({"look", "shade", "primary", "choose", "sort", "shadows", "composite", "output"})
                    .contains(name))
                << map << " runs " << name;
        std::printf("%-14s", map.c_str());
        for (const auto& [value, name] : kSought) {
            if (stats.at("looks_for").at(name) != 0) continue;
            ++leftOut;
            std::vector<double> required, sought;
            for (int round = 0; round < rounds; ++round) {
                const Work less = measure(session, 2, "1", false, 6), more = measure(session, 2, value, false, 6);
                required.insert(required.end(), less.seeingMs.begin(), less.seeingMs.end());
                sought.insert(sought.end(), more.seeingMs.begin(), more.seeingMs.end());
            }
            const double without = computeQuantile(required, 0.5), with = computeQuantile(sought, 0.5);
            std::printf(" %s saves %.2f of %.2f ms,", name, with - without, with);
        }
        std::printf("\n");
    }
    EXPECT_GT(leftOut, std::size(kMaps)) << "every map looks for everything";
}

TEST(OnlyRequired, WhatIsLeftOutChangesNothing) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    for (const std::string map : {"fan", "q3dm6ish"}) { // neither has blended surfaces nor two skies
        const auto source = openMapSource({.map = map, .places = {"spawn:0..1"}}, {});
        // New sessions begin with the same random numbers.
        std::vector<uint8_t> pictures[2];
        for (const int onlyRequired : {0, 1}) {
            TradeSession fresh(*source, findModule("rt"), false);
            pictures[onlyRequired] = measure(fresh, 2, onlyRequired ? "1" : "0", false, 1).picture;
        }
        EXPECT_EQ(pictures[0], pictures[1]) << map;
    }
}

} // namespace
} // namespace q3rt::test
