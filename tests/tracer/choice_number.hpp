#pragma once
// The random number that makes the choice of a light come out as wanted.

#include <algorithm>
#include <vector>

namespace q3rt::test {

/// The number that keeps candidate `kept`: the middle of those that accept it and refuse all after it. Backward from
/// the number that the last step leaves.
inline float numberThatKeeps(const std::vector<double>& weights, size_t kept) {
    double number = 0.5, sum = 0;
    for (const double weight : weights)
        sum += weight;
    for (size_t i = weights.size(); i-- > 0;) {
        if (weights[i] == 0) continue;
        const double share = weights[i] / sum;
        // Those before it may win or lose; the likelier of the two keeps more digits.
        const bool wins = i == kept || (i < kept && share > 0.5);
        number = wins ? number * share : share + number * (1 - share);
        sum -= weights[i];
        if (sum < 1e-12 * weights[i]) sum = 0;
    }
    return static_cast<float>(std::min(number, 0.99999994));
}

} // namespace q3rt::test
