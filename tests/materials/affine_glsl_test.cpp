// The folded form of a surface's stages against blending them one after another in double.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "glsl_shim.hpp"

namespace q3rt {
namespace {

using glm::dvec4;

std::mt19937 g_generator(7);

float uniform(float low = 0, float high = 1) { return std::uniform_real_distribution<float>(low, high)(g_generator); }
vec4 uniformColor() { return {uniform(), uniform(), uniform(), uniform()}; }

constexpr uint kSourceFactors[] = {kBlendOne,
                                   kBlendZero,
                                   kBlendDstColor,
                                   kBlendOneMinusDstColor,
                                   kBlendSrcAlpha,
                                   kBlendDstAlpha,
                                   kBlendOneMinusSrcAlpha,
                                   kBlendOneMinusDstAlpha,
                                   kBlendSrcAlphaSaturate};
constexpr uint kDestinationFactors[] = {kBlendOne,      kBlendZero,     kBlendSrcColor,         kBlendOneMinusSrcColor,
                                        kBlendSrcAlpha, kBlendDstAlpha, kBlendOneMinusSrcAlpha, kBlendOneMinusDstAlpha};

/// One stage with what it samples. `light` is what the baked light of the stage would be replaced with.
struct TestStage {
    StageState state{};
    vec4 color{1}, texel0{1}, texel1{1};
};

/// Baked light of a stage lies in a texel or in the colour; all stages of a surface share it.
uint anyCombine() { return std::uniform_int_distribution<uint>(0, 2)(g_generator); }

TestStage makeStage(uint baked, const vec3& light, uint combine) {
    TestStage stage;
    stage.state.bakedLight = baked;
    stage.state.combine = combine;
    stage.state.color = stage.color = uniformColor();
    stage.texel0 = uniformColor();
    stage.texel1 = uniformColor();
    const bool second = stage.state.combine != kCombineSingle && uniform() < 0.5f;
    if (baked == kBakedLightmap) {
        (second ? stage.texel1 : stage.texel0) = vec4(light, 1);
        stage.state.unit[second ? 1 : 0].isLightmap = 1;
    } else if (baked != kBakedNone) {
        stage.color = vec4(vec3(stage.state.color) * light, stage.color.a);
    }
    return stage;
}

/// The fragment with `light` in the place of the baked one. Unclamped: the algebra has no clamp.
dvec4 fragmentOf(const TestStage& stage, const dvec3& light) {
    dvec4 texel0 = stage.texel0, texel1 = stage.texel1, color = stage.color;
    if (stage.state.unit[0].isLightmap) texel0 = dvec4(light, 1);
    if (stage.state.unit[1].isLightmap) texel1 = dvec4(light, 1);
    if (stage.state.bakedLight == kBakedVertex || stage.state.bakedLight == kBakedGrid)
        color = dvec4(dvec3(stage.state.color) * light, color.a);
    if (stage.state.combine == kCombineMultiply) return texel0 * texel1 * color;
    if (stage.state.combine == kCombineAdd) {
        const dvec3 sum = dvec3(texel0) * dvec3(color) + dvec3(texel1);
        return dvec4(sum, texel0.a * texel1.a * color.a);
    }
    return texel0 * color;
}

dvec3 factorOf(uint factor, const dvec4& source, const dvec3& destination) {
    switch (factor) {
    case kBlendOne:
    case kBlendDstAlpha:
        return dvec3(1);
    case kBlendSrcColor:
        return dvec3(source);
    case kBlendOneMinusSrcColor:
        return 1.0 - dvec3(source);
    case kBlendDstColor:
        return destination;
    case kBlendOneMinusDstColor:
        return 1.0 - destination;
    case kBlendSrcAlpha:
        return dvec3(source.a);
    case kBlendOneMinusSrcAlpha:
        return dvec3(1 - source.a);
    default:
        return dvec3(0);
    }
}

dvec3 blendInOrder(const std::vector<TestStage>& stages, const dvec3& light, dvec3 frame) {
    for (const TestStage& stage : stages) {
        const dvec4 source = fragmentOf(stage, light);
        if (!stage.state.blended) {
            frame = dvec3(source);
            continue;
        }
        frame = dvec3(source) * factorOf(stage.state.sourceBlend, source, frame) +
                frame * factorOf(stage.state.destinationBlend, source, frame);
    }
    return frame;
}

glsl::AffineColor fold(const std::vector<TestStage>& stages) {
    glsl::AffineColor result = glsl::beginAffine();
    for (const TestStage& stage : stages)
        result = glsl::addStage(result, stage.state, stage.color, stage.texel0, stage.texel1);
    return result;
}

void expectEqual(const vec3& actual, const dvec3& expected, const char* what) {
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(actual[k], expected[k], 2e-5 * (1 + std::abs(expected[k]))) << what;
}

/// Add combines saturate in the shader; keep their sums below 1 so that the reference needs no clamp.
void keepBelowOne(TestStage& stage) {
    if (stage.state.combine != kCombineAdd) return;
    for (vec4* texel : {&stage.texel0, &stage.texel1})
        *texel = vec4(vec3(*texel) * 0.5f, texel->a);
}

TEST(AffineGlsl, AllFactorPairsAreExactWhereTheLightIsTheBakedOne) {
    int checked = 0;
    for (const uint source : kSourceFactors)
        for (const uint destination : kDestinationFactors)
            for (int i = 0; i < 60; ++i) {
                const vec3 baked(uniform(0.05f, 0.5f), uniform(0.05f, 0.5f), uniform(0.05f, 0.5f));
                std::vector<TestStage> stages;
                for (int n = 0; n < 3; ++n) {
                    stages.push_back(makeStage(static_cast<uint>(g_generator() % 4), baked, anyCombine()));
                    if (stages.back().state.bakedLight == kBakedNone) keepBelowOne(stages.back());
                    if (stages.back().state.bakedLight != kBakedNone && stages.back().state.combine == kCombineAdd)
                        stages.back().state.combine = kCombineMultiply;
                    stages.back().state.blended = n > 0 || i % 2 ? 1 : 0;
                    stages.back().state.sourceBlend = source;
                    stages.back().state.destinationBlend = destination;
                }
                const vec3 behind(uniform(), uniform(), uniform());
                expectEqual(glsl::resolveAffine(fold(stages), baked, behind), blendInOrder(stages, baked, behind),
                            "baked light");
                ++checked;
            }
    EXPECT_EQ(checked, 9 * 8 * 60);
}

TEST(AffineGlsl, StacksWithoutProductsOfLightAreExactForAnyLight) {
    // Factors that are colours appear only where one side is free of light and of what is behind.
    int checked = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 baked(uniform(), uniform(), uniform());
        std::vector<TestStage> stages;
        const bool lightFirst = i % 2 == 0;
        stages.push_back(makeStage(lightFirst ? kBakedLightmap : kBakedNone, baked, kCombineSingle));
        stages.push_back(makeStage(lightFirst ? kBakedNone : kBakedLightmap, baked, kCombineSingle));
        stages.push_back(makeStage(kBakedNone, baked, kCombineSingle)); // a glow
        stages.push_back(makeStage(kBakedNone, baked, kCombineSingle)); // a fade to what was drawn
        for (size_t n = 1; n < 4; ++n)
            stages[n].state.blended = 1;
        stages[1].state.sourceBlend = i % 4 < 2 ? kBlendDstColor : kBlendZero;
        stages[1].state.destinationBlend = i % 4 < 2 ? kBlendZero : kBlendSrcColor;
        stages[2].state.sourceBlend = stages[2].state.destinationBlend = kBlendOne;
        stages[3].state.sourceBlend = kBlendSrcAlpha;
        stages[3].state.destinationBlend = kBlendOneMinusSrcAlpha;
        const vec3 traced(uniform(0, 3), uniform(0, 3), uniform(0, 3));
        expectEqual(glsl::resolveAffine(fold(stages), traced, vec3(0.3f)), blendInOrder(stages, traced, dvec3(0.3)),
                    "any light");
        ++checked;
    }
    EXPECT_EQ(checked, 2000);
}

TEST(AffineGlsl, AddedLightmapSplitsByUnit) {
    for (const uint first : {0u, 1u}) {
        TestStage stage;
        stage.state.combine = kCombineAdd;
        stage.state.bakedLight = kBakedLightmap;
        stage.state.unit[first ? 0 : 1].isLightmap = 1;
        stage.color = stage.state.color = vec4(0.5f, 0.5f, 0.5f, 1);
        stage.texel0 = vec4(0.4f);
        stage.texel1 = vec4(0.3f);
        const glsl::AffineColor result = fold({stage});
        expectEqual(glsl::resolveAffine(result, vec3(2), vec3(9)), dvec3(first ? 2 * 0.5 + 0.3 : 0.4 * 0.5 + 2), "add");
    }
}

TEST(AffineGlsl, ProductsAreExactInTheDarkAndNeverNegative) {
    for (int i = 0; i < 2000; ++i) {
        const vec3 baked(uniform(), uniform(), uniform());
        std::vector<TestStage> stages = {makeStage(kBakedLightmap, baked, kCombineSingle),
                                         makeStage(kBakedVertex, baked, kCombineSingle)};
        for (TestStage& stage : stages) {
            stage.state.blended = 1;
            stage.state.sourceBlend = kBlendDstColor;
            stage.state.destinationBlend = kBlendZero;
        }
        stages[0].state.blended = i % 2;
        const glsl::AffineColor result = fold(stages);
        if (i % 2 == 0) expectEqual(glsl::resolveAffine(result, vec3(0), vec3(0.5f)), dvec3(0), "dark");
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(result.lit, vec3(0))));
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(result.through, vec3(0))));
    }
}

TEST(AffineGlsl, TestedStagesLeaveHolesThatLaterEqualStagesRespect) {
    TestStage leaf; // fails its test
    leaf.state.alphaTest = kTestGreaterEqual128;
    leaf.state.depthWrite = 1;
    leaf.texel0 = vec4(0.2f, 0.9f, 0.1f, 0.4f);
    TestStage light;
    light.state.bakedLight = kBakedLightmap;
    light.state.unit[0].isLightmap = 1;
    light.state.blended = 1;
    light.state.sourceBlend = kBlendDstColor;
    light.state.destinationBlend = kBlendZero;
    light.state.depthEqual = 1;
    light.texel0 = vec4(0.5f);
    const glsl::AffineColor hole = fold({leaf, light});
    EXPECT_EQ(hole.through, vec3(1));
    EXPECT_EQ(hole.wroteDepth, 0u);
    leaf.texel0.a = 0.6f;
    const glsl::AffineColor solid = fold({leaf, light});
    EXPECT_EQ(solid.through, vec3(0));
    EXPECT_EQ(solid.wroteDepth, 1u);
    expectEqual(solid.lit, dvec3(0.2, 0.9, 0.1), "albedo");
}

} // namespace
} // namespace q3rt
