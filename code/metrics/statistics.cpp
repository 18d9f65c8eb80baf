#include "metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "base/error.hpp"

namespace q3rt {

namespace {

void requireCount(std::span<const double> values, size_t count, const char* what) {
    if (values.size() < count)
        throw UsageError(formatText("%s wants %zu values or more, not %zu", what, count, values.size()));
}

void requireConfidence(double confidence) {
    if (!(confidence > 0.0 && confidence < 1.0))
        throw UsageError(formatText("a confidence lies between 0 and 1, not at %g", confidence));
}

double quantileOfSorted(const std::vector<double>& sorted, double fraction) {
    const double position = fraction * static_cast<double>(sorted.size() - 1);
    const size_t below = static_cast<size_t>(position), above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

/// P(|T| <= t): the finite series in the angle atan(t / sqrt(n)) (Abramowitz, Stegun: Handbook of Mathematical
/// Functions, 26.7.3 and 26.7.4).
double studentProbability(double t, int degreesOfFreedom) {
    const double angle = std::atan(t / std::sqrt(static_cast<double>(degreesOfFreedom)));
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const bool odd = degreesOfFreedom % 2 != 0;
    double term = odd ? cosine : 1.0, sum = degreesOfFreedom > 1 ? term : 0.0;
    for (int k = odd ? 3 : 2; k < degreesOfFreedom; k += 2) {
        term *= cosine * cosine * (k - 1) / k;
        sum += term;
    }
    return odd ? 2.0 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

} // namespace

double computeQuantile(std::span<const double> values, double fraction) {
    requireCount(values, 1, "a quantile");
    if (!(fraction >= 0.0 && fraction <= 1.0))
        throw UsageError(formatText("a quantile's fraction lies in [0, 1], not at %g", fraction));
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return quantileOfSorted(sorted, fraction);
}

double studentQuantile(double confidence, int degreesOfFreedom) {
    requireConfidence(confidence);
    if (degreesOfFreedom < 1)
        throw UsageError(formatText("Student's distribution wants a degree of freedom, not %d", degreesOfFreedom));
    double low = 0, high = 1;
    while (studentProbability(high, degreesOfFreedom) < confidence)
        high *= 2;
    // Halving ends when no double lies between the two.
    for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
        (studentProbability(middle, degreesOfFreedom) < confidence ? low : high) = middle;
    return high;
}

Interval computeMeanInterval(std::span<const double> values, double confidence) {
    requireCount(values, 2, "a mean's interval");
    const double count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0;
    for (const double value : values)
        squares += (value - mean) * (value - mean);
    const double standardError = std::sqrt(squares / (count - 1) / count);
    const double half = studentQuantile(confidence, static_cast<int>(values.size()) - 1) * standardError;
    return {mean, mean - half, mean + half};
}

Interval computeMedianInterval(std::span<const double> values, double confidence, int resampleCount, uint64_t seed) {
    requireCount(values, 2, "a median's interval");
    requireConfidence(confidence);
    if (resampleCount < 1) throw UsageError(formatText("a bootstrap wants a resample, not %d", resampleCount));
    std::mt19937_64 generator(seed);
    std::vector<double> medians, sample(values.size());
    for (int round = 0; round < resampleCount; ++round) {
        // The bias of the remainder is below size / 2^64; unlike the library's distributions it is the same everywhere.
        for (double& value : sample)
            value = values[generator() % values.size()];
        std::sort(sample.begin(), sample.end());
        medians.push_back(quantileOfSorted(sample, 0.5));
    }
    const double tail = 0.5 * (1.0 - confidence);
    return {computeQuantile(values, 0.5), computeQuantile(medians, tail), computeQuantile(medians, 1.0 - tail)};
}

} // namespace q3rt
