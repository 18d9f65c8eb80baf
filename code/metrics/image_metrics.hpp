#pragma once
// Differences between two pictures of equal size. Throws UsageError where the sizes differ or don't suffice.

#include "metrics/metric_image.hpp"

namespace q3rt {

/// Pixels a side of a window, and the least that a picture must have.
inline constexpr int kSsimWindow = 11;
/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli: Image Quality Assessment, 2004, equation 13) on luma
/// (0.299 R + 0.587 G + 0.114 B, range 0..255): 11 x 11 Gaussian window, sigma 1.5 pixels, K1 0.01, K2 0.03, windows
/// that lie wholly inside the picture. Every value in [-1, 1]; 1 = equal. Wants 11 x 11 pixels or more.
MetricMap computeSsim(const MetricImage& reference, const MetricImage& test);

/// 0.7 m before a 0.7 m wide screen of 3840 pixels, the viewing condition of the FLIP paper.
inline constexpr double kFlipPixelsPerDegree = 0.7 * 3840.0 / 0.7 * 3.14159265358979323846 / 180.0;

/// FLIP for pictures of limited range (Andersson et al.: FLIP, A Difference Evaluator for Alternating Images, 2020).
/// Inputs are sRGB in [0, 1]. Every value in [0, 1]; 0 = equal to the eye.
MetricMap computeFlip(const MetricImage& reference, const MetricImage& test,
                      double pixelsPerDegree = kFlipPixelsPerDegree);

/// Mean squared difference over pixels and channels; 1 = black against white.
double computeMse(const MetricImage& reference, const MetricImage& test);
/// -10 log10(MSE) in dB for a peak of 1; infinite for equal pictures.
double computePsnr(const MetricImage& reference, const MetricImage& test);

/// Keeps dark reference pixels from deciding alone (Rousselle, Knaus, Zwicker: Adaptive Sampling and Reconstruction
/// using Greedy Error Minimization, 2011, section 6); unit: squared radiance where 1 is a fully lit white texture.
inline constexpr double kRelativeMseEpsilon = 0.01;
/// Mean over pixels and channels of (test - reference)^2 / (reference^2 + kRelativeMseEpsilon).
double computeRelativeMse(const MetricImage& reference, const MetricImage& test);

} // namespace q3rt
