#pragma once
// Which of several ways is the fastest, measured on a machine that may be busy with other things. Load comes and goes
// over tens of milliseconds, so ways that are measured one after the other may each meet another load. Here they take
// turns: every round runs each way once, and each way is judged by its least cost, which load can only raise.

#include <functional>
#include <span>
#include <vector>

namespace q3rt {

/// Of one run. The cost is what ways are compared by: the time itself, or the time of all processors together, which
/// other programs hardly change.
struct RunTime {
    double wallMs = 0, costMs = 0;
};

struct RoundsResult {
    size_t fastest = 0;          ///< index of the way
    std::vector<double> leastMs; ///< least cost of each way
    size_t roundCount = 0;
    /// Even and odd rounds, each by themselves, lead to the same choice: a later measurement would too.
    bool repeatable = false;
};

/// Runs `ways` in turns, at least one round and then as many as are likely to end within `budgetMs` of wall time.
RoundsResult measureInRounds(std::span<const std::function<RunTime()>> ways, double budgetMs);

} // namespace q3rt
