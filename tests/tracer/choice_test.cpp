// The choice of one light among many: weighted by their probabilities, all choices together are all lights.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "shader_text.hpp"

namespace q3rt {
namespace {

/// Sum of all outcomes of a choice, each times its probability, in double: the numbers that decide are integrated out.
/// Candidate i is the kept one if it won at i and lost nowhere after: w_i / S_i x prod_{j > i} (1 - w_j / S_j).
glm::dvec3 sumOfChoices(const std::vector<vec3>& irradiances) {
    glm::dvec3 sum(0.0);
    double total = 0;
    for (size_t kept = 0; kept < irradiances.size(); ++kept) {
        // The smallest number of [0, 1) wins at `kept`; the largest loses everywhere else.
        shader::LightChoice choice = shader::emptyChoice();
        double probability = 1, running = 0;
        for (size_t i = 0; i < irradiances.size(); ++i) {
            const double weight = shader::lightWeight(irradiances[i]);
            running += weight;
            if (weight == 0) continue;
            shader::LightSample candidate;
            candidate.irradiance = irradiances[i];
            candidate.direction = vec3(static_cast<float>(i));
            if (i == kept) probability = weight / running;
            if (i > kept) probability *= 1 - weight / running;
            const float random = i <= kept ? 0.0f : 1.0f;
            choice = shader::considerLight(choice, candidate, random);
        }
        if (shader::lightWeight(irradiances[kept]) == 0) continue;
        EXPECT_EQ(choice.direction.x, static_cast<float>(kept));
        sum += glm::dvec3(shader::chosenIrradiance(choice)) * probability;
        total += probability;
    }
    EXPECT_NEAR(total, 1, 1e-9);
    return sum;
}

TEST(LightChoice, WeightedSumOfChoicesIsTheSumOfAllLights) {
    std::mt19937 generator(5);
    std::lognormal_distribution<float> strength(0.0f, 3.0f);
    int checked = 0;
    for (int set = 0; set < 200; ++set, ++checked) {
        std::vector<vec3> lights;
        glm::dvec3 all(0.0);
        for (int i = 0; i <= set % 40; ++i) {
            const vec3 light =
                i % 7 == 3 ? vec3(0.0f) : vec3(strength(generator), strength(generator), strength(generator));
            lights.push_back(light);
            all += glm::dvec3(light);
        }
        const glm::dvec3 chosen = sumOfChoices(lights);
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(chosen[k], all[k], 1e-5 * all[k]) << "set " << set;
    }
    EXPECT_EQ(checked, 200);
}

TEST(LightChoice, NothingToChooseGivesNothing) {
    EXPECT_EQ(shader::chosenIrradiance(shader::emptyChoice()), vec3(0.0f));
    shader::LightSample dark;
    dark.irradiance = vec3(0.0f);
    dark.direction = vec3(1.0f);
    EXPECT_EQ(shader::considerLight(shader::emptyChoice(), dark, 0.0f).weight, 0.0f);
}

} // namespace
} // namespace q3rt
