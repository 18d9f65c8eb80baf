#pragma once
// Which points each figure of the evaluation needs, and the figure made of their results. Pure.

#include <functional>
#include <string>
#include <vector>

#include "host/trade/chart.hpp"
#include "host/trade/result.hpp"

namespace q3rt {

/// Numbers of samples of figures 7.10 and 7.11.
inline constexpr int kSampleCounts[] = {1, 2, 4, 8, 16};

/// A setting of the evaluation.
struct EvaluationSetting {
    std::string name; ///< as the figures call it
    int lights = 1;   ///< 0: all
    bool cull = true, denoiser = false, taa = false;
    int frames = 1; ///< averaged: whole-pixel samples
};
TradePoint makePoint(const EvaluationSetting& setting, const PictureSize& size, const CvarList& fixed);

/// The three bars of figure 7.7, and the fourth that figure 7.9 needs.
std::vector<EvaluationSetting> listTimedSettings();
/// Of figures 7.10 and 7.11: light samples, whole-pixel samples, all lights, denoiser, TAA.
std::vector<EvaluationSetting> listSampledSettings();

/// What was measured of a setting at a size.
using ResultOf = std::function<const TradeResult&(const EvaluationSetting&, const PictureSize&)>;

std::string drawFrameTimes(const std::string& where, const std::vector<PictureSize>& sizes, const ResultOf& resultOf);
std::string drawDenoiserTimes(const std::string& where, const std::vector<PictureSize>& sizes,
                              const ResultOf& resultOf);
std::string drawCulling(const std::string& where, const std::vector<PictureSize>& sizes, const ResultOf& resultOf);
std::string drawSampleTimes(const std::string& where, const PictureSize& size, const ResultOf& resultOf);
std::string drawSampleQuality(const std::string& where, const PictureSize& size, const ResultOf& resultOf);

/// Frame times of a recording under one setting.
struct FrameTrace {
    std::string name;
    int firstFrame = 0;
    std::vector<double> wallMs;
};
std::string drawFrameTrace(const std::string& where, const std::vector<FrameTrace>& traces);

/// Tables of all figures.
std::string formatEvaluation(const std::vector<PictureSize>& sizes, const PictureSize& sampleSize,
                             const ResultOf& resultOf);
std::string formatTraces(const std::vector<FrameTrace>& traces);

} // namespace q3rt
