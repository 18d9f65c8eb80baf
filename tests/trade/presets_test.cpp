// Presets made of a sweep.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "host/trade/presets.hpp"
#include "sample_results.hpp"

namespace q3rt::test {
namespace {

TradeResult makePoint(double ms, double ssim, const char* lights, const char* filters, const char* cull = "1") {
    TradeResult result = makeResult(ms, ssim, lights);
    result.point.cvars["rt_denoiser"] = result.point.cvars["rt_taa"] = filters;
    result.point.cvars["rt_cullLights"] = cull;
    result.point.cvars["rt_backend"] = "compute";
    result.module = "0123";
    return result;
}

std::vector<TradeResult> makeSweep() {
    return {makePoint(1, 0.80, "1", "0"),  makePoint(1.5, 0.972, "1", "1"),   makePoint(3, 0.976, "4", "1"),
            makePoint(4, 0.90, "8", "0"),  makePoint(8.5, 0.98, "8", "1"),    makePoint(27, 0.985, "0", "1"),
            makePoint(30, 0.96, "0", "0"), makePoint(2, 0.972, "1", "1", "0")};
}

TEST(TradePresets, ArePointsOfTheFront) {
    const std::string text = formatPresets(makeSweep(), TradeClock::Wall, "fan", "q3rt trade ...");
    const auto settings = [](const char* lights, const char* filters) {
        return std::string("\"rt_cullLights 1 rt_denoiser ") + filters + " rt_numRandomDL " + lights + " rt_taa " +
               filters + "\")\n";
    };
    // 0.80 in 1 ms is on the front, but noise.
    EXPECT_NE(text.find("PRESET(\"fast\", 1.500, 0.9720, " + settings("1", "1")), std::string::npos) << text;
    EXPECT_NE(text.find("PRESET(\"balanced\", 3.000, 0.9760, " + settings("4", "1")), std::string::npos) << text;
    EXPECT_NE(text.find("PRESET(\"quality\", 8.500, 0.9800, " + settings("8", "1")), std::string::npos) << text;
    EXPECT_NE(text.find("PRESET(\"reference\", 27.000, 0.9850, " + settings("0", "1")), std::string::npos) << text;
    const char* levels = "LEVEL(1.500, 0.9720, \"rt_numRandomDL 1\")\nLEVEL(3.000, 0.9760, \"rt_numRandomDL 4\")\n"
                         "LEVEL(8.500, 0.9800, \"rt_numRandomDL 8\")\n";
    EXPECT_TRUE(text.ends_with(levels)) << text;
    EXPECT_NE(text.find("// fan, back end compute, renderer 0123\n// q3rt trade ...\n"), std::string::npos) << text;
}

TEST(TradePresets, AreOfTheWholeFrontWhereNothingIsNear) {
    const std::vector<TradeResult> noisy = {makePoint(1, 0.5, "1", "0"), makePoint(2, 0.6, "1", "1"),
                                            makePoint(4, 0.7, "2", "1")};
    const std::string text = formatPresets(noisy, TradeClock::Wall, "", "");
    EXPECT_NE(text.find("PRESET(\"fast\", 1.000, 0.5000"), std::string::npos) << text;
    EXPECT_NE(text.find("PRESET(\"reference\", 4.000, 0.7000"), std::string::npos) << text;
}

TEST(TradePresets, WantPointsThatCompare) {
    const std::vector<TradeResult> plain = {makePoint(1, 0.8, "1", "0")};
    EXPECT_THROW(formatPresets(plain, TradeClock::Wall, "", ""), UsageError);
    std::vector<TradeResult> sizes = makeSweep();
    sizes[2].point.size.width *= 2;
    EXPECT_THROW(formatPresets(sizes, TradeClock::Wall, "", ""), UsageError);
    std::vector<TradeResult> means = makeSweep();
    means[2].point.frames = 4;
    EXPECT_THROW(formatPresets(means, TradeClock::Wall, "", ""), UsageError);
}

} // namespace
} // namespace q3rt::test
