#include "host/trade/chart.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "host/trade/svg.hpp"

namespace q3rt {
namespace {

using namespace svg;

// Pixels.
constexpr double kLeft = 84, kTop = 110, kBottom = 470, kRight = 760, kWidth = 800, kHeight = 540, kLegendTop = 66;
constexpr double kLegendLine = 18, kLegendBox = 11, kMarkRadius = 3.5, kLimitWidth = 2;
constexpr double kGroupShare = 0.75; ///< of a group's width that its bars take
/// Told apart in print and by the colour-blind (Okabe and Ito: Color Universal Design, 2008).
constexpr std::array<const char*, 6> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

const char* colorOf(size_t series) { return kColors[series % kColors.size()]; }

std::string drawFrame(const std::string& title, const std::string& where, const std::string& yLabel, const Axis& y) {
    std::string svg = begin(kWidth, kHeight) + drawText(kLeft, 26, title, Align::Start, true);
    svg += drawText(kLeft, 45, where);
    for (const double tick : y.ticks()) {
        svg += drawLine(kLeft, y.position(tick), kRight, y.position(tick), kGridColor);
        svg += drawText(kLeft - 8, y.position(tick) + 4, formatText("%g", tick), Align::End);
    }
    return svg + drawUprightText(22, 0.5 * (kTop + kBottom), yLabel);
}

/// `limit` names the line across the plot; empty: there is none.
std::string drawLegend(const std::vector<std::string>& seriesNames, const std::string& limit = "") {
    std::string svg;
    double x = kLeft, y = kLegendTop;
    std::vector<std::string> names = seriesNames;
    if (!limit.empty()) names.push_back(limit);
    for (size_t i = 0; i < names.size(); ++i) {
        const double width = kLegendBox + 24 + 0.9 * kDigitWidth * static_cast<double>(names[i].size());
        if (x > kLeft && x + width > kRight) x = kLeft, y += kLegendLine;
        const double top = y - kLegendBox + 1, middle = top + 0.5 * kLegendBox;
        if (i == seriesNames.size())
            svg += drawLine(x, middle, x + kLegendBox, middle, kInk, kLimitWidth);
        else
            svg += formatText("<rect x=\"%.1f\" y=\"%.1f\" width=\"%g\" height=\"%g\" fill=\"%s\"/>\n", x, top,
                              kLegendBox, kLegendBox, colorOf(i));
        svg += drawText(x + kLegendBox + 5, y, names[i]);
        x += width;
    }
    return svg;
}

template <typename Series>
std::vector<std::string> namesOf(const std::vector<Series>& series) {
    std::vector<std::string> names;
    for (const Series& s : series)
        names.push_back(s.name);
    return names;
}

std::string drawXAxis() {
    return drawLine(kLeft, kBottom, kRight, kBottom, kInk) + drawLine(kLeft, kTop, kLeft, kBottom, kInk);
}

} // namespace

std::string drawBarChart(const BarChart& chart) {
    std::vector<double> values = {0};
    for (const BarChart::Series& series : chart.series)
        for (const ChartValue& v : series.values)
            values.insert(values.end(), {v.value, v.high});
    if (chart.limit) values.push_back(*chart.limit);
    const Axis y(values, kBottom, kTop, Axis::Scale::FromZero);
    std::string svg =
        drawFrame(chart.title, chart.where, chart.valueLabel, y) + drawLegend(namesOf(chart.series), chart.limitName);
    const double groupWidth = (kRight - kLeft) / static_cast<double>(chart.groups.size());
    const double barWidth = kGroupShare * groupWidth / static_cast<double>(chart.series.size());
    for (size_t g = 0; g < chart.groups.size(); ++g) {
        const double start = kLeft + groupWidth * (static_cast<double>(g) + 0.5 * (1 - kGroupShare));
        for (size_t s = 0; s < chart.series.size(); ++s) {
            const ChartValue& v = chart.series[s].values[g];
            const double x = start + barWidth * static_cast<double>(s), top = y.position(v.value);
            svg += formatText("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", x, top,
                              0.92 * barWidth, kBottom - top, colorOf(s));
            const double middle = x + 0.46 * barWidth;
            svg += drawBar(middle, y.position(v.low), middle, y.position(v.high), kInk);
            svg += drawText(middle, y.position(v.high) - 7, threeDigits(v.value), Align::Middle);
        }
        svg +=
            drawText(kLeft + groupWidth * (static_cast<double>(g) + 0.5), kBottom + 20, chart.groups[g], Align::Middle);
    }
    if (chart.limit)
        svg += drawLine(kLeft, y.position(*chart.limit), kRight, y.position(*chart.limit), kInk, kLimitWidth);
    return svg + drawXAxis() + kEnd;
}

namespace {

std::string drawSeries(const LineChart::Series& series, const char* color, const Axis& x, const Axis& y) {
    std::string svg, points;
    const auto append = [&points](double px, double py) {
        points += formatText("%s%.1f,%.1f", points.empty() ? "" : " ", px, py);
    };
    for (const LineChart::Point& point : series.points)
        append(x.position(point.x), y.position(point.y.value));
    if (series.points.size() == 1) {
        points.clear();
        append(kLeft, y.position(series.points[0].y.value));
        append(kRight, y.position(series.points[0].y.value));
    }
    svg += formatText("<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%g\" points=\"", color,
                      series.marks ? 2.0 : 1.0) +
           points + "\"/>\n";
    for (const LineChart::Point& point : series.points) {
        if (!series.marks) break;
        const double px = x.position(point.x);
        svg += drawBar(px, y.position(point.y.low), px, y.position(point.y.high), color);
        svg += formatText("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%g\" fill=\"%s\"/>\n", px, y.position(point.y.value),
                          kMarkRadius, color);
    }
    return svg;
}

} // namespace

std::string drawLineChart(const LineChart& chart) {
    std::vector<double> xs, ys;
    for (const LineChart::Series& series : chart.series)
        for (const LineChart::Point& point : series.points) {
            xs.push_back(point.x);
            ys.insert(ys.end(), {point.y.value, point.y.low, point.y.high});
        }
    const Axis x(xs, kLeft, kRight, Axis::Scale::Linear);
    const Axis y(ys, kBottom, kTop, chart.fromZero ? Axis::Scale::FromZero : Axis::Scale::Linear);
    std::string svg = drawFrame(chart.title, chart.where, chart.yLabel, y) + drawLegend(namesOf(chart.series));
    for (size_t i = 0; i < chart.xNames.size(); ++i)
        svg += drawText(x.position(static_cast<double>(i)), kBottom + 20, chart.xNames[i], Align::Middle);
    for (const double tick : chart.xNames.empty() ? x.ticks() : std::vector<double>{}) {
        svg += drawLine(x.position(tick), kBottom, x.position(tick), kBottom + 5, kInk);
        svg += drawText(x.position(tick), kBottom + 20, formatText("%g", tick), Align::Middle);
    }
    svg += drawText(0.5 * (kLeft + kRight), kBottom + 46, chart.xLabel, Align::Middle);
    for (size_t s = 0; s < chart.series.size(); ++s)
        svg += drawSeries(chart.series[s], colorOf(s), x, y);
    return svg + drawXAxis() + kEnd;
}

} // namespace q3rt
