#pragma once
// Text of SVG 1.1 pictures: no scripts, no fonts of its own. Pure.

#include <span>
#include <string>
#include <vector>

namespace q3rt::svg {

inline constexpr double kFontSize = 13, kDigitWidth = 8; ///< pixels
inline constexpr const char *kInk = "#222222", *kGridColor = "#dddddd";

enum class Align { Start, Middle, End };

/// The picture's first elements; it ends with kEnd.
std::string begin(double width, double height);
inline constexpr const char* kEnd = "</svg>\n";

std::string drawLine(double x0, double y0, double x1, double y1, const char* color, double width = 1);
/// An error bar with its ends, upright or lying.
std::string drawBar(double x0, double y0, double x1, double y1, const char* color);
std::string drawText(double x, double y, const std::string& text, Align align = Align::Start, bool bold = false,
                     const char* more = "");
/// Reads from the bottom to the top; the middle of the text.
std::string drawUprightText(double x, double y, const std::string& text);

/// Three digits or more, never as a power of ten.
std::string threeDigits(double value);

/// One axis of a plot, with ticks at 1, 2 and 5 times powers of ten.
class Axis {
  public:
    enum class Scale {
        Any,      ///< logarithmic if all values are above 0
        FromZero, ///< linear, from 0
        Linear
    };
    /// Pixels run from `start` (lowest value) to `end`, in either direction. `values` must not be empty.
    Axis(std::span<const double> values, double start, double end, Scale scale = Scale::Any);
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

} // namespace q3rt::svg
