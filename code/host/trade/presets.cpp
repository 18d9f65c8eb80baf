#include "host/trade/presets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "host/trade/front.hpp"

namespace q3rt {
namespace {

constexpr std::array<const char*, 4> kPresetNames = {"fast", "balanced", "quality", "reference"};
/// Settings that may change from frame to frame: no pipeline is made for them. Lights and depth leave histories alone.
constexpr std::array<const char*, 3> kLevelCvars = {"rt_numRandomDL", "rt_reflectionDepth", "rt_scale"};
/// Of the machine or of a run, not of the picture.
constexpr std::array<const char*, 2> kNoChoice = {"rt_backend", "rt_seed"};

/// SSIM below which no picture is offered: its noise is what one sees of it first (0.91 on the front of an H200: two
/// lights without denoiser at half the size, in 0.37 ms; 0.98 with denoiser in 0.43 ms).
constexpr double kLeastLikeness = 0.97;

template <size_t N>
bool isOneOf(const std::array<const char*, N>& names, const std::string& name) {
    return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

std::string valueOf(const TradePoint& point, const char* name) {
    const auto found = point.cvars.find(name);
    return found == point.cvars.end() ? "" : found->second;
}

std::string settingsText(const TradePoint& point, bool levelsOnly) {
    std::string text;
    for (const auto& [name, value] : point.cvars)
        if (name.starts_with("rt_") && !isOneOf(kNoChoice, name) && (!levelsOnly || isOneOf(kLevelCvars, name)))
            text += (text.empty() ? "" : " ") + name + " " + value;
    return text;
}

std::string formatLine(const char* macro, const std::string& name, const TradeResult& result, TradeClock clock,
                       bool levelsOnly) {
    return formatText("%s(%s%.3f, %.4f, \"%s\")\n", macro, name.c_str(), result.times(clock).median, result.ssim.value,
                      settingsText(result.point, levelsOnly).c_str());
}

/// The most accurate of a front (by rising time) that takes at most `ms`.
size_t findWithin(std::span<const TradeResult> results, std::span<const size_t> front, TradeClock clock, double ms) {
    size_t best = front[0];
    for (const size_t i : front)
        if (results[i].times(clock).median <= ms) best = i;
    return best;
}

std::vector<TradeResult> findLevels(std::span<const TradeResult> results, TradeClock clock) {
    int bestCulling = 0;
    for (const TradeResult& result : results)
        bestCulling = std::max(bestCulling, std::atoi(valueOf(result.point, "rt_cullLights").c_str()));
    std::vector<TradeResult> candidates;
    for (const TradeResult& result : results) {
        const bool filtered = valueOf(result.point, "rt_denoiser") == "1" && valueOf(result.point, "rt_taa") == "1";
        // All lights cost as much as there are in sight: no time to rely on.
        const bool counted = valueOf(result.point, "rt_numRandomDL") != "0";
        const bool culled = std::atoi(valueOf(result.point, "rt_cullLights").c_str()) == bestCulling;
        if (filtered && counted && culled) candidates.push_back(result);
    }
    std::vector<TradeResult> levels;
    if (candidates.empty()) return levels;
    for (const size_t i : findFront(costsOf(candidates, clock)))
        levels.push_back(candidates[i]);
    return levels;
}

} // namespace

std::string formatPresets(std::span<const TradeResult> results, TradeClock clock, const std::string& title,
                          const std::string& command) {
    for (const TradeResult& result : results)
        if (result.point.size.width != results[0].point.size.width ||
            result.point.size.height != results[0].point.size.height || result.point.frames != 1)
            throw UsageError("--presets: the points differ in size or are means of frames; sweep settings alone");
    const std::vector<TradeResult> levels = findLevels(results, clock);
    if (levels.empty())
        throw UsageError("--presets: no point has rt_denoiser 1 and rt_taa 1; add --axis rt_denoiser=0,1 and "
                         "--axis rt_taa=0,1");
    std::vector<size_t> front = findFront(costsOf(results, clock));
    if (results[front.back()].ssim.value >= kLeastLikeness)
        std::erase_if(front, [&](size_t i) { return results[i].ssim.value < kLeastLikeness; });
    // Times within the fastest point's own spread are as fast.
    const double fastest = results[front.front()].times(clock).q3, slowest = results[front.back()].times(clock).median;
    std::string text =
        "// Points of a measured front: PRESET(name, ms, SSIM, settings), and the levels that rt_targetMs "
        "moves along,\n// LEVEL(ms, SSIM, settings), each dearer and better than the one before. Made by "
        "q3rt trade --presets.\n";
    text += std::string("// ") + (clock == TradeClock::Device ? "time on the device; " : "") + title + ", back end " +
            results[0].backend + ", renderer " + results[0].module + "\n";
    text += "// " + command + "\n";
    for (size_t i = 0; i < kPresetNames.size(); ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(kPresetNames.size() - 1);
        // The last one is the slowest itself, whatever rounding or a wide spread makes of it.
        const double ms = i + 1 == kPresetNames.size() ? slowest : fastest * std::pow(slowest / fastest, share);
        const TradeResult& result = results[findWithin(results, front, clock, ms)];
        text += formatLine("PRESET", formatText("\"%s\", ", kPresetNames[i]), result, clock, false);
    }
    for (const TradeResult& level : levels)
        text += formatLine("LEVEL", "", level, clock, true);
    return text;
}

} // namespace q3rt
