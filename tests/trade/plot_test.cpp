// The plot: well-formed XML, whatever the labels, everything inside the picture.

#include <cctype>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "host/trade/plot.hpp"
#include "host/trade/svg.hpp"
#include "sample_results.hpp"
#include "svg_faults.hpp"

namespace q3rt::test {
namespace {

/// Every number of an attribute.
std::vector<double> findNumbers(const std::string& svg, const std::string& attribute) {
    const std::regex pattern("\\s" + attribute + "=\"([-0-9.e+]+)\"");
    std::vector<double> numbers;
    for (std::sregex_iterator i(svg.begin(), svg.end(), pattern), end; i != end; ++i)
        numbers.push_back(std::stod((*i)[1]));
    return numbers;
}

struct Sample {
    std::vector<TradeResult> results;
    std::vector<std::string> labels;
};

Sample makeSample(size_t count, double msStep, double errorStep) {
    Sample sample;
    for (size_t i = 0; i < count; ++i) {
        const double number = static_cast<double>(i);
        sample.results.push_back(makeResult(1.0 + msStep * number, 0.5 + errorStep * number));
        sample.labels.push_back("label " + std::to_string(i));
    }
    return sample;
}

} // namespace

TEST(TradePlot, TheCheckerFindsFaults) {
    EXPECT_EQ(findXmlFault("<a b=\"c\"><d/>x &amp; y</a>\n"), "");
    for (const char* bad : {"<a>", "<a></b>", "<a b=c/>", "<a>&</a>", "<a/><b/>", "<a b=\"<\"/>", "<a>></a>", "x<a/>"})
        EXPECT_NE(findXmlFault(bad), "") << bad;
}

// One point, equal points, 24, 60; an error of 0; names with every character that XML minds.
TEST(TradePlot, IsWellFormedAndInsideThePicture) {
    std::vector<Sample> samples = {makeSample(1, 0, 0), makeSample(5, 0, 0), makeSample(24, 2.5, 0.02),
                                   makeSample(60, 1000, 0.008), makeSample(2, 1, 0.5)};
    samples[2].labels[0] = "a < b & \"c\" > d\x01";
    for (const Sample& sample : samples) {
        const std::string svg = drawTradePlot("title & more", sample.results, sample.labels, TradeClock::Wall);
        EXPECT_EQ(findXmlFault(svg), "");
        EXPECT_EQ(svg.find("nan"), std::string::npos);
        EXPECT_EQ(svg.find("inf"), std::string::npos);
        const double width = findNumbers(svg, "width").front(), height = findNumbers(svg, "height").front();
        for (const char* attribute : {"x", "x1", "x2", "cx"})
            for (const double x : findNumbers(svg, attribute))
                EXPECT_TRUE(x >= 0 && x <= width) << attribute << " " << x;
        for (const char* attribute : {"y", "y1", "y2", "cy"})
            for (const double y : findNumbers(svg, attribute))
                EXPECT_TRUE(y >= 0 && y <= height) << attribute << " " << y;
        EXPECT_EQ(findNumbers(svg, "cx").size(), sample.results.size());
        EXPECT_NE(svg.find("class=\"front\""), std::string::npos);
        EXPECT_NE(svg.find("frame time in ms"), std::string::npos);
        EXPECT_NE(svg.find("1 - SSIM"), std::string::npos);
    }
}

TEST(PlotAxis, TicksAreRoundAndInOrder) {
    for (const auto& values :
         {std::vector{1.0, 1000.0}, {4.0, 4.5}, {7.0}, {0.0, 1.0}, {0.0}, {1e-6, 0.5}, {0.9, 1.1}, {3.0, 4.0}}) {
        const svg::Axis axis(values, 100, 500);
        ASSERT_GE(axis.ticks().size(), 2u) << values.front();
        EXPECT_LE(axis.ticks().size(), 24u) << values.front();
        EXPECT_TRUE(std::is_sorted(axis.ticks().begin(), axis.ticks().end()));
        for (const double value : values) {
            EXPECT_GE(axis.position(value), 100);
            EXPECT_LE(axis.position(value), 500);
        }
    }
    const svg::Axis logarithmic(std::vector{1.0, 100.0}, 0, 100);
    EXPECT_TRUE(logarithmic.isLogarithmic());
    EXPECT_NEAR(logarithmic.position(10), 50, 1e-9);
    EXPECT_FALSE(svg::Axis(std::vector{0.0, 1.0}, 0, 1).isLogarithmic());
}

} // namespace q3rt::test
