#pragma once
// Bars in groups and lines, with error bars, as SVG. Pure.

#include <optional>
#include <string>
#include <vector>

namespace q3rt {

/// A measured value and the ends of its error bar.
struct ChartValue {
    double value = 0, low = 0, high = 0;
};

struct BarChart {
    std::string title, where; ///< what was measured; on what
    std::string valueLabel;   ///< names the unit and what the error bars are
    std::vector<std::string> groups;
    struct Series {
        std::string name;
        std::vector<ChartValue> values; ///< one a group
    };
    std::vector<Series> series;
    std::optional<double> limit; ///< a value to stay below, as a line
    std::string limitName;
};
std::string drawBarChart(const BarChart& chart);

struct LineChart {
    std::string title, where, xLabel, yLabel;
    struct Point {
        double x = 0;
        ChartValue y;
    };
    struct Series {
        std::string name;
        std::vector<Point> points; ///< rising x; a single one is drawn as a level line
        bool marks = true;         ///< and error bars; false: a line alone, for many points
    };
    std::vector<Series> series;
    bool fromZero = true;              ///< the values' axis; false: their own range
    std::vector<std::string> xNames{}; ///< in place of numbers at x = 0, 1, 2 ...
};
std::string drawLineChart(const LineChart& chart);

} // namespace q3rt
