#pragma once
// A sweep as a picture: time against error, error bars, the front as a line, a list of the points. SVG 1.1, no scripts,
// no fonts of its own. Pure.

#include <span>
#include <string>
#include <vector>

#include "host/trade/result.hpp"

namespace q3rt {

/// `title` says what was measured, where. Labels name the points, in their order.
std::string drawTradePlot(const std::string& title, std::span<const TradeResult> results,
                          std::span<const std::string> labels, TradeClock clock);

} // namespace q3rt
