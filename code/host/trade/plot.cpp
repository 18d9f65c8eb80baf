#include "host/trade/plot.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "host/trade/front.hpp"
#include "host/trade/svg.hpp"

namespace q3rt {
namespace {

using namespace svg;

// Pixels. The list of points stands right of the plot; a longer list makes a higher picture.
constexpr double kPlotLeft = 84, kPlotRight = 640, kPlotTop = 60, kPlotHeight = 480, kBelowPlot = 70;
constexpr double kListLeft = 672, kListLine = 18, kListTimeEnd = 1000, kListErrorEnd = 1064, kWidth = 1080;
constexpr double kMarkRadius = 4.5;
constexpr const char *kFrontColor = "#c0392b", *kOtherColor = "#34618e";

struct Box {
    double x0, y0, x1, y1;
    bool overlaps(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

class Plot {
  public:
    Plot(std::span<const TradeResult> results, std::span<const std::string> labels, TradeClock clock)
        : m_results(results)
        , m_labels(labels)
        , m_clock(clock)
        , m_costs(costsOf(results, clock))
        , m_front(findFront(m_costs))
        , m_bottom(kPlotTop + kPlotHeight)
        , m_x(timesOf(results, clock), kPlotLeft, kPlotRight)
        , m_y(errorsOf(results), m_bottom, kPlotTop) {}

    std::string draw(const std::string& title) {
        const double listEnd = kPlotTop + kListLine * static_cast<double>(m_results.size() + 3);
        const double height = std::max(m_bottom + kBelowPlot, listEnd);
        std::string svg = begin(kWidth, height);
        svg += drawText(kPlotLeft, 30, title, Align::Start, true);
        return svg + drawAxes() + drawFront() + drawPoints() + drawNumbers() + drawList() + kEnd;
    }

  private:
    static std::vector<double> timesOf(std::span<const TradeResult> results, TradeClock clock) {
        std::vector<double> values;
        for (const TradeResult& r : results)
            values.insert(values.end(), {r.times(clock).q1, r.times(clock).median, r.times(clock).q3});
        return values;
    }
    /// Ends of intervals count only where a logarithm takes them: a bar that reaches 0 ends at the plot's edge.
    static std::vector<double> errorsOf(std::span<const TradeResult> results) {
        std::vector<double> values;
        for (const TradeResult& r : results) {
            values.push_back(1.0 - r.ssim.value);
            if (!r.ssim.interval) continue;
            for (const double end : {1.0 - r.ssim.interval->first, 1.0 - r.ssim.interval->second})
                if (end > 0) values.push_back(end);
        }
        return values;
    }
    bool isOnFront(size_t i) const { return std::find(m_front.begin(), m_front.end(), i) != m_front.end(); }
    double xOf(size_t i) const { return m_x.position(m_costs[i].ms); }
    double yOf(size_t i) const { return m_y.position(m_costs[i].error); }

    std::string drawAxes() const {
        std::string svg;
        for (const double tick : m_x.ticks()) {
            const double x = m_x.position(tick);
            svg += drawLine(x, kPlotTop, x, m_bottom, kGridColor);
            svg += drawText(x, m_bottom + 18, formatText("%g", tick), Align::Middle);
        }
        for (const double tick : m_y.ticks()) {
            const double y = m_y.position(tick);
            svg += drawLine(kPlotLeft, y, kPlotRight, y, kGridColor);
            svg += drawText(kPlotLeft - 8, y + 4, formatText("%g", tick), Align::End);
        }
        svg += drawLine(kPlotLeft, m_bottom, kPlotRight, m_bottom, kInk);
        svg += drawLine(kPlotLeft, kPlotTop, kPlotLeft, m_bottom, kInk);
        const double middle = 0.5 * (kPlotTop + m_bottom);
        const char* time = m_clock == TradeClock::Device ? "frame time on the device in ms (median; bars: quartiles)"
                                                         : "frame time in ms (median; bars: quartiles)";
        svg += drawText(0.5 * (kPlotLeft + kPlotRight), m_bottom + 44, time, Align::Middle);
        return svg + drawUprightText(22, middle, "error: 1 - SSIM (mean over views; bars: 95 % confidence)");
    }
    std::string drawFront() const {
        std::string points;
        for (const size_t i : m_front)
            points += formatText("%s%.1f,%.1f", points.empty() ? "" : " ", xOf(i), yOf(i));
        return formatText("<polyline class=\"front\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\" points=\"",
                          kFrontColor) +
               points + "\"/>\n";
    }
    std::string drawPoints() const {
        std::string svg;
        for (size_t i = 0; i < m_results.size(); ++i) {
            const TradeResult& r = m_results[i];
            const char* color = isOnFront(i) ? kFrontColor : kOtherColor;
            const double x = xOf(i), y = yOf(i);
            const TradeTimes& times = r.times(m_clock);
            svg += drawBar(m_x.position(times.q1), y, m_x.position(times.q3), y, color);
            if (r.ssim.interval) {
                const double best = m_y.position(1.0 - r.ssim.interval->second);
                const double worst = m_y.position(1.0 - r.ssim.interval->first);
                svg += drawBar(x, best, x, worst, color);
            }
            svg += formatText("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%g\" fill=\"%s\"/>\n", x, y, kMarkRadius, color);
        }
        return svg;
    }
    /// Each point's number, in the first place around it, going outwards, that no mark and no other number takes.
    std::string drawNumbers() const {
        std::vector<Box> taken;
        for (size_t i = 0; i < m_results.size(); ++i)
            taken.push_back({xOf(i) - kMarkRadius, yOf(i) - kMarkRadius, xOf(i) + kMarkRadius, yOf(i) + kMarkRadius});
        std::string svg;
        for (size_t i = 0; i < m_results.size(); ++i) {
            const std::string number = formatText("%zu", i + 1);
            const Box place = findPlace(i, kDigitWidth * static_cast<double>(number.size()), taken);
            taken.push_back(place);
            svg += drawText(0.5 * (place.x0 + place.x1), place.y1 - 3, number, Align::Middle, isOnFront(i));
        }
        return svg;
    }
    Box findPlace(size_t i, double width, std::span<const Box> taken) const {
        constexpr double kDirections[8][2] = {{0.7, -0.7}, {-0.7, -0.7}, {0.7, 0.7}, {-0.7, 0.7},
                                              {1, 0},      {-1, 0},      {0, -1},    {0, 1}};
        constexpr int kRings = 6; // beyond that a number is nearer to other points than to its own
        Box first{};
        for (int ring = 0; ring < kRings; ++ring)
            for (const auto& [dx, dy] : kDirections) {
                const double reach = 14.0 + 9.0 * ring;
                const double x = xOf(i) + dx * reach, y = yOf(i) + dy * reach;
                const Box box{x - 0.5 * width, y - 0.5 * kFontSize, x + 0.5 * width, y + 0.5 * kFontSize};
                if (ring == 0 && dx == kDirections[0][0] && dy == kDirections[0][1]) first = box;
                const bool inside = box.x0 > kPlotLeft && box.y1 < m_bottom;
                const bool free =
                    std::none_of(taken.begin(), taken.end(), [&](const Box& other) { return other.overlaps(box); });
                if (inside && free) return box;
            }
        return first;
    }
    std::string drawList() const {
        double y = kPlotTop + 4;
        std::string svg = drawText(kListLeft + 28, y, "bold: on the front");
        svg += drawText(kListTimeEnd, y, "ms", Align::End) + drawText(kListErrorEnd, y, "1 - SSIM", Align::End);
        for (size_t i = 0; i < m_results.size(); ++i) {
            y += kListLine;
            const bool bold = isOnFront(i);
            svg += drawText(kListLeft + 20, y, formatText("%zu", i + 1), Align::End, bold);
            svg += drawText(kListLeft + 28, y, m_labels[i], Align::Start, bold);
            svg += drawText(kListTimeEnd, y, threeDigits(m_costs[i].ms), Align::End, bold);
            svg += drawText(kListErrorEnd, y, threeDigits(m_costs[i].error), Align::End, bold);
        }
        return svg;
    }

    std::span<const TradeResult> m_results;
    std::span<const std::string> m_labels;
    TradeClock m_clock;
    std::vector<TradeCost> m_costs;
    std::vector<size_t> m_front;
    double m_bottom;
    Axis m_x, m_y;
};

} // namespace

std::string drawTradePlot(const std::string& title, std::span<const TradeResult> results,
                          std::span<const std::string> labels, TradeClock clock) {
    return Plot(results, labels, clock).draw(title);
}

} // namespace q3rt
