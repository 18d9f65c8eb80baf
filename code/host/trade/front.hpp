#pragma once
// Which points of a sweep are worth choosing, and the table that says so. Pure.

#include <span>
#include <string>
#include <vector>

#include "host/trade/result.hpp"

namespace q3rt {

/// A point's cost and error; of both, less is better.
struct TradeCost {
    double ms = 0;    ///< median
    double error = 0; ///< 1 - SSIM
};
/// Indices of the points that no other one beats (in one quantity, without losing in the other), by rising ms. Equal
/// points stay together.
std::vector<size_t> findFront(std::span<const TradeCost> costs);
std::vector<TradeCost> costsOf(std::span<const TradeResult> results, TradeClock clock);

/// Aligned columns, a row a point in the order given and numbered from 1; * marks the front. Below it, how far the
/// references themselves are from the truth.
std::string formatTradeTable(std::span<const TradeResult> results, std::span<const std::string> labels,
                             TradeClock clock);

} // namespace q3rt
