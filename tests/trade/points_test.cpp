// Which points a sweep has, how shards share them, what they are called.

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "host/trade/points.hpp"
#include "host/trade/source.hpp"

namespace q3rt::test {
namespace {

constexpr PictureSize kSize{160, 120};

bool declaresAll(const std::string&) { return true; }

/// No point twice.
void expectDifferent(const std::vector<TradePoint>& points) {
    for (size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(std::count(points.begin(), points.end(), points[i]), 1) << describePoint(points[i], points);
}

} // namespace

TEST(TradePoints, TheStandardSweepHas24AndTheSmokeSweep10DifferentOnes) {
    const auto standard = listStandardPoints(kStandardPointCount, kSize, {}, declaresAll);
    EXPECT_EQ(standard.size(), 24u);
    expectDifferent(standard);
    const auto smoke = listStandardPoints(kSmokePointCount, kSize, {}, declaresAll);
    EXPECT_EQ(smoke.size(), 10u);
    EXPECT_TRUE(std::equal(smoke.begin(), smoke.end(), standard.begin()));
    for (const char* lights : {"0", "1", "2", "4", "8", "16"})
        EXPECT_TRUE(std::any_of(standard.begin(), standard.end(), [&](const TradePoint& point) {
            return point.cvars.at("rt_numRandomDL") == lights;
        })) << lights;
}

TEST(TradePoints, WhatTheRendererLacksOrIsFixedIsNotSwept) {
    const auto isDeclared = [](const std::string& name) { return name != "rt_taa" && name != "rt_denoiser"; };
    const auto points = listStandardPoints(kStandardPointCount, kSize, {{"RT_cullLights", "0"}}, isDeclared);
    EXPECT_EQ(points.size(), 6u); // lights per pixel are left
    expectDifferent(points);
    for (const TradePoint& point : points) {
        EXPECT_FALSE(point.cvars.contains("rt_taa"));
        EXPECT_FALSE(point.cvars.contains("rt_cullLights"));
        EXPECT_EQ(point.cvars.at("RT_cullLights"), "0");
    }
}

/// TAA smooths edges only if rays go to changing places of a pixel.
TEST(TradePoints, JitterFollowsTaa) {
    const auto points = listStandardPoints(kStandardPointCount, kSize, {}, declaresAll);
    for (const TradePoint& point : points) {
        EXPECT_EQ(point.cvars.at("rt_antialiasing"), point.cvars.at("rt_taa"));
        EXPECT_EQ(describePoint(point, points).find("jitter"), std::string::npos);
    }
    const std::vector<TradeAxis> apart = {parseAxis("rt_taa=0,1"), parseAxis("rt_antialiasing=0,1")};
    const auto crossed = crossAxes(apart, kSize, {});
    EXPECT_EQ(describePoint(crossed[3], crossed), "TAA, jitter");
}

TEST(TradePoints, AxesCrossEachOtherAndTheSize) {
    const std::vector<TradeAxis> axes = {parseAxis("rt_numRandomDL=1,4,0"), parseAxis("size=64x48,320x240")};
    const auto points = crossAxes(axes, kSize, {{"r_gamma", "1"}});
    EXPECT_EQ(points.size(), 6u);
    expectDifferent(points);
    EXPECT_EQ(points[1].size.width, 320);
    EXPECT_EQ(points[5].cvars.at("rt_numRandomDL"), "0");
    EXPECT_EQ(points[5].cvars.at("r_gamma"), "1");
    EXPECT_EQ(describePoint(points[5], points), "all lights, 320x240");
    EXPECT_EQ(describePoint(points[0], points), "1 light, 64x48");
}

TEST(TradePoints, BadAxesAreRefused) {
    for (const char* text : {"", "a", "a=", "=1", "a=1,", "a=,1", "a=1,,2"})
        EXPECT_THROW(parseAxis(text), UsageError) << text;
    const std::vector<TradeAxis> twice = {parseAxis("a=1"), parseAxis("A=2")};
    EXPECT_THROW(crossAxes(twice, kSize, {}), UsageError);
    const std::vector<TradeAxis> fixed = {parseAxis("a=1")};
    EXPECT_THROW(crossAxes(fixed, kSize, {{"a", "1"}}), UsageError);
    for (const char* text : {"size=big", "size=8x8,0x1", "frames=0", "frames=few"})
        EXPECT_THROW(parseAxis(text), UsageError) << text;
}

// 24 points in 1 to 30 parts.
TEST(TradePoints, ShardsCoverEveryPointOnce) {
    const auto points = listStandardPoints(kStandardPointCount, kSize, {}, declaresAll);
    for (size_t count = 1; count <= 30; ++count) {
        std::vector<TradePoint> gathered;
        size_t least = points.size(), most = 0;
        for (size_t index = 0; index < count; ++index) {
            const auto part = takeShard(points, {index, count});
            gathered.insert(gathered.end(), part.begin(), part.end());
            least = std::min(least, part.size());
            most = std::max(most, part.size());
        }
        EXPECT_EQ(gathered.size(), points.size());
        for (const TradePoint& point : points)
            EXPECT_EQ(std::count(gathered.begin(), gathered.end(), point), 1);
        EXPECT_LE(most - least, 1u);
    }
}

TEST(TradePoints, ShardsAreNumberedFrom0) {
    EXPECT_EQ(parseShard("3/4").index, 3u);
    EXPECT_EQ(parseShard("3/4").count, 4u);
    for (const char* text : {"", "1", "4/4", "0/0", "-1/4", "1/4x", "a/b"})
        EXPECT_THROW(parseShard(text), UsageError) << text;
}

TEST(TradePoints, PlacesExpand) {
    EXPECT_EQ(expandPlace("spawn:2..4"), (std::vector<std::string>{"spawn:2", "spawn:3", "spawn:4"}));
    EXPECT_EQ(expandPlace("spawn:2"), std::vector<std::string>{"spawn:2"});
    EXPECT_EQ(expandPlace("1 2 3 0 90"), std::vector<std::string>{"1 2 3 0 90"});
    EXPECT_THROW(expandPlace("spawn:4..2"), UsageError);
}

} // namespace q3rt::test
