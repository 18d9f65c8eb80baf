#pragma once
// The evaluation of the thesis "ray-traced Quake III" (figures 7.7 to 7.11 and 7.13) redone on our content: times by
// resolution, the denoiser's share, light culling, light samples against whole-pixel samples, a demo's frame times.
// Results go into a folder: evaluation.jsonl (a killed evaluation goes on where it stopped), an SVG a figure, the
// pictures of figure 7.10, and tables in evaluation.md.

#include <filesystem>
#include <string>
#include <vector>

#include "host/common/session.hpp"
#include "host/trade/measure.hpp"
#include "host/trade/source.hpp"

namespace q3rt {

struct EvaluationOptions {
    std::filesystem::path folder, module;
    MapSourceOptions map;
    std::string recording;          ///< of figure 7.13; empty: left out
    std::vector<PictureSize> sizes; ///< of figures 7.7 to 7.9; 7.13 takes the first
    PictureSize sampleSize;         ///< of figures 7.10 and 7.11
    CvarList fixed;                 ///< for all
    TradePlan plan;                 ///< reference settings included
    std::string command;            ///< that the results name
    GameChoice game;
    bool verbose = false;
};

void runEvaluation(const EvaluationOptions& options);

} // namespace q3rt
