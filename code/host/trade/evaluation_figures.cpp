#include "host/trade/evaluation_figures.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "metrics/statistics.hpp"

namespace q3rt {
namespace {

constexpr double kSixtyFramesMs = 1000.0 / 60;

const EvaluationSetting kAllLights{"all lights", 0}, kOneLight{"1 light"},
    kOneLightDenoised{.name = "1 light, denoiser", .denoiser = true},
    kNotCulled{.name = "all lights, not culled", .lights = 0, .cull = false},
    kDenoisedTaa{.name = "1 light, denoiser, TAA", .denoiser = true, .taa = true},
    kAllLightsTaa{.name = "all lights, TAA", .lights = 0, .taa = true};

EvaluationSetting lightSamples(int count) {
    return {.name = formatText("%d light%s", count, count == 1 ? "" : "s"), .lights = count};
}

EvaluationSetting wholeSamples(int count) {
    return {.name = formatText("%d whole-pixel sample%s", count, count == 1 ? "" : "s"), .frames = count};
}

std::string sizeText(const PictureSize& size) { return formatText("%dx%d", size.width, size.height); }

ChartValue toValue(const TradeTimes& times) { return {times.median, times.q1, times.q3}; }

ChartValue toValue(const TradeEstimate& estimate) {
    if (!estimate.interval) return {estimate.value, estimate.value, estimate.value};
    return {estimate.value, estimate.interval->first, estimate.interval->second};
}

TradeTimes denoiserOf(const TradeResult& result) {
    const auto found = result.groups.find("denoise");
    return found == result.groups.end() ? TradeTimes{} : found->second;
}

std::vector<std::string> namesOf(const std::vector<PictureSize>& sizes) {
    std::vector<std::string> names;
    for (const PictureSize& size : sizes)
        names.push_back(sizeText(size));
    return names;
}

BarChart makeBars(const std::string& title, const std::string& where, const std::string& label,
                  const std::vector<PictureSize>& sizes, const std::vector<EvaluationSetting>& settings,
                  const std::function<TradeTimes(const EvaluationSetting&, const PictureSize&)>& timesOf) {
    BarChart chart{title, where, label, namesOf(sizes), {}, std::nullopt, ""};
    for (const EvaluationSetting& setting : settings) {
        chart.series.push_back({setting.name, {}});
        for (const PictureSize& size : sizes)
            chart.series.back().values.push_back(toValue(timesOf(setting, size)));
    }
    return chart;
}

} // namespace

TradePoint makePoint(const EvaluationSetting& setting, const PictureSize& size, const CvarList& fixed) {
    TradePoint point{size, {fixed.begin(), fixed.end()}, setting.frames};
    for (const auto& [name, value] : {std::pair<const char*, int>{"rt_numRandomDL", setting.lights},
                                      {"rt_cullLights", setting.cull ? kCulled : 0},
                                      {"rt_denoiser", setting.denoiser},
                                      {"rt_taa", setting.taa}})
        point.cvars[name] = std::to_string(value);
    // Averaged frames want places within a pixel: what whole-pixel samples are for, and what TAA averages.
    point.cvars["rt_antialiasing"] = setting.frames > 1 || setting.taa ? "1" : "0";
    return point;
}

std::vector<EvaluationSetting> listTimedSettings() { return {kAllLights, kOneLight, kOneLightDenoised, kNotCulled}; }

std::vector<EvaluationSetting> listSampledSettings() {
    std::vector<EvaluationSetting> settings;
    for (const int count : kSampleCounts)
        settings.push_back(lightSamples(count));
    for (const int count : kSampleCounts)
        if (count > 1) settings.push_back(wholeSamples(count));
    settings.insert(settings.end(), {kAllLights, kAllLightsTaa, kOneLightDenoised, kDenoisedTaa});
    return settings;
}

std::string drawFrameTimes(const std::string& where, const std::vector<PictureSize>& sizes, const ResultOf& resultOf) {
    BarChart chart =
        makeBars("Frame time by resolution", where, "frame time in ms (median; bars: quartiles)", sizes,
                 {kAllLights, kOneLight, kOneLightDenoised},
                 [&](const EvaluationSetting& s, const PictureSize& size) { return resultOf(s, size).wallMs; });
    chart.limit = kSixtyFramesMs;
    chart.limitName = "60 frames a second";
    return drawBarChart(chart);
}

std::string drawDenoiserTimes(const std::string& where, const std::vector<PictureSize>& sizes,
                              const ResultOf& resultOf) {
    return drawBarChart(
        makeBars("The denoiser's time by resolution", where, "device time in ms (median; bars: quartiles)", sizes,
                 {kOneLightDenoised},
                 [&](const EvaluationSetting& s, const PictureSize& size) { return denoiserOf(resultOf(s, size)); }));
}

std::string drawCulling(const std::string& where, const std::vector<PictureSize>& sizes, const ResultOf& resultOf) {
    return drawBarChart(
        makeBars("All lights, and all that may shine on the point", where, "frame time in ms (median; bars: quartiles)",
                 sizes, {kNotCulled, kAllLights},
                 [&](const EvaluationSetting& s, const PictureSize& size) { return resultOf(s, size).wallMs; }));
}

namespace {

/// A line over the numbers of samples: x is the position in kSampleCounts.
template <typename Value>
LineChart::Series sampleLine(const std::string& name, EvaluationSetting (*settingOf)(int), const Value& valueOf) {
    LineChart::Series series{name, {}};
    double x = 0;
    for (const int count : kSampleCounts)
        series.points.push_back({x++, valueOf(count == 1 ? kOneLight : settingOf(count))});
    return series;
}

template <typename Value>
LineChart makeSampleChart(const std::string& title, const std::string& where, const std::string& yLabel,
                          const Value& valueOf) {
    LineChart chart{title, where, "samples", yLabel, {}};
    for (const int count : kSampleCounts)
        chart.xNames.push_back(std::to_string(count));
    chart.series.push_back(sampleLine("light samples", lightSamples, valueOf));
    chart.series.push_back(sampleLine("whole-pixel samples", wholeSamples, valueOf));
    for (const EvaluationSetting& setting : {kAllLights, kOneLightDenoised, kDenoisedTaa, kAllLightsTaa})
        chart.series.push_back({setting.name, {{0, valueOf(setting)}}});
    return chart;
}

} // namespace

std::string drawSampleTimes(const std::string& where, const PictureSize& size, const ResultOf& resultOf) {
    const LineChart chart =
        makeSampleChart("Time by samples", where + ", " + sizeText(size), "ms a picture (median; bars: quartiles)",
                        [&](const EvaluationSetting& setting) { return toValue(resultOf(setting, size).wallMs); });
    return drawLineChart(chart);
}

std::string drawSampleQuality(const std::string& where, const PictureSize& size, const ResultOf& resultOf) {
    LineChart chart = makeSampleChart(
        "Likeness to the reference by samples", where + ", " + sizeText(size), "SSIM (bars: 95 % confidence)",
        [&](const EvaluationSetting& setting) { return toValue(resultOf(setting, size).ssim); });
    chart.fromZero = false;
    return drawLineChart(chart);
}

std::string drawFrameTrace(const std::string& where, const std::vector<FrameTrace>& traces) {
    LineChart chart{"Frame times", where, "world frame", "frame time in ms", {}};
    for (const FrameTrace& trace : traces) {
        LineChart::Series series{trace.name, {}, false};
        for (size_t i = 0; i < trace.wallMs.size(); ++i)
            series.points.push_back({static_cast<double>(trace.firstFrame) + static_cast<double>(i),
                                     {trace.wallMs[i], trace.wallMs[i], trace.wallMs[i]}});
        chart.series.push_back(std::move(series));
    }
    return drawLineChart(chart);
}

std::string formatEvaluation(const std::vector<PictureSize>& sizes, const PictureSize& sampleSize,
                             const ResultOf& resultOf) {
    const auto cell = [](const TradeTimes& t) { return formatText(" %.2f (%.2f - %.2f) |", t.median, t.q1, t.q3); };
    std::string text = "Times in ms: median (quartiles).\n\n| size |";
    std::vector<EvaluationSetting> settings = listTimedSettings();
    for (const EvaluationSetting& setting : settings)
        text += " " + setting.name + " |";
    text += " denoiser alone |\n|---|" + std::string(settings.size() * 4, '-');
    for (size_t i = settings.size(); i > 0; --i)
        text[text.size() - 4 * i + 3] = '|';
    text += "---|\n";
    for (const PictureSize& size : sizes) {
        text += "| " + sizeText(size) + " |";
        for (const EvaluationSetting& setting : settings)
            text += cell(resultOf(setting, size).wallMs);
        text += cell(denoiserOf(resultOf(kOneLightDenoised, size))) + "\n";
    }
    text += "\n| " + sizeText(sampleSize) + " | ms a picture | SSIM | FLIP |\n|---|---|---|---|\n";
    for (const EvaluationSetting& setting : listSampledSettings()) {
        const TradeResult& r = resultOf(setting, sampleSize);
        text += "| " + setting.name + " |" + cell(r.wallMs);
        text += formatText(" %.4f | %.4f |\n", r.ssim.value, r.flip.value);
    }
    return text;
}

std::string formatTraces(const std::vector<FrameTrace>& traces) {
    if (traces.empty()) return "";
    std::string text = "\n| frames of the recording | median | 95 % | 99 % | worst |\n|---|---|---|---|---|\n";
    for (const FrameTrace& trace : traces)
        text +=
            formatText("| %s | %.2f | %.2f | %.2f | %.2f |\n", trace.name.c_str(), computeQuantile(trace.wallMs, 0.5),
                       computeQuantile(trace.wallMs, 0.95), computeQuantile(trace.wallMs, 0.99),
                       *std::max_element(trace.wallMs.begin(), trace.wallMs.end()));
    return text;
}

} // namespace q3rt
