// The front and the table.

#include <random>

#include <gtest/gtest.h>

#include "host/trade/front.hpp"
#include "sample_results.hpp"

namespace q3rt::test {

TEST(TradeFront, HoldsWhatNothingBeats) {
    const std::vector<TradeCost> costs = {{5, 0.1}, {1, 0.5}, {3, 0.3}, {4, 0.3}, {3, 0.4}, {6, 0.2}};
    EXPECT_EQ(findFront(costs), (std::vector<size_t>{1, 2, 0}));
    EXPECT_TRUE(findFront({}).empty());
}

TEST(TradeFront, EqualPointsStayTogether) {
    const std::vector<TradeCost> costs = {{1, 0.5}, {1, 0.5}, {2, 0.5}};
    EXPECT_EQ(findFront(costs), (std::vector<size_t>{0, 1}));
}

// 200 random sweeps of 30 points: time rises and error falls along the front, and it beats or equals every point.
TEST(TradeFront, IsMonotonousAndBeatsTheRest) {
    std::mt19937 generator(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<TradeCost> costs(30);
        for (TradeCost& cost : costs)
            cost = {1.0 + generator() % 20, 0.05 * static_cast<double>(generator() % 20)};
        const std::vector<size_t> front = findFront(costs);
        ASSERT_FALSE(front.empty());
        for (size_t i = 1; i < front.size(); ++i) {
            const TradeCost &before = costs[front[i - 1]], &after = costs[front[i]];
            const bool same = before.ms == after.ms && before.error == after.error;
            EXPECT_TRUE(same || (before.ms < after.ms && before.error > after.error));
        }
        for (const TradeCost& cost : costs)
            EXPECT_TRUE(std::any_of(front.begin(), front.end(),
                                    [&](size_t i) { return costs[i].ms <= cost.ms && costs[i].error <= cost.error; }));
    }
}

TEST(TradeTable, ColumnsAlignAndTheFrontIsMarked) {
    const std::vector<TradeResult> results = {makeResult(1, 0.5), makeResult(222.25, 0.4), makeResult(3, 0.75)};
    const std::vector<std::string> labels = {"first", "second", "third"};
    const std::string table = formatTradeTable(results, labels, TradeClock::Wall);
    std::vector<std::string> lines;
    for (size_t start = 0; start < table.size();) {
        const size_t end = table.find('\n', start);
        lines.push_back(table.substr(start, end - start));
        start = end + 1;
    }
    ASSERT_EQ(lines.size(), 6u);
    EXPECT_EQ(lines[1].find("first"), lines[2].find("second"));
    EXPECT_EQ(lines[1].find("first"), lines[3].find("third"));
    EXPECT_EQ(lines[1].find('*'), lines[3].find('*'));
    EXPECT_NE(lines[1].find('*'), std::string::npos);
    EXPECT_EQ(lines[2].find('*'), std::string::npos);
    EXPECT_NE(lines[1].find("0.5000 +-0.0100"), std::string::npos) << lines[1];
    EXPECT_NE(lines[1].find("equal"), std::string::npos) << "PSNR of equal pictures";
    EXPECT_NE(lines[0].find("device ms"), std::string::npos);
    EXPECT_NE(lines[2].find("111.12"), std::string::npos) << "time on the device: " << lines[2];
    EXPECT_NE(lines[5].find("up to 512 frames"), std::string::npos) << lines[5];
    EXPECT_NE(lines[5].find("0.00100"), std::string::npos) << lines[5];
    EXPECT_NE(lines[5].find("0.25000"), std::string::npos) << "the nearest setting: " << lines[5];
}

// What waits for the processor alone costs the device nothing.
TEST(TradeTable, TheClockDecidesTheFront) {
    std::vector<TradeResult> results = {makeResult(1, 0.5), makeResult(2, 0.4)};
    results[1].gpuMs->median = 0.1;
    EXPECT_EQ(findFront(costsOf(results, TradeClock::Wall)), (std::vector<size_t>{0}));
    EXPECT_EQ(findFront(costsOf(results, TradeClock::Device)), (std::vector<size_t>{1, 0}));
    const std::string table = formatTradeTable(results, std::vector<std::string>{"a", "b"}, TradeClock::Device);
    EXPECT_NE(table.find("faster on the device"), std::string::npos) << table;
    results[0].gpuMs.reset();
    results[1].gpuMs.reset();
    EXPECT_EQ(formatTradeTable(results, std::vector<std::string>{"a", "b"}, TradeClock::Wall).find("device"),
              std::string::npos)
        << "no timers, no column";
}

} // namespace q3rt::test
