// The plot: well-formed XML, whatever the labels, everything inside the picture.

#include <cctype>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "host/trade_plot.hpp"
#include "sample_results.hpp"

namespace q3rt::test {
namespace {

/// What is wrong with an XML text of elements, quoted attributes and character data; empty: nothing.
std::string findXmlFault(const std::string& xml) {
    static const std::regex kTag(R"(<(/?)([A-Za-z][\w:-]*)((?:\s+[A-Za-z][\w:-]*="[^"<]*")*)\s*(/?)>)");
    static const std::regex kEntity("&(?:amp|lt|gt|quot);");
    std::vector<std::string> open;
    size_t at = 0, roots = 0;
    while (at < xml.size()) {
        const size_t tag = std::min(xml.find('<', at), xml.size());
        const std::string text = std::regex_replace(xml.substr(at, tag - at), kEntity, "");
        if (text.find_first_of("&>") != std::string::npos) return "bare character in '" + text + "'";
        if (open.empty() && text.find_first_not_of(" \n") != std::string::npos) return "text outside the root";
        if (tag == xml.size()) break;
        std::smatch match;
        const std::string rest = xml.substr(tag, 2000);
        if (!std::regex_search(rest, match, kTag, std::regex_constants::match_continuous)) return "bad tag: " + rest;
        if (std::regex_replace(match[3].str(), kEntity, "").find('&') != std::string::npos) return "bare & in a tag";
        if (match[1].length() > 0) {
            if (open.empty() || open.back() != match[2]) return "unexpected end of " + match[2].str();
            open.pop_back();
        } else {
            if (open.empty() && ++roots > 1) return "two roots";
            if (match[4].length() == 0) open.push_back(match[2]);
        }
        at = tag + static_cast<size_t>(match[0].length());
    }
    return open.empty() ? "" : "never ended: " + open.back();
}

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
        const std::string svg = drawTradePlot("title & more", sample.results, sample.labels);
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
        const PlotAxis axis(values, 100, 500);
        ASSERT_GE(axis.ticks().size(), 2u) << values.front();
        EXPECT_LE(axis.ticks().size(), 24u) << values.front();
        EXPECT_TRUE(std::is_sorted(axis.ticks().begin(), axis.ticks().end()));
        for (const double value : values) {
            EXPECT_GE(axis.position(value), 100);
            EXPECT_LE(axis.position(value), 500);
        }
    }
    const PlotAxis logarithmic(std::vector{1.0, 100.0}, 0, 100);
    EXPECT_TRUE(logarithmic.isLogarithmic());
    EXPECT_NEAR(logarithmic.position(10), 50, 1e-9);
    EXPECT_FALSE(PlotAxis(std::vector{0.0, 1.0}, 0, 1).isLogarithmic());
}

} // namespace q3rt::test
