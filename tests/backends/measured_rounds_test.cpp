// The fastest of several ways, on a machine whose other work comes and goes: made-up times, known answers.

#include "base/measured_rounds.hpp"

#include <random>

#include <gtest/gtest.h>

namespace q3rt::test {
namespace {

constexpr double kBudgetMs = 180;

/// A clock that only the measured runs move, and a load that stretches what runs while it lasts. Both kinds of stretch
/// have random lengths, as other programs have.
class BusyMachine {
  public:
    BusyMachine(uint32_t seed, double meanBusyMs, double meanQuietMs)
        : m_random(seed)
        , m_busyMs(1 / meanBusyMs)
        , m_quietMs(1 / meanQuietMs) {
        m_stretchEndMs = m_quietMs(m_random);
    }
    /// Takes the time that a run of `ms` needs here.
    double run(double ms) {
        double taken = 0;
        for (double workMs = ms; workMs > 0;) {
            const double factor = m_busy ? kSlowdown : 1;
            const double part = std::min(workMs, (m_stretchEndMs - m_nowMs) / factor);
            workMs -= part;
            taken += part * factor;
            m_nowMs += part * factor;
            if (workMs <= 0) break;
            m_busy = !m_busy;
            m_nowMs = m_stretchEndMs;
            m_stretchEndMs += m_busy ? m_busyMs(m_random) : m_quietMs(m_random);
        }
        return taken;
    }
    double nowMs() const { return m_nowMs; }

  private:
    static constexpr double kSlowdown = 3; // two more programs on the same core
    std::mt19937 m_random;
    std::exponential_distribution<double> m_busyMs, m_quietMs;
    double m_nowMs = 0, m_stretchEndMs = 0;
    bool m_busy = false;
};

RunTime timeOf(double ms) { return {ms, ms}; }

RoundsResult measureOn(BusyMachine& machine, const std::vector<double>& trueMs) {
    std::vector<std::function<RunTime()>> ways;
    for (const double ms : trueMs)
        ways.emplace_back([&machine, ms] { return timeOf(machine.run(ms)); });
    return measureInRounds(ways, kBudgetMs);
}

/// Share of machines on which the choice was kept although another way is faster by more than a fifth, and on which it
/// was kept at all.
struct Shares {
    double wrong = 0, kept = 0;
};
Shares chooseOnMany(const std::vector<double>& trueMs, double meanBusyMs, double meanQuietMs) {
    constexpr int kMachines = 2000;
    const double least = *std::min_element(trueMs.begin(), trueMs.end());
    Shares shares;
    for (int seed = 0; seed < kMachines; ++seed) {
        BusyMachine machine(static_cast<uint32_t>(seed), meanBusyMs, meanQuietMs);
        const RoundsResult result = measureOn(machine, trueMs);
        if (!result.repeatable) continue;
        shares.kept += 1.0 / kMachines;
        shares.wrong += trueMs[result.fastest] > 1.2 * least ? 1.0 / kMachines : 0;
    }
    std::printf("busy %g ms, quiet %g ms: %.2f %% kept, %.2f %% wrong\n", meanBusyMs, meanQuietMs, 100 * shares.kept,
                100 * shares.wrong);
    return shares;
}

TEST(Rounds, FindTheFastestOnAQuietMachine) {
    BusyMachine machine(1, 1, 1e9);
    const RoundsResult result = measureOn(machine, {7.5, 7.4, 3.7});
    EXPECT_EQ(result.fastest, 2u);
    EXPECT_EQ(result.leastMs, (std::vector{7.5, 7.4, 3.7}));
    EXPECT_TRUE(result.repeatable);
    EXPECT_EQ(result.roundCount, 9u); // of 18.6 ms
    EXPECT_LE(machine.nowMs(), kBudgetMs);
}

// Measured one after the other, 60 ms each, the choice is wrong on 4, 22, 30 and 7 % of these machines.
TEST(Rounds, FindTheFastestOnABusyMachine) {
    for (const auto& [busyMs, quietMs] : {std::pair{20.0, 20.0}, {80.0, 60.0}, {200.0, 100.0}, {15.0, 5.0}}) {
        const Shares shares = chooseOnMany({7.5, 7.5, 3.7}, busyMs, quietMs);
        EXPECT_LE(shares.wrong, 0.015);
        EXPECT_GE(shares.kept, 0.8);
    }
}

TEST(Rounds, EquallyFastWaysAreKeptToo) {
    const Shares shares = chooseOnMany({5.0, 5.1, 12.0}, 40, 40);
    EXPECT_EQ(shares.wrong, 0);
    EXPECT_GE(shares.kept, 0.9);
}

TEST(Rounds, ASingleRoundIsNotKept) {
    BusyMachine machine(1, 1, 1e9);
    const RoundsResult result = measureOn(machine, {100, 90, 80});
    EXPECT_EQ(result.fastest, 2u);
    EXPECT_EQ(result.roundCount, 1u);
    EXPECT_FALSE(result.repeatable);
}

// As a software device is measured: the wall time is ten times too long and varies, the processor time does not.
TEST(Rounds, CostDecidesAndWallTimeBounds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> wallMs(5, 20), disturbance(1, 1.2);
    double spentMs = 0;
    std::vector<std::function<RunTime()>> ways;
    for (const double ms : {7.5, 7.5, 3.7})
        ways.emplace_back([&, ms] {
            const RunTime time{wallMs(random), ms * disturbance(random)};
            spentMs += time.wallMs;
            return time;
        });
    const RoundsResult result = measureInRounds(ways, kBudgetMs);
    EXPECT_EQ(result.fastest, 2u);
    EXPECT_TRUE(result.repeatable);
    EXPECT_GT(result.roundCount, 2u);
    EXPECT_LE(spentMs, kBudgetMs + 60); // one round may be longer than the shortest one foretold
}

TEST(Rounds, OneWayNeedsNoContest) {
    BusyMachine machine(1, 1, 1e9);
    const RoundsResult result = measureOn(machine, {500});
    EXPECT_EQ(result.roundCount, 1u);
    EXPECT_TRUE(result.repeatable);
}

TEST(Rounds, TimesThatContradictEachOtherAreNotKept) {
    // The first way is fast in even rounds only, the second in odd ones.
    int calls[2] = {0, 0};
    const std::vector<std::function<RunTime()>> ways = {[&] { return timeOf(calls[0]++ % 2 == 0 ? 5 : 10); },
                                                        [&] { return timeOf(calls[1]++ % 2 == 0 ? 10 : 5); }};
    EXPECT_FALSE(measureInRounds(ways, kBudgetMs).repeatable);
}

} // namespace
} // namespace q3rt::test
