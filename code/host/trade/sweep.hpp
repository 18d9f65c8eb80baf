#pragma once
// Measures those points of a sweep that its file lacks, and says beforehand and meanwhile how long that takes.

#include <span>
#include <string>

#include "host/trade/measure.hpp"

namespace q3rt {

/// Adds a line a point to `file`; `command` is what they name as their origin.
void measureMissing(TradeSession& session, TradeMeter& meter, TradeFile& file, std::span<const TradePoint> points,
                    const std::string& command);

} // namespace q3rt
