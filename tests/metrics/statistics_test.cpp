#include "metrics/statistics.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace q3rt::test {

TEST(Statistics, StudentQuantilesAgreeWithPublishedTable) {
    // NIST/SEMATECH e-Handbook of Statistical Methods, table 1.3.6.7.2 (three decimals); infinite row: normal.
    const struct {
        double confidence;
        int degrees;
        double expected;
    } rows[] = {{0.95, 1, 12.706},  {0.95, 2, 4.303},   {0.95, 5, 2.571},    {0.95, 10, 2.228}, {0.95, 30, 2.042},
                {0.95, 100, 1.984}, {0.99, 1, 63.657},  {0.99, 7, 3.499},    {0.99, 20, 2.845}, {0.90, 4, 2.132},
                {0.80, 3, 1.638},   {0.998, 15, 3.733}, {0.95, 99999, 1.960}};
    int cases = 0;
    for (const auto& row : rows) {
        EXPECT_NEAR(studentQuantile(row.confidence, row.degrees), row.expected, 0.00051)
            << row.confidence << " " << row.degrees;
        ++cases;
    }
    EXPECT_EQ(cases, 13);
    EXPECT_NEAR(studentQuantile(0.95, 1), std::tan(0.475 * M_PI), 1e-9);
}

TEST(Statistics, QuantilesInterpolate) {
    const std::vector<double> values{4, 1, 3, 2};
    EXPECT_DOUBLE_EQ(computeQuantile(values, 0), 1);
    EXPECT_DOUBLE_EQ(computeQuantile(values, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(computeQuantile(values, 1), 4);
    EXPECT_DOUBLE_EQ(computeQuantile(values, 0.25), 1.75);
    EXPECT_THROW(computeQuantile({}, 0.5), UsageError);
    EXPECT_THROW(computeQuantile(values, 1.5), UsageError);
}

TEST(Statistics, MeanIntervalOfKnownSample) {
    // Mean 3, standard deviation sqrt(2.5), 4 degrees of freedom: half width 2.776445 sqrt(0.5).
    const std::vector<double> values{1, 2, 3, 4, 5};
    const Interval interval = computeMeanInterval(values);
    EXPECT_DOUBLE_EQ(interval.value, 3);
    EXPECT_NEAR(interval.high - 3, 2.7764451 * std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(interval.low + interval.high, 6, 1e-12);
    EXPECT_THROW(computeMeanInterval(std::vector<double>{1}), UsageError);
    EXPECT_THROW(computeMeanInterval(values, 1.0), UsageError);
}

TEST(Statistics, IntervalsCoverTheTruthAsOftenAsTheySay) {
    // 400 samples of 25 values; a true 95 % interval misses 20 +- 4.4: 5 standard deviations are allowed, and the
    // bootstrap's known undercoverage for small samples is added to its upper bound.
    std::mt19937_64 generator(1234);
    const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
    int meanMisses = 0, medianMisses = 0;
    for (int round = 0; round < 400; ++round) {
        std::vector<double> values(25);
        for (double& value : values)
            value = uniform() + uniform() + uniform() + uniform();
        const Interval mean = computeMeanInterval(values), median = computeMedianInterval(values, 0.95, 400);
        meanMisses += mean.low > 2.0 || mean.high < 2.0;
        medianMisses += median.low > 2.0 || median.high < 2.0;
    }
    EXPECT_NEAR(meanMisses, 20, 22);
    EXPECT_LE(medianMisses, 50);
    EXPECT_GT(meanMisses + medianMisses, 0);
}

TEST(Statistics, MedianIntervalIsReproducibleAndHoldsTheMedian) {
    const std::vector<double> values{9, 1, 8, 2, 7, 3, 6, 4, 5};
    const Interval first = computeMedianInterval(values), second = computeMedianInterval(values);
    EXPECT_EQ(first.value, 5);
    EXPECT_EQ(first.low, second.low);
    EXPECT_EQ(first.high, second.high);
    EXPECT_LE(first.low, 5);
    EXPECT_GE(first.high, 5);
    const Interval same = computeMedianInterval(std::vector<double>{2, 2, 2});
    EXPECT_EQ(same.low, 2);
    EXPECT_EQ(same.high, 2);
}

} // namespace q3rt::test
