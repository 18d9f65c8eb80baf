#include "scene/alias_table.hpp"

#include <algorithm>
#include <numeric>

namespace q3rt {

std::vector<AliasColumn> buildAliasTable(std::span<const double> weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<AliasColumn> columns(weights.size());
    std::vector<double> left(weights.size()); // of a column's own, in columns
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < weights.size(); ++i) {
        columns[i].other = i;
        left[i] = weights[i] / sum * static_cast<double>(weights.size());
        (left[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        columns[poor] = {static_cast<float>(left[poor]), rich};
        left[rich] -= 1 - left[poor];
        if (left[rich] >= 1) continue;
        large.pop_back();
        small.push_back(rich);
    }
    // What is left differs from a full column by rounding. Something of no weight is never drawn all the same.
    const auto heaviest = static_cast<uint32_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
    for (const uint32_t i : small)
        if (weights[i] == 0) columns[i] = {0.0f, heaviest};
    return columns;
}

std::vector<double> aliasProbabilities(std::span<const AliasColumn> columns) {
    std::vector<double> probability(columns.size(), 0.0);
    for (size_t i = 0; i < columns.size(); ++i) {
        const double own = static_cast<double>(columns[i].chance);
        probability[i] += own / static_cast<double>(columns.size());
        probability[columns[i].other] += (1 - own) / static_cast<double>(columns.size());
    }
    return probability;
}

} // namespace q3rt
