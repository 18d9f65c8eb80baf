// Transparent layers: collected in batches in any order of calls, they come out in drawing order, each once.

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "shader_text.hpp"

namespace q3rt::shader {
namespace {
#include "trace/trace.glsl"
} // namespace
} // namespace q3rt::shader

namespace q3rt {
namespace {

using shader::Layer;
using shader::LayerKey;

std::vector<Layer> makeLayers(std::mt19937& generator, size_t count) {
    std::uniform_real_distribution<float> distance(1.0f, 20.0f);
    std::vector<Layer> layers;
    for (size_t i = 0; i < count; ++i) {
        // Every third layer lies exactly where another one does: its number decides.
        const float at = i % 3 == 2 ? layers[i - 1].key.distance : distance(generator);
        layers.push_back({{at, static_cast<uint32_t>(i / 5), static_cast<uint32_t>(i)}, at, vec2(0.25f)});
    }
    return layers;
}

/// What a traversal does: offers every layer, in this order, some of them twice.
std::vector<uint32_t> collect(const std::vector<Layer>& offered) {
    std::vector<uint32_t> result;
    LayerKey after{0.0f, 0, 0};
    for (;;) {
        shader::LayerBatch batch = shader::emptyBatch(after);
        for (size_t i = 0; i < offered.size(); ++i) {
            shader::insertLayer(batch, offered[i]);
            if (i % 4 == 1) shader::insertLayer(batch, offered[i - 1]);
        }
        for (uint32_t i = 0; i < batch.count; ++i)
            result.push_back(batch.layers[i].key.triangle);
        if (batch.count < shader::kLayersPerBatch) return result;
        after = batch.layers[shader::kLayersPerBatch - 1].key;
    }
}

TEST(Layers, ComeInDrawingOrderWhateverTheOrderOfCalls) {
    std::mt19937 generator(21);
    int checked = 0;
    for (size_t count = 0; count <= 33; ++count)
        for (int shuffle = 0; shuffle < 20; ++shuffle, ++checked) {
            std::vector<Layer> layers = makeLayers(generator, count);
            std::vector<Layer> sorted = layers;
            std::sort(sorted.begin(), sorted.end(),
                      [](const Layer& a, const Layer& b) { return shader::isBefore(a.key, b.key); });
            std::shuffle(layers.begin(), layers.end(), generator);
            std::vector<uint32_t> expected;
            for (const Layer& layer : sorted)
                expected.push_back(layer.key.triangle);
            ASSERT_EQ(collect(layers), expected) << count << " layers";
        }
    EXPECT_EQ(checked, 680);
}

TEST(Layers, LaterDrawnCoplanarLayersComeFirst) {
    // Two marks in one plane: their distances may come out differently by the bound; one step of the drawing order is
    // more than that, at any angle.
    std::mt19937 generator(22);
    std::uniform_real_distribution<float> distance(1.0f, 8000.0f), cosine(0.02f, 1.0f), error(-1.0f, 1.0f);
    for (int i = 0; i < 100000; ++i) {
        const float t = distance(generator), origin = distance(generator), c = cosine(generator);
        // Both points have the bound of a rebuilt point, and the ray meets the plane under this cosine.
        const float wobble = kHitPointError * (t + origin) / c;
        const float first = t + wobble * error(generator), second = t + wobble * error(generator);
        const float later = second - 2.0f * shader::sameDistanceStep(second, origin, c);
        const float earlier = first - 1.0f * shader::sameDistanceStep(first, origin, c);
        ASSERT_LT(later, earlier);
    }
}

} // namespace
} // namespace q3rt
