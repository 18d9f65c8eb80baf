#pragma once
// Made-up results for the pure parts of a sweep.

#include "host/trade/result.hpp"

namespace q3rt::test {

inline TradeResult makeResult(double ms, double ssim, const std::string& lights = "1") {
    TradeResult result;
    result.key = "key of " + lights;
    result.point = {{160, 120}, {{"rt_numRandomDL", lights}}};
    result.wallMs = {ms, 0.9 * ms, 1.2 * ms, 2 * ms};
    result.gpuMs = TradeTimes{0.5 * ms, 0.4 * ms, 0.6 * ms, ms};
    result.ssim = {ssim, std::pair{ssim - 0.01, ssim + 0.01}};
    result.flip = {0.125, std::nullopt};
    result.psnr = {INFINITY, std::nullopt};
    result.relmse = {0.25, std::pair{0.2, 0.3}};
    result.passes = {{"direct", 1.5}};
    result.figures = {{"rays", 1e6}};
    result.views = {{"spawn:0", ms, {ssim, 0.125, INFINITY, 0.25}, 512, 0.001}};
    result.referenceFrames = 512;
    result.referenceError = 0.001;
    result.frameCount = 20;
    result.device = "a \"device\" <of> tests & more";
    result.backend = "compute";
    return result;
}

} // namespace q3rt::test
