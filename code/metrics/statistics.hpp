#pragma once
// What a list of measured numbers says, and how sure that is. Throws UsageError for fewer values than a figure needs.

#include <cstdint>
#include <span>

namespace q3rt {

/// An estimate and the interval that holds the true value with the stated confidence.
struct Interval {
    double value = 0, low = 0, high = 0;
};

/// Quantile of sorted-on-the-fly values, `fraction` in [0, 1], linear between neighbours (position fraction (n - 1)).
double computeQuantile(std::span<const double> values, double fraction);

/// Mean and its Student-t interval; wants 2 values or more. Right for normal values, near enough for many of any kind.
Interval computeMeanInterval(std::span<const double> values, double confidence = 0.95);

/// Median and its percentile bootstrap interval (Efron: Bootstrap Methods, 1979): the same numbers give the same
/// interval, the generator is seeded with `seed`. Wants 2 values or more.
Interval computeMedianInterval(std::span<const double> values, double confidence = 0.95, int resampleCount = 2000,
                               uint64_t seed = 1);

/// t with P(|T| <= t) = `confidence` for Student's distribution of `degreesOfFreedom` >= 1.
double studentQuantile(double confidence, int degreesOfFreedom);

} // namespace q3rt
