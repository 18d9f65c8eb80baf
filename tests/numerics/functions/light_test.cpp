// One light's sample and the choice among lights at their extremes: faint and strong, near and far, flat and none.

#include <algorithm>
#include <cmath>
#include <random>

#include "numerics/measured.hpp"
#include "tracer/shader_text.hpp"

namespace q3rt::test {
namespace {

constexpr double kUnitRoundoff = 0x1p-24;

struct Triangle {
    vec3 corner{0}, edge1{0}, edge2{0}, normal{0};
    float area = 0;
};

Triangle makeTriangle(const vec3& a, const vec3& b, const vec3& c) {
    const dvec3 cross = glm::cross(dvec3(c) - dvec3(a), dvec3(b) - dvec3(a));
    const double length = glm::length(cross);
    return {a, b - a, c - a, length > 0 ? vec3(cross / length) : vec3(0), static_cast<float>(length / 2)};
}

/// Solid angle of a light seen from the origin (van Oosterom and Strackee 1983), and what its roundings may do to it.
struct SeenLight {
    double solidAngle = 0;
    double relativeError = 0;
};

SeenLight seeLight(const Triangle& light) {
    const dvec3 a = light.corner, b = a + dvec3(light.edge1), c = a + dvec3(light.edge2);
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const dvec3 areas = glm::cross(dvec3(light.edge1), dvec3(light.edge2));
    const double triple = glm::dot(areas, a); // positive on the side that shines, where corners go clockwise
    const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    // Distance of the plane: 3 roundings in its sum of products, 1 in the normal, of |corner|; 4 of area and products.
    const double tripleError = kUnitRoundoff * (4 * glm::length(areas) * la + 4 * std::abs(triple));
    if (triple <= tripleError) return {}; // in the plane, as far as the numbers tell
    // Four products of three lengths; in each 2 roundings of corners, 3 of lengths and their products, 3 of the scalar
    // product; 3 sums.
    const double denominatorError = kUnitRoundoff * 4 * (2 + 3 + 3 + 3) * la * lb * lc;
    const double half = std::atan2(triple, denominator);
    const double ofAngle = (tripleError * std::abs(denominator) + denominatorError * triple) /
                           (triple * triple + denominator * denominator);
    return {2 * half, ofAngle / half + 12 * kUnitRoundoff};
}

float uniform(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

TEST(LightSamples, KeepTheirErrorFromFaintToStrongAndFromNearToFar) {
    std::mt19937 random(21);
    double worst = 0;
    size_t cases = 0, notFinite = 0;
    for (const float distance : {1e-3f, 1e-2f, 1.0f, 100.0f, 1e4f, 1e5f})
        for (const float radiance : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
            for (int i = 0; i < 2000; ++i) {
                const float size = std::exp2(uniform(random, -10, 10));
                const vec3 base(uniform(random, -1, 1) * size, uniform(random, -1, 1) * size, distance);
                const Triangle light =
                    makeTriangle(base, base + vec3(uniform(random, 0.1f, 1), 0, uniform(random, -0.1f, 0.1f)) * size,
                                 base + vec3(0, uniform(random, 0.1f, 1), uniform(random, -0.1f, 0.1f)) * size);
                const vec3 normal = glm::normalize(vec3(uniform(random, -1, 1), uniform(random, -1, 1), 1));
                const auto got = shader::sampleTriangleLight(vec3(0), normal, light.corner, light.edge1, light.edge2,
                                                             light.normal, light.area, vec3(radiance), false,
                                                             uniform(random, 0, 1), uniform(random, 0, 1));
                if (!std::isfinite(got.irradiance.x)) ++notFinite;
                const dvec3 way = glm::normalize(dvec3(got.direction));
                const double cosine = glm::dot(dvec3(normal), way);
                const SeenLight seen = seeLight(light);
                if (cosine <= 8 * kUnitRoundoff || seen.solidAngle <= 0) continue;
                ++cases;
                const double exact = double(radiance) * seen.solidAngle * cosine;
                // The cosine: 3 roundings of its sum of products, 3 of the way's length; products.
                const double bound = seen.relativeError + 6 * kUnitRoundoff / cosine + 4 * kUnitRoundoff;
                worst = std::max(worst, std::abs(double(got.irradiance.x) / exact - 1) / bound);
            }
    expectCount("light samples that are not finite, emission 1e-6 to 1e6, distance 1e-3 to 1e5", notFinite, cases);
    expectWithin("light sample's relative error, emission 1e-6 to 1e6, distance 1e-3 to 1e5", worst, 1, "of the bound");
}

/// In the light's plane, on the light itself, at its corners: nothing, and nothing that is not a number.
TEST(LightSamples, GiveNothingInTheirPlane) {
    std::mt19937 random(22);
    size_t wrong = 0, cases = 0;
    const Triangle light = makeTriangle(vec3(0), vec3(64, 0, 0), vec3(0, 64, 0));
    for (int i = 0; i < 20000; ++i) {
        const float along = uniform(random, 0, 1), across = uniform(random, 0, 1 - along);
        vec3 position = light.corner + light.edge1 * along + light.edge2 * across;
        if (i % 3 == 1) position = light.corner;
        if (i % 3 == 2) position = vec3(uniform(random, -1e5f, 1e5f), uniform(random, -1e5f, 1e5f), 0);
        for (const vec3& normal : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(0.6f, 0, 0.8f), vec3(1, 0, 0)}) {
            const auto got =
                shader::sampleTriangleLight(position, normal, light.corner, light.edge1, light.edge2, light.normal,
                                            light.area, vec3(1e6f), true, uniform(random, 0, 1), uniform(random, 0, 1));
            ++cases;
            if (got.irradiance != vec3(0)) ++wrong;
        }
    }
    expectCount("light from a light in the surface's own plane", wrong, cases);
}

TEST(LightSamples, FlatLightsGiveNothing) {
    size_t wrong = 0, cases = 0;
    for (const vec3& third : {vec3(0, 0, 10), vec3(64, 0, 10), vec3(32, 0, 10)}) {
        const Triangle light = makeTriangle(vec3(0, 0, 10), vec3(64, 0, 10), third);
        const auto got = shader::sampleTriangleLight(vec3(0), vec3(0, 0, 1), light.corner, light.edge1, light.edge2,
                                                     light.normal, light.area, vec3(1e6f), true, 0.3f, 0.3f);
        ++cases;
        if (got.irradiance != vec3(0)) ++wrong;
    }
    expectCount("lights without an area that give light", wrong, cases);
}

/// A sphere gives I cos / d^2 at every distance, also where its cone is a hair: its mean over the square of samples.
TEST(LightSamples, SpheresKeepTheInverseSquare) {
    constexpr int kSteps = 64;
    double worst = 0;
    for (const float distance : {16.5f, 32.0f, 1000.0f, 1e5f})
        for (const float intensity : {1e-6f, 1.0f, 1e6f}) {
            double sum = 0;
            for (int i = 0; i < kSteps * kSteps; ++i)
                sum += shader::sampleSphereLight(vec3(0), vec3(0, 0, 1), vec3(0, 0, distance), 16, vec3(intensity),
                                                 (static_cast<float>(i % kSteps) + 0.5f) / kSteps,
                                                 (static_cast<float>(i / kSteps) + 0.5f) / kSteps)
                           .irradiance.x;
            const double expected = double(intensity) / (double(distance) * double(distance));
            worst = std::max(worst, std::abs(sum / (kSteps * kSteps) / expected - 1));
        }
    expectWithin("light of a sphere, distance 16.5 to 1e5", worst, 2e-6, "relative");
    for (const vec3& centre : {vec3(0), vec3(0, 0, 16), vec3(1e-6f, 0, 0)}) {
        const auto inside = shader::sampleSphereLight(vec3(0), vec3(0, 0, 1), centre, 16, vec3(256), 0.3f, 0.7f);
        EXPECT_FLOAT_EQ(inside.irradiance.x, 1) << "in the sphere the light comes from all sides";
        const auto point = shader::sampleSphereLight(vec3(0), vec3(0, 0, 1), centre, 0, vec3(256), 0.3f, 0.7f);
        EXPECT_TRUE(std::isfinite(point.irradiance.x));
    }
}

/// Sum over all outcomes of the choice, each with its probability: the lights of a room from 1e-6 to 1e6 and of 1, 16
/// and 20,000 of them. The running sum of weights is the only rounding.
TEST(LightChoices, GiveEveryLightItsShare) {
    for (const size_t count : {size_t{1}, size_t{16}, size_t{20000}}) {
        std::mt19937 random(23);
        std::vector<double> weights;
        double exactSum = 0, runningError = 0;
        shader::LightChoice choice = shader::beginChoice(0);
        size_t neverChosen = 0;
        for (size_t i = 0; i < count; ++i) {
            shader::LightSample sample;
            sample.irradiance = vec3(std::pow(10.0f, uniform(random, -6, 6)), 0, 0);
            sample.direction = vec3(static_cast<float>(i));
            exactSum += double(sample.irradiance.x);
            // Random number 0 must choose whatever gives light, however little.
            choice = shader::considerWeighted(choice, sample, shader::lightWeight(sample.irradiance));
            if (choice.kept.direction.x != static_cast<float>(i)) ++neverChosen;
            runningError = std::max(runningError, std::abs(double(choice.weightSum) / exactSum - 1));
        }
        const std::string lights = std::to_string(count) + (count == 1 ? " light" : " lights");
        expectCount("lights that can't be chosen, " + lights, neverChosen, count);
        expectWithin("sum of weights of " + lights + " of 1e-6 to 1e6", runningError,
                     static_cast<double>(count) * kUnitRoundoff, "relative");
    }
}

/// A random number is a multiple of 2^-24: a light whose share is less than that is chosen by 0 alone, too often by at
/// most 2^-24 of all light.
TEST(LightChoices, FaintLightsAreTooBrightByNoMoreThanTheirNumbersStep) {
    double worst = 0;
    for (const float share : {1e-3f, 1e-5f, 1e-7f, 1e-9f, 1e-12f}) {
        // How many of the 2^24 numbers choose the second light.
        shader::LightSample strong, faint;
        strong.irradiance = vec3(1, 0, 0);
        faint.irradiance = vec3(share, 0, 0);
        strong.direction = faint.direction = vec3(1);
        uint32_t low = 0, high = 1u << 24; // the lowest number that does not choose it
        while (low < high) {
            const uint32_t middle = (low + high) / 2;
            const auto first = shader::considerWeighted(shader::beginChoice(static_cast<float>(middle) * 0x1p-24f),
                                                        strong, shader::lightWeight(strong.irradiance));
            const auto chosen = shader::considerWeighted(first, faint, shader::lightWeight(faint.irradiance));
            if (chosen.weight == share)
                low = middle + 1;
            else
                high = middle;
        }
        EXPECT_GE(low, 1u) << "0 chooses what gives light";
        const double probability = low * 0x1p-24, sum = 1.0 + double(share);
        // What the faint light gives on average: its irradiance x sum / share, times the probability.
        worst = std::max(worst, std::abs(probability * sum - double(share)));
    }
    expectWithin("light that a faint light gives too much, of all light", worst, 0x1p-24, "");
}

} // namespace
} // namespace q3rt::test
