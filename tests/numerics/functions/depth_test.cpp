// Depth to world position and back: the formulas of a hybrid renderer (Forward+ thesis, equations 2.1 and 4.3,
// algorithm 4.1) against the plain inverse matrix, reverse-Z against standard depth, in float against double. Our ray
// tracer carries positions with their error bounds instead; this measures what a renderer that rebuilds them would pay.
//
// Equation 2.1 as printed has a sign too many: with C = -f / (n - f), D = -f n / (n - f) depth runs from 0 at the near
// plane to -1 at the far one. Here C and D are those of Vulkan's [0, 1]: C = f / (n - f), D = f n / (n - f); reverse-Z
// exchanges n and f. Equation 4.3 holds for any C and D.

#include <cmath>
#include <random>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "math/vector.hpp"
#include "numerics/measured.hpp"

namespace q3rt::test {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec4;

constexpr double kNear = 4, kFar = 65536; ///< qu: the renderers' near plane, the far corner of the largest maps
constexpr double kUnitRoundoff = 0x1p-24;
constexpr int kWidth = 1920, kHeight = 1080;
constexpr size_t kSamples = 100000;

double gammaOf(double n) { return n * kUnitRoundoff / (1 - n * kUnitRoundoff); }

struct Projection {
    double A, B, C, D;
    bool reversed;
};

Projection makeProjection(bool reversed) {
    const double n = reversed ? kFar : kNear, f = reversed ? kNear : kFar;
    const double tanY = std::tan(0.5 * 73.74 * M_PI / 180); // 90 degrees across 4:3
    return {1 / tanY * kHeight / kWidth, -1 / tanY, f / (n - f), f * n / (n - f), reversed};
}

template <typename M>
M matrixOf(const Projection& p) {
    using T = typename M::value_type;
    M m(T(0));
    m[0][0] = T(p.A), m[1][1] = T(p.B), m[2][2] = T(p.C), m[2][3] = T(-1), m[3][2] = T(p.D);
    return m;
}

dmat4 makeWorldFromView(const dvec3& eye) {
    const dvec3 z = glm::normalize(dvec3(0.3, -0.8, 0.52)), x = glm::normalize(glm::cross(dvec3(0, 0, 1), z));
    return {dvec4(x, 0), dvec4(glm::cross(z, x), 0), dvec4(z, 0), dvec4(eye, 1)};
}

/// A pixel and the depth that its buffer holds, a 32-bit float.
struct Sample {
    vec2 pixel{0}; ///< whole
    float depth = 0;
    dvec3 world{0}; ///< where the surface is
    double distance = 0;
};

/// Distances are spread evenly over their logarithm.
std::vector<Sample> makeSamples(const Projection& p, const dmat4& worldFromView) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Sample> samples;
    for (size_t i = 0; i < kSamples; ++i) {
        Sample s;
        s.pixel = {std::floor(unit(random) * kWidth), std::floor(unit(random) * kHeight)};
        const double z = kNear * std::pow(kFar / kNear, unit(random));
        s.depth = static_cast<float>((-p.C * z + p.D) / z);
        const dvec2 ndc = (dvec2(s.pixel) + 0.5) / dvec2(kWidth, kHeight) * 2.0 - 1.0;
        const dvec3 view(ndc.x / p.A * z, ndc.y / p.B * z, -z);
        s.world = dvec3(worldFromView * dvec4(view, 1));
        s.distance = glm::length(view);
        samples.push_back(s);
    }
    return samples;
}

/// Algorithm 4.1.
vec3 rebuildByFormula(const Sample& s, const Projection& p, const mat4& worldFromView) {
    const vec2 share = (s.pixel + 0.5f) / vec2(kWidth, kHeight);
    const vec2 ndc(std::fma(share.x, 2.0f, -1.0f), std::fma(share.y, 2.0f, -1.0f));
    const auto A = static_cast<float>(p.A), B = static_cast<float>(p.B), C = static_cast<float>(p.C),
               D = static_cast<float>(p.D);
    vec4 view(ndc.x / A, ndc.y / B, -1.0f, (s.depth + C) / D);
    view /= view.w;
    return vec3(worldFromView * view);
}

vec2 plainNdc(const Sample& s) { return ((s.pixel + 0.5f) * (vec2(1.0f) / vec2(kWidth, kHeight))) * 2.0f - 1.0f; }

/// Inverse of the projection, then of the view.
vec3 rebuildInTwoSteps(const Sample& s, const mat4& viewFromClip, const mat4& worldFromView) {
    vec4 view = viewFromClip * vec4(plainNdc(s), s.depth, 1.0f);
    view /= view.w;
    return vec3(worldFromView * view);
}

/// One inverse of both together.
vec3 rebuildInOneStep(const Sample& s, const mat4& worldFromClip) {
    const vec4 world = worldFromClip * vec4(plainNdc(s), s.depth, 1.0f);
    return vec3(world) / world.w;
}

/// Largest error as a share of the distance from the eye; of the formula also beyond what its bound allows.
struct Worst {
    double formula = 0, ofBound = 0, twoSteps = 0, oneStep = 0;
};

/// Roundings of the formula, each relative to the distance: the depth and C and their sum and D and the quotient (5),
/// the final quotient (1); of the direction pixel share and ndc and A (3); of the rotation 3 products and 3 sums of
/// components whose absolute sum is at most sqrt(3) of the length (11). The translation adds one of the eye's size.
/// Standard depth is near 1 where C is near -1: both roundings are of the size of 1, and of their difference only n / z
/// is left.
double boundOf(const Projection& p, const Sample& s, double eyeSize) {
    double bound = gammaOf(20) * s.distance + gammaOf(2) * (eyeSize + s.distance);
    if (!p.reversed) bound += 1.5 * kUnitRoundoff * s.distance / kNear * s.distance;
    return bound;
}

Worst measure(const Projection& p, const dvec3& eye) {
    const dmat4 worldFromView = makeWorldFromView(eye);
    const mat4 worldFromView32(worldFromView),
        viewFromClip = glm::inverse(matrixOf<mat4>(p)),
        worldFromClip = glm::inverse(matrixOf<mat4>(p) * mat4(glm::inverse(worldFromView)));
    Worst worst;
    for (const Sample& s : makeSamples(p, worldFromView)) {
        const auto errorOf = [&](const vec3& rebuilt) { return glm::length(dvec3(rebuilt) - s.world); };
        const double error = errorOf(rebuildByFormula(s, p, worldFromView32));
        worst.formula = std::max(worst.formula, error / s.distance);
        worst.ofBound = std::max(worst.ofBound, error / boundOf(p, s, glm::length(eye)));
        worst.twoSteps =
            std::max(worst.twoSteps, errorOf(rebuildInTwoSteps(s, viewFromClip, worldFromView32)) / s.distance);
        worst.oneStep = std::max(worst.oneStep, errorOf(rebuildInOneStep(s, worldFromClip)) / s.distance);
    }
    return worst;
}

TEST(Depth, PositionsFromDepthStayWithinTheirBound) {
    for (const bool reversed : {true, false})
        for (const double eye : {0.0, 8000.0, 65536.0}) {
            const Worst worst = measure(makeProjection(reversed), dvec3(eye, -eye, eye));
            const std::string name = std::string(reversed ? "reverse-Z" : "standard depth") + ", eye at " +
                                     std::to_string(static_cast<int>(eye));
            std::printf("numerics | %s: formula %.2g, inverse in two steps %.2g, in one %.2g of the distance\n",
                        name.c_str(), worst.formula, worst.twoSteps, worst.oneStep);
            expectWithin("depth to position, " + name, worst.ofBound, 1, "of the bound");
        }
}

TEST(Depth, TheFormulaIsNoWorseThanAnInverseMatrix) {
    for (const bool reversed : {true, false}) {
        const Worst worst = measure(makeProjection(reversed), dvec3(0));
        EXPECT_LE(worst.formula, worst.twoSteps * 1.01) << reversed;
        EXPECT_LE(worst.formula, worst.oneStep * 1.01) << reversed;
    }
}

/// Depth of a view-space point in float: the product with the matrix, then the quotient.
float depthOf(const Projection& p, float z) { return (static_cast<float>(p.C) * -z + static_cast<float>(p.D)) / z; }

TEST(Depth, ReverseZKeepsDistancesApart) {
    // The relative error of a distance that goes to depth in float and comes back in double.
    double worst[2] = {0, 0};
    for (const bool reversed : {false, true}) {
        const Projection p = makeProjection(reversed);
        for (double z = kNear * 1.001; z < kFar; z *= 1.0001) {
            const auto z32 = static_cast<float>(z);
            const double back = p.D / (static_cast<double>(depthOf(p, z32)) + p.C);
            worst[reversed] = std::max(worst[reversed], std::abs(back / static_cast<double>(z32) - 1));
        }
    }
    // Reverse-Z: D and C and their product and sum, the quotient, and the stored depth: 6, each of the size of D / z.
    expectWithin("distance to depth and back, reverse-Z", worst[1], gammaOf(6), "of the distance");
    // Standard: three roundings of the size of 1 where only n / z is left.
    expectWithin("distance to depth and back, standard", worst[0], 3 * kUnitRoundoff * kFar / kNear, "of the distance");
    EXPECT_LT(worst[1] * 1000, worst[0]) << "reverse-Z is worth it";
}

} // namespace
} // namespace q3rt::test
