#pragma once
// A sweep as a picture: time against error, error bars, the front as a line, a list of the points. SVG 1.1, no scripts,
// no fonts of its own. Pure.

#include <span>
#include <string>
#include <vector>

#include "host/trade_result.hpp"

namespace q3rt {

/// `title` says what was measured, where. Labels name the points, in their order.
std::string drawTradePlot(const std::string& title, std::span<const TradeResult> results,
                          std::span<const std::string> labels);

/// One axis of a plot: logarithmic if all values are above 0, with ticks at 1, 2 and 5 times powers of ten.
class PlotAxis {
  public:
    /// Pixels run from `start` (lowest value) to `end`, in either direction. `values` must not be empty.
    PlotAxis(std::span<const double> values, double start, double end);
    double position(double value) const; ///< pixels; values outside lie on the edge
    bool isLogarithmic() const { return m_logarithmic; }
    const std::vector<double>& ticks() const { return m_ticks; }

  private:
    double scaled(double value) const;
    void addLogarithmicTicks();
    void addLinearTicks();
    bool m_logarithmic;
    double m_low = 0, m_high = 1, m_start, m_end;
    std::vector<double> m_ticks;
};

} // namespace q3rt
