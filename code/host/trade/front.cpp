#include "host/trade/front.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/error.hpp"

namespace q3rt {
namespace {

constexpr size_t kColumnCount = 13, kDeviceColumn = 5, kRaysColumn = 10, kMemoryColumn = 11;
using Row = std::array<std::string, kColumnCount>;

/// 0.912 +-0.004
std::string estimateText(const TradeEstimate& estimate, int digits) {
    if (!std::isfinite(estimate.value)) return "equal";
    std::string text = formatText("%.*f", digits, estimate.value);
    if (estimate.interval)
        text += formatText(" +-%.*f", digits, 0.5 * (estimate.interval->second - estimate.interval->first));
    return text;
}

std::string figureText(const TradeResult& result, const char* name, int digits) {
    const auto found = result.figures.find(name);
    return found == result.figures.end() ? "" : formatText("%.*f", digits, found->second);
}

Row makeRow(const TradeResult& result, size_t number, bool onFront, const std::string& label) {
    const TradeTimes& t = result.wallMs;
    return {formatText("%zu", number),
            onFront ? "*" : "",
            formatText("%.2f", t.median),
            formatText("%.2f-%.2f", t.q1, t.q3),
            formatText("%.2f", t.p99),
            result.gpuMs ? formatText("%.2f", result.gpuMs->median) : "",
            estimateText(result.ssim, 4),
            estimateText(result.flip, 4),
            estimateText(result.psnr, 2),
            estimateText(result.relmse, 4),
            figureText(result, "rays", 0),
            figureText(result, "memory_mib", 1),
            label};
}

std::string describeReferences(std::span<const TradeResult> results) {
    double worst = -1, nearest = INFINITY;
    int frames = 0;
    for (const TradeResult& result : results) {
        worst = std::max(worst, result.referenceError.value_or(-1));
        nearest = std::min(nearest, 1.0 - result.ssim.value);
        frames = std::max(frames, result.referenceFrames);
    }
    if (worst < 0 || !std::isfinite(nearest)) return "";
    return formatText("references: means of up to %d frames, by their own word 1 - SSIM %.5f or less from the truth; "
                      "the nearest setting is %.5f from them\n",
                      frames, worst, nearest);
}

} // namespace

std::vector<size_t> findFront(std::span<const TradeCost> costs) {
    std::vector<size_t> front;
    for (size_t i = 0; i < costs.size(); ++i) {
        const TradeCost& mine = costs[i];
        const bool beaten = std::any_of(costs.begin(), costs.end(), [&](const TradeCost& other) {
            return other.ms <= mine.ms && other.error <= mine.error && (other.ms < mine.ms || other.error < mine.error);
        });
        if (!beaten) front.push_back(i);
    }
    std::stable_sort(front.begin(), front.end(), [&](size_t a, size_t b) { return costs[a].ms < costs[b].ms; });
    return front;
}

std::vector<TradeCost> costsOf(std::span<const TradeResult> results, TradeClock clock) {
    std::vector<TradeCost> costs;
    for (const TradeResult& result : results)
        costs.push_back({result.times(clock).median, 1.0 - result.ssim.value});
    return costs;
}

std::string formatTradeTable(std::span<const TradeResult> results, std::span<const std::string> labels,
                             TradeClock clock) {
    std::vector<bool> onFront(results.size());
    for (const size_t i : findFront(costsOf(results, clock)))
        onFront[i] = true;
    std::vector<Row> rows = {
        {"#", "", "ms", "quartiles", "p99", "device ms", "SSIM", "FLIP", "PSNR dB", "relMSE", "rays", "MiB", ""}};
    for (size_t i = 0; i < results.size(); ++i)
        rows.push_back(makeRow(results[i], i + 1, onFront[i], labels[i]));
    std::array<size_t, kColumnCount> widths{};
    // What no renderer and device of the sweep tells has no column.
    for (const size_t column : {kDeviceColumn, kRaysColumn, kMemoryColumn})
        if (std::all_of(rows.begin() + 1, rows.end(), [&](const Row& row) { return row[column].empty(); }))
            rows[0][column].clear();
    for (const Row& row : rows)
        for (size_t c = 0; c < kColumnCount; ++c)
            widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (size_t c = 0; c + 1 < kColumnCount; ++c)
            if (widths[c] > 0) line += std::string(widths[c] - row[c].size(), ' ') + row[c] + "  ";
        line += row.back();
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    text += formatText("* on the front: no other setting is both faster%s and nearer to the reference\n",
                       clock == TradeClock::Device ? " on the device" : "");
    return text + describeReferences(results);
}

} // namespace q3rt
