#include "base/measured_rounds.hpp"

#include <algorithm>
#include <limits>

namespace q3rt {

namespace {

/// Ways whose least costs differ by less than this factor count as equally fast.
constexpr double kEqualFactor = 1.15;

size_t indexOfLeast(const std::vector<double>& ms) {
    return static_cast<size_t>(std::min_element(ms.begin(), ms.end()) - ms.begin());
}

} // namespace

RoundsResult measureInRounds(std::span<const std::function<RunTime()>> ways, double budgetMs) {
    const std::vector<double> none(ways.size(), std::numeric_limits<double>::infinity());
    std::vector<double> half[2] = {none, none};
    RoundsResult result;
    double spentMs = 0, shortestRoundMs = std::numeric_limits<double>::infinity();
    do {
        std::vector<double>& own = half[result.roundCount % 2];
        double roundMs = 0;
        for (size_t i = 0; i < ways.size(); ++i) {
            const RunTime time = ways[i]();
            roundMs += time.wallMs;
            own[i] = std::min(own[i], time.costMs);
        }
        spentMs += roundMs;
        shortestRoundMs = std::min(shortestRoundMs, roundMs);
        ++result.roundCount;
    } while (spentMs + shortestRoundMs <= budgetMs);
    for (size_t i = 0; i < ways.size(); ++i)
        result.leastMs.push_back(std::min(half[0][i], half[1][i]));
    result.fastest = indexOfLeast(result.leastMs);
    result.repeatable = ways.size() == 1 || (result.roundCount > 1 && std::all_of(half, half + 2, [&](const auto& ms) {
                                                 return ms[result.fastest] <= kEqualFactor * ms[indexOfLeast(ms)];
                                             }));
    return result;
}

} // namespace q3rt
