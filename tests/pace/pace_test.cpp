// Presets and levels as generated, and what rt_preset and rt_targetMs make of the settings.

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "renderer_rt/pace.hpp"
#include "renderer_rt/presets.hpp"

namespace q3rt::test {
namespace {

TEST(Presets, AreFourInOrderAndNameSettings) {
    ASSERT_EQ(presets().size(), 4u);
    const std::string_view names[] = {"fast", "balanced", "quality", "reference"};
    for (size_t i = 0; i < 4; ++i) {
        const Preset& preset = presets()[i];
        EXPECT_EQ(preset.name, names[i]);
        EXPECT_EQ(findPreset(names[i]), &preset);
        TraceSettings settings;
        EXPECT_TRUE(applySettings(preset.settings, settings)) << preset.name;
        if (i == 0) continue;
        EXPECT_GE(preset.ms, presets()[i - 1].ms);
        EXPECT_GE(preset.ssim, presets()[i - 1].ssim);
    }
    EXPECT_GT(presets()[3].ms, presets()[0].ms);
}

TEST(Presets, AreTheWordsOfTheSetting) {
#define SETTING(name, type, standard, minimum, maximum, flags, unit, meaning) {#name, unit},
    const std::map<std::string_view, std::string_view> units = {
#include "renderer_rt/settings.def.h"
    };
#undef SETTING
    std::string words = "custom";
    for (const Preset& preset : presets())
        words += "|" + std::string(preset.name);
    EXPECT_EQ(units.at("rt_preset"), words);
}

TEST(Presets, LevelsRiseAndLeaveTheFiltersAlone) {
    ASSERT_GE(paceLevels().size(), 2u);
    for (size_t i = 0; i < paceLevels().size(); ++i) {
        TraceSettings settings;
        settings.rt_denoiser = 2;
        EXPECT_TRUE(applySettings(paceLevels()[i].settings, settings));
        EXPECT_EQ(settings.rt_denoiser, 2);
        if (i == 0) continue;
        EXPECT_GT(paceLevels()[i].ms, paceLevels()[i - 1].ms);
        EXPECT_GE(paceLevels()[i].ssim, paceLevels()[i - 1].ssim);
    }
}

TEST(Presets, ApplyReadsNamesAndNumbers) {
    TraceSettings settings;
    EXPECT_TRUE(applySettings("", settings));
    EXPECT_TRUE(applySettings("rt_numRandomDL 8 rt_ambient 0.5 rt_backend compute", settings));
    EXPECT_EQ(settings.rt_numRandomDL, 8);
    EXPECT_EQ(settings.rt_ambient, 0.5f);
    EXPECT_EQ(settings.rt_backend, "compute");
    EXPECT_FALSE(applySettings("rt_noSuchSetting 1", settings));
    EXPECT_FALSE(applySettings("rt_numRandomDL many", settings));
    EXPECT_FALSE(applySettings("rt_numRandomDL", settings));
}

TEST(Pace, CustomChangesNothing) {
    Pace pace;
    TraceSettings settings;
    settings.rt_numRandomDL = 7;
    pace.apply(settings, 1, 0, 0);
    EXPECT_EQ(settings.rt_numRandomDL, 7);
    settings.rt_preset = "no such preset";
    pace.apply(settings, 2, 1, 5);
    EXPECT_EQ(settings.rt_numRandomDL, 7);
}

TEST(Pace, APresetTakesItsSettings) {
    for (const Preset& preset : presets()) {
        Pace pace;
        TraceSettings settings, expected;
        settings.rt_preset = preset.name;
        settings.rt_numRandomDL = expected.rt_numRandomDL = 7;
        settings.rt_exposure = 2;
        pace.apply(settings, 1, 0, 0);
        applySettings(preset.settings, expected);
        EXPECT_EQ(settings.rt_numRandomDL, expected.rt_numRandomDL);
        EXPECT_EQ(settings.rt_denoiser, expected.rt_denoiser);
        EXPECT_EQ(settings.rt_taa, expected.rt_taa);
        EXPECT_EQ(settings.rt_exposure, 2) << "what a preset doesn't name stays";
    }
}

/// Frames whose times come two frames later; each level costs what the table says.
TEST(Pace, ATargetIsKeptByLevels) {
    const size_t middle = paceLevels().size() / 2;
    const double target = 1.1 * paceLevels()[middle].ms;
    Pace pace;
    std::vector<double> times = {0};
    for (uint64_t frame = 1; frame < 2000; ++frame) {
        TraceSettings settings;
        settings.rt_targetMs = static_cast<float>(target);
        const uint64_t finished = frame > 2 ? frame - 2 : 0;
        pace.apply(settings, frame, finished, times[finished]);
        TraceSettings expected;
        applySettings(paceLevels()[pace.level()].settings, expected);
        EXPECT_EQ(settings.rt_numRandomDL, expected.rt_numRandomDL);
        times.push_back(paceLevels()[pace.level()].ms);
    }
    EXPECT_GE(pace.level(), middle);
    EXPECT_LE(times.back(), target);
}

TEST(Pace, MeansOfFramesAreLeftAlone) {
    Pace pace;
    TraceSettings settings;
    settings.rt_targetMs = 1;
    settings.rt_accumulate = 1;
    settings.rt_numRandomDL = 7;
    pace.apply(settings, 1, 0, 0);
    EXPECT_EQ(settings.rt_numRandomDL, 7);
}

} // namespace
} // namespace q3rt::test
