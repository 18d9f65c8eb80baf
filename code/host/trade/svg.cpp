#include "host/trade/svg.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "host/common/json_text.hpp"

namespace q3rt::svg {
namespace {

constexpr double kCapLength = 4; ///< pixels, half of an error bar's end

std::string escapeXml(const std::string& text) {
    std::string escaped;
    for (const char c : toUtf8(text)) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '"')
            escaped += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20)
            escaped += c;
    }
    return escaped;
}

} // namespace

std::string begin(double width, double height) {
    return formatText("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\" "
                      "font-family=\"sans-serif\" font-size=\"%g\" fill=\"%s\">\n",
                      width, height, width, height, kFontSize, kInk) +
           formatText("<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n", width, height);
}

std::string drawLine(double x0, double y0, double x1, double y1, const char* color, double width) {
    return formatText("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"%g\"/>\n", x0,
                      y0, x1, y1, color, width);
}

std::string drawBar(double x0, double y0, double x1, double y1, const char* color) {
    const bool upright = x0 == x1;
    const double dx = upright ? kCapLength : 0, dy = upright ? 0 : kCapLength;
    return drawLine(x0, y0, x1, y1, color) + drawLine(x0 - dx, y0 - dy, x0 + dx, y0 + dy, color) +
           drawLine(x1 - dx, y1 - dy, x1 + dx, y1 + dy, color);
}

std::string drawText(double x, double y, const std::string& text, Align align, bool bold, const char* more) {
    const char* anchor = align == Align::Start ? "start" : align == Align::Middle ? "middle" : "end";
    return formatText("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s%s>", x, y, anchor,
                      bold ? " font-weight=\"bold\"" : "", more) +
           escapeXml(text) + "</text>\n";
}

std::string drawUprightText(double x, double y, const std::string& text) {
    return drawText(x, y, text, Align::Middle, false, formatText(" transform=\"rotate(-90 %.1f %.1f)\"", x, y).c_str());
}

std::string threeDigits(double value) {
    const int before = value > 0 ? static_cast<int>(std::floor(std::log10(value))) + 1 : 1;
    return formatText("%.*f", std::clamp(3 - before, 0, 9), value);
}

Axis::Axis(std::span<const double> values, double start, double end, Scale scale)
    : m_logarithmic(scale == Scale::Any && *std::min_element(values.begin(), values.end()) > 0)
    , m_start(start)
    , m_end(end) {
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    // A twelfth of the range stays free on both sides, for numbers; a single value gets a range around it.
    m_low = m_logarithmic ? std::log10(*lowest) : *lowest;
    m_high = m_logarithmic ? std::log10(*highest) : *highest;
    const double range = m_high - m_low;
    const double margin = range > 0 ? range / 12 : m_logarithmic ? 0.5 : std::max(0.5 * std::abs(m_high), 0.5);
    m_high += margin;
    m_low -= margin;
    if (scale == Scale::FromZero) {
        m_low = 0;
        m_high = std::max(1.08 * *highest, 1e-9);
    }
    m_logarithmic ? addLogarithmicTicks() : addLinearTicks();
}

double Axis::scaled(double value) const {
    if (!m_logarithmic) return value;
    return value > 0 ? std::log10(value) : m_low;
}

double Axis::position(double value) const {
    const double share = (std::clamp(scaled(value), m_low, m_high) - m_low) / (m_high - m_low);
    return m_start + share * (m_end - m_start);
}

void Axis::addLogarithmicTicks() {
    for (double decade = std::floor(m_low); decade <= m_high; ++decade)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double tick = step * std::pow(10.0, decade);
            if (std::log10(tick) >= m_low && std::log10(tick) <= m_high) m_ticks.push_back(tick);
        }
    if (m_ticks.size() >= 2) return;
    // Less than a factor of 2.5 from end to end: even steps read better.
    m_ticks.clear();
    const double low = std::pow(10.0, m_low), high = std::pow(10.0, m_high);
    const double step = std::pow(10.0, std::floor(std::log10(high - low)));
    for (double tick = std::ceil(low / step) * step; tick <= high; tick += step)
        m_ticks.push_back(tick);
}

void Axis::addLinearTicks() {
    const double decade = std::pow(10.0, std::floor(std::log10(m_high - m_low)));
    const double count = (m_high - m_low) / decade; // in [1, 10)
    const double step = decade * (count < 2 ? 0.2 : count < 5 ? 0.5 : 1.0);
    for (double index = std::ceil(m_low / step); index * step <= m_high; ++index)
        m_ticks.push_back(index * step + 0.0); // the sum turns -0 into 0
}

} // namespace q3rt::svg
