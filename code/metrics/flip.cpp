// FLIP for limited dynamic range, from the formulas of Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem,
// Fairchild: FLIP, A Difference Evaluator for Alternating Images, 2020. Two pipelines a picture: colour (blurred by the
// eye's contrast sensitivity, compared in a perceptually even space) and features (edges and points of the luminance);
// the larger the feature difference, the more the colour difference counts.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "metrics/filter.hpp"
#include "metrics/image_metrics.hpp"

namespace q3rt {

namespace {

using Triple = std::array<double, 3>;
using Planes = std::array<Plane2d, 3>;

// Constants of the paper: section 4.1 (q_c, p_c, p_t) and 4.2, 4.3 (w in degrees, q_f).
constexpr double kColorExponent = 0.7, kColorKnee = 0.4, kColorKneeValue = 0.95;
constexpr double kFeatureWidthDegrees = 0.082, kFeatureExponent = 0.5;

/// a1 sqrt(pi / b1) exp(-pi^2 d^2 / b1) + the same of (a2, b2); d in degrees (equation 5 and table 1).
struct ContrastSensitivity {
    double a1, b1, a2, b2;
};
constexpr ContrastSensitivity kSensitivities[3] = {
    {1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidestSpread = 0.04; ///< largest b of the table: decides every kernel's radius

// IEC 61966-2-1 primaries with white D65 at (0.3127, 0.3290); rows X, Y, Z. White is the row sums.
constexpr double kXyzFromRgb[3][3] = {
    {0.41239080, 0.35758434, 0.18048079}, {0.21263901, 0.71516868, 0.07219232}, {0.01933082, 0.11919478, 0.95053215}};

Triple whitePoint() {
    Triple white{};
    for (size_t row = 0; row < 3; ++row)
        white[row] = kXyzFromRgb[row][0] + kXyzFromRgb[row][1] + kXyzFromRgb[row][2];
    return white;
}

/// XYZ relative to white.
Triple relativeXyzFromRgb(const Triple& rgb) {
    const Triple white = whitePoint();
    Triple xyz{};
    for (size_t row = 0; row < 3; ++row)
        xyz[row] =
            (kXyzFromRgb[row][0] * rgb[0] + kXyzFromRgb[row][1] * rgb[1] + kXyzFromRgb[row][2] * rgb[2]) / white[row];
    return xyz;
}

/// Inverse of relativeXyzFromRgb by Cramer's rule: the two agree to rounding, which tabulated inverses don't.
Triple rgbFromRelativeXyz(const Triple& relative) {
    const Triple white = whitePoint();
    const auto& m = kXyzFromRgb;
    const Triple v{relative[0] * white[0], relative[1] * white[1], relative[2] * white[2]};
    const auto minor = [&](size_t r0, size_t r1, size_t c0, size_t c1) {
        return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    };
    const double determinant = m[0][0] * minor(1, 2, 1, 2) - m[0][1] * minor(1, 2, 0, 2) + m[0][2] * minor(1, 2, 0, 1);
    return {(v[0] * minor(1, 2, 1, 2) - v[1] * minor(0, 2, 1, 2) + v[2] * minor(0, 1, 1, 2)) / determinant,
            (-v[0] * minor(1, 2, 0, 2) + v[1] * minor(0, 2, 0, 2) - v[2] * minor(0, 1, 0, 2)) / determinant,
            (v[0] * minor(1, 2, 0, 1) - v[1] * minor(0, 2, 0, 1) + v[2] * minor(0, 1, 0, 1)) / determinant};
}

double decodeSrgb(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

/// Linearised CIELAB: achromatic, red-green, blue-yellow.
Triple yCxCzFromXyz(const Triple& relative) {
    return {116.0 * relative[1] - 16.0, 500.0 * (relative[0] - relative[1]), 200.0 * (relative[1] - relative[2])};
}

Triple xyzFromYCxCz(const Triple& c) {
    const double y = (c[0] + 16.0) / 116.0;
    return {y + c[1] / 500.0, y, y - c[2] / 200.0};
}

/// CIELAB with chroma scaled by lightness (Hunt effect, section 4.1): dark colours differ less.
Triple huntLabFromRgb(const Triple& rgb) {
    constexpr double kDelta = 6.0 / 29.0;
    Triple f = relativeXyzFromRgb(rgb);
    for (double& value : f)
        value = value > kDelta * kDelta * kDelta ? std::cbrt(value) : value / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    const double lightness = 116.0 * f[1] - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f[0] - f[1]), 0.01 * lightness * 200.0 * (f[1] - f[2])};
}

/// HyAB: distance for large colour differences, lightness apart from chroma.
double hyabDistance(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

Planes toYCxCz(const MetricImage& image) {
    Planes planes;
    for (auto& plane : planes)
        plane = {image.width, image.height, std::vector<double>(image.pixelCount())};
    for (size_t i = 0; i < image.pixelCount(); ++i) {
        const Triple rgb{decodeSrgb(image.rgb[3 * i]), decodeSrgb(image.rgb[3 * i + 1]),
                         decodeSrgb(image.rgb[3 * i + 2])};
        const Triple color = yCxCzFromXyz(relativeXyzFromRgb(rgb));
        for (size_t c = 0; c < 3; ++c)
            planes[c].values[i] = color[c];
    }
    return planes;
}

/// exp(-pi^2 d^2 / b) at the pixels -radius..radius.
std::vector<double> gaussianOfSpread(double spread, int radius, double pixelsPerDegree) {
    std::vector<double> kernel;
    for (int i = -radius; i <= radius; ++i) {
        const double degrees = i / pixelsPerDegree;
        kernel.push_back(std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / spread));
    }
    return kernel;
}

/// A sum of two Gaussians isn't separable, each of them is.
Plane2d filterContrast(const Plane2d& plane, const ContrastSensitivity& s, double pixelsPerDegree) {
    const double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestSpread / (2.0 * pi * pi)) * pixelsPerDegree));
    Plane2d result{plane.width, plane.height, std::vector<double>(plane.values.size(), 0.0)};
    double totalWeight = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
        if (a == 0.0) continue;
        const std::vector<double> kernel = gaussianOfSpread(b, radius, pixelsPerDegree);
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0), weight = a * std::sqrt(pi / b);
        totalWeight += weight * sum * sum;
        const Plane2d part = convolveSeparable(plane, kernel, kernel, Border::Replicate);
        for (size_t i = 0; i < result.values.size(); ++i)
            result.values[i] += weight * part.values[i];
    }
    for (double& value : result.values)
        value /= totalWeight;
    return result;
}

std::vector<Triple> perceivedColors(const Planes& yCxCz, double pixelsPerDegree) {
    Planes filtered;
    for (size_t c = 0; c < 3; ++c)
        filtered[c] = filterContrast(yCxCz[c], kSensitivities[c], pixelsPerDegree);
    std::vector<Triple> colors(filtered[0].values.size());
    for (size_t i = 0; i < colors.size(); ++i) {
        Triple rgb =
            rgbFromRelativeXyz(xyzFromYCxCz({filtered[0].values[i], filtered[1].values[i], filtered[2].values[i]}));
        for (double& value : rgb)
            value = std::clamp(value, 0.0, 1.0);
        colors[i] = huntLabFromRgb(rgb);
    }
    return colors;
}

/// Compresses large differences: up to the knee linear to 0.95, then linear to 1 at the largest possible (green to
/// blue).
double redistributeColorError(double distance) {
    static const double largest =
        std::pow(hyabDistance(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kColorExponent);
    const double error = std::pow(distance, kColorExponent), knee = kColorKnee * largest;
    if (error < knee) return kColorKneeValue / knee * error;
    return kColorKneeValue + (error - knee) / (largest - knee) * (1.0 - kColorKneeValue);
}

/// Scales positive weights to sum 1 and negative ones to sum -1, as a whole two-dimensional kernel
/// `derivative` x `smooth`, whose `smooth` part is positive.
void normalizeSigned(std::vector<double>& derivative, std::vector<double>& smooth) {
    double positive = 0, negative = 0;
    for (const double weight : derivative)
        (weight > 0 ? positive : negative) += std::abs(weight);
    for (double& weight : derivative)
        weight /= weight > 0 ? positive : negative > 0 ? negative : 1.0;
    const double sum = std::accumulate(smooth.begin(), smooth.end(), 0.0);
    for (double& weight : smooth)
        weight /= sum;
}

struct Features {
    std::vector<double> edges, points; ///< lengths of the first and second derivative
};

Features detectFeatures(const Plane2d& achromatic, double pixelsPerDegree) {
    const double sigma = 0.5 * kFeatureWidthDegrees * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<double> smooth, first, second;
    for (int i = -radius; i <= radius; ++i) {
        const double x = i / sigma, gaussian = std::exp(-0.5 * x * x);
        smooth.push_back(gaussian);
        first.push_back(-x * gaussian);
        second.push_back((x * x - 1.0) * gaussian);
    }
    std::vector<double> unused = smooth;
    normalizeSigned(first, smooth);
    normalizeSigned(second, unused);
    Plane2d luminance = achromatic;
    for (double& value : luminance.values)
        value = (value + 16.0) / 116.0;
    const auto gradientLength = [&](const std::vector<double>& derivative) {
        const Plane2d x = convolveSeparable(luminance, derivative, smooth, Border::Replicate);
        const Plane2d y = convolveSeparable(luminance, smooth, derivative, Border::Replicate);
        std::vector<double> length(x.values.size());
        for (size_t i = 0; i < length.size(); ++i)
            length[i] = std::hypot(x.values[i], y.values[i]);
        return length;
    };
    return {gradientLength(first), gradientLength(second)};
}

} // namespace

MetricMap computeFlip(const MetricImage& reference, const MetricImage& test, double pixelsPerDegree) {
    requireSameSize(reference, test);
    if (!(pixelsPerDegree > 0.0))
        throw UsageError(formatText("FLIP wants a positive number of pixels per degree, not %g", pixelsPerDegree));
    const Planes yReference = toYCxCz(reference), yTest = toYCxCz(test);
    const std::vector<Triple> colorsReference = perceivedColors(yReference, pixelsPerDegree);
    const std::vector<Triple> colorsTest = perceivedColors(yTest, pixelsPerDegree);
    const Features featuresReference = detectFeatures(yReference[0], pixelsPerDegree);
    const Features featuresTest = detectFeatures(yTest[0], pixelsPerDegree);
    MetricMap map{reference.width, reference.height, std::vector<double>(reference.pixelCount()), 0};
    for (size_t i = 0; i < map.values.size(); ++i) {
        const double color = redistributeColorError(hyabDistance(colorsReference[i], colorsTest[i]));
        const double difference = std::max(std::abs(featuresReference.edges[i] - featuresTest.edges[i]),
                                           std::abs(featuresReference.points[i] - featuresTest.points[i]));
        const double feature = std::pow(difference / std::numbers::sqrt2, kFeatureExponent);
        map.values[i] = std::pow(color, 1.0 - feature);
    }
    map.mean = std::accumulate(map.values.begin(), map.values.end(), 0.0) / static_cast<double>(map.values.size());
    return map;
}

} // namespace q3rt
