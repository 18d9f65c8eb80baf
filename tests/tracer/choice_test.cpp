// The choice of one light among many: weighted by their probabilities, all choices together are all lights.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "choice_number.hpp"
#include "shader_text.hpp"

namespace q3rt {
namespace {

/// Sum of all outcomes of a choice, each times its probability, in double: the numbers that decide are integrated out.
/// Candidate i is the kept one if it won at i and lost nowhere after: w_i / S_i x prod_{j > i} (1 - w_j / S_j).
glm::dvec3 sumOfChoices(const std::vector<vec3>& irradiances) {
    std::vector<double> weights;
    for (const vec3& irradiance : irradiances)
        weights.push_back(static_cast<double>(shader::lightWeight(irradiance)));
    glm::dvec3 sum(0.0);
    double total = 0;
    for (size_t kept = 0; kept < irradiances.size(); ++kept) {
        if (weights[kept] == 0) continue;
        shader::LightChoice choice = shader::beginChoice(test::numberThatKeeps(weights, kept));
        double probability = 1, running = 0;
        for (size_t i = 0; i < irradiances.size(); ++i) {
            running += weights[i];
            if (i == kept) probability = weights[i] / running;
            if (i > kept && weights[i] > 0) probability *= 1 - weights[i] / running;
            shader::LightSample candidate = shader::darkSample(vec3(static_cast<float>(i)));
            candidate.irradiance = irradiances[i];
            choice = shader::considerWeighted(choice, candidate, shader::lightWeight(candidate.irradiance));
        }
        total += probability;
        // Rarer than the numbers are fine: chance can't choose it.
        if (choice.kept.direction.x != static_cast<float>(kept)) {
            EXPECT_LT(probability, 1e-5) << kept;
            continue;
        }
        sum += glm::dvec3(shader::chosenSample(choice).irradiance) * probability;
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
            ASSERT_NEAR(chosen[k], all[k], 1e-4 * all[k]) << "set " << set;
    }
    EXPECT_EQ(checked, 200);
}

TEST(LightChoice, NothingToChooseGivesNothing) {
    EXPECT_EQ(shader::chosenSample(shader::beginChoice(0.0f)).irradiance, vec3(0.0f));
    const shader::LightSample dark = shader::darkSample(vec3(1.0f));
    EXPECT_EQ(shader::considerWeighted(shader::beginChoice(0.0f), dark, 0.0f).weight, 0.0f);
}

} // namespace
} // namespace q3rt
