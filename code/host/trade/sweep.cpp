#include "host/trade/sweep.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "base/error.hpp"
#include "host/common/progress.hpp"

namespace q3rt {
namespace {

bool sameSize(const PictureSize& a, const PictureSize& b) { return a.width == b.width && a.height == b.height; }

/// Points grouped by what a new start costs: first those that need the same one as the references.
std::vector<TradePoint> orderByStart(std::span<const TradePoint> points, const TradeSession& session) {
    const auto startOf = [&](const TradePoint& point) {
        std::vector<std::string> start = {formatText("%08d %08d", point.size.width, point.size.height)};
        for (const auto& [name, value] : point.cvars)
            if (session.isLatched(name)) start.push_back(name + " " + value);
        return start;
    };
    std::vector<TradePoint> ordered(points.begin(), points.end());
    std::stable_sort(ordered.begin(), ordered.end(),
                     [&](const TradePoint& a, const TradePoint& b) { return startOf(a) < startOf(b); });
    return ordered;
}

/// Seconds of each point; says what they come to.
std::vector<double> foretell(TradeMeter& meter, std::span<const TradePoint> points) {
    std::vector<double> seconds;
    double references = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        if (i == 0 || !sameSize(points[i].size, points[i - 1].size))
            references += meter.foretellReferences(points[i].size);
        seconds.push_back(meter.foretell(points[i]));
    }
    std::fprintf(stderr, "%zu point%s: about %.0f s; references, where they are not known: at most %.0f s\n",
                 points.size(), points.size() == 1 ? "" : "s", std::accumulate(seconds.begin(), seconds.end(), 0.0),
                 references);
    return seconds;
}

} // namespace

void measureMissing(TradeSession& session, TradeMeter& meter, TradeFile& file, std::span<const TradePoint> points,
                    const std::string& command) {
    std::vector<TradePoint> missing;
    for (const TradePoint& point : orderByStart(points, session))
        if (!file.find(meter.keyOf(point), session.device())) missing.push_back(point);
    if (missing.size() < points.size())
        std::fprintf(stderr, "%zu of %zu points are measured already\n", points.size() - missing.size(), points.size());
    if (missing.empty()) return;
    const std::vector<double> seconds = foretell(meter, missing);
    const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
    meter.prepareReferences(missing[0].size);
    Progress progress("point", missing.size());
    double before = 0;
    for (size_t i = 0; i < missing.size(); ++i) {
        meter.prepareReferences(missing[i].size);
        const std::string at = formatText("point %zu of %zu", i + 1, missing.size());
        TradeResult result =
            meter.measure(missing[i], [&](double share) { progress.advance(at, (before + share * seconds[i]) / all); });
        before += seconds[i];
        result.command = command;
        file.append(result);
    }
}

} // namespace q3rt
