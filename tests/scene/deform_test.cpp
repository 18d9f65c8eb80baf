// Deforms (spec of materials 2.4, of models 6).

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "scene/deform.hpp"
#include "scene/wave.hpp"

namespace q3rt::test {
namespace {

Material makeMaterial(const Deform& deform) {
    Material material;
    material.deforms.push_back(deform);
    return material;
}

Vertex makeVertex(const vec3& position, const vec3& normal = vec3(0, 0, 1), const vec2& st = vec2(0)) {
    Vertex vertex{};
    vertex.position = position;
    vertex.normal = normal;
    vertex.st = st;
    return vertex;
}

struct Batch {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
};

/// A 32 x 8 quad in the y-z plane: a tall thin strip.
Batch makeStrip(const std::vector<uint32_t>& indices) {
    return {{makeVertex({0, -4, 16}), makeVertex({0, 4, 16}), makeVertex({0, 4, -16}), makeVertex({0, -4, -16})},
            indices};
}

TEST(Deform, WaveRunsAlongTheSumOfCoordinates) {
    Deform deform;
    deform.kind = DeformKind::Wave;
    deform.spread = 1.0f / 64;
    deform.wave = {WaveFunction::Triangle, 1, 4, 0.25f, 0.5f};
    Batch batch{{makeVertex({8, 4, 4}, {1, 0, 0})}, {}};
    DeformContext context;
    context.shaderTimeSeconds = 3;
    deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
    Wave wave = deform.wave;
    wave.phase += 16.0f / 64;
    EXPECT_FLOAT_EQ(batch.vertices[0].position.x, 8 + static_cast<float>(evaluateWave(wave, 3)));
    EXPECT_EQ(batch.vertices[0].position.y, 4);
}

TEST(Deform, WaveWithoutFrequencyIsOneOffsetForAll) {
    Deform deform;
    deform.kind = DeformKind::Wave;
    deform.spread = 0.1f;
    deform.wave = {WaveFunction::Sin, 3, 0, 0, 0};
    Batch batch{{makeVertex({0, 0, 0}), makeVertex({500, 0, 0})}, {}};
    deformVertices(makeMaterial(deform), {}, batch.vertices, batch.indices);
    EXPECT_EQ(batch.vertices[0].position.z, 3);
    EXPECT_EQ(batch.vertices[1].position.z, 3);
}

TEST(Deform, MoveAndItsTimeOffset) {
    Deform deform;
    deform.kind = DeformKind::Move;
    deform.move = {0, 0, 10};
    deform.wave = {WaveFunction::Sawtooth, 0, 1, 0, 1};
    Material material = makeMaterial(deform);
    material.timeOffsetSeconds = 2;
    Batch batch{{makeVertex({1, 2, 3})}, {}};
    DeformContext context;
    context.shaderTimeSeconds = 2.5;
    deformVertices(material, context, batch.vertices, batch.indices);
    EXPECT_FLOAT_EQ(batch.vertices[0].position.z, 8);
}

TEST(Deform, BulgeFollowsTheRawTextureCoordinate) {
    Deform deform;
    deform.kind = DeformKind::Bulge;
    deform.bulgeWidth = 3;
    deform.bulgeHeight = 5;
    deform.bulgeSpeed = 2;
    Batch batch{{makeVertex({0, 0, 0}, {0, 0, 1}, {0.25f, 0})}, {}};
    DeformContext context;
    context.sceneTimeMs = 1000;
    deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
    EXPECT_NEAR(batch.vertices[0].position.z, 5 * std::sin(0.75 + 2), 0.05);
}

TEST(Deform, NormalNoiseTurnsTheNormalOnly) {
    Deform deform;
    deform.kind = DeformKind::Normal;
    deform.wave.amplitude = 0.5f;
    deform.wave.frequency = 1;
    seedNoiseFromCRand();
    Batch batch{{makeVertex({1, 2, 3})}, {}};
    deformVertices(makeMaterial(deform), {}, batch.vertices, batch.indices);
    EXPECT_EQ(batch.vertices[0].position, vec3(1, 2, 3));
    EXPECT_NE(batch.vertices[0].normal, vec3(0, 0, 1));
    EXPECT_NEAR(glm::length(batch.vertices[0].normal), 1, 0.002f) << "fast normalise: 0.18 % at most";
}

TEST(Deform, AutoSpriteFacesTheView) {
    Deform deform;
    deform.kind = DeformKind::AutoSprite;
    Batch batch{{makeVertex({-8, -8, 0}), makeVertex({8, -8, 0}), makeVertex({8, 8, 0}), makeVertex({-8, 8, 0}),
                 makeVertex({0, 0, 99})}, // an incomplete fifth vertex
                {0, 1, 2, 0, 2, 3}};
    DeformContext context;
    context.axisScale = 2;
    deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
    ASSERT_EQ(batch.vertices.size(), 4u);
    EXPECT_EQ(batch.indices, (std::vector<uint32_t>{0, 1, 3, 3, 1, 2}));
    const float half = 0.707f * std::sqrt(128.0f) / 2;
    EXPECT_NEAR(glm::distance(batch.vertices[0].position, vec3(0, half, half)), 0, 1e-4f);
    EXPECT_EQ(batch.vertices[2].st, vec2(1, 1));
    EXPECT_EQ(batch.vertices[0].normal, vec3(-1, 0, 0));
}

TEST(Deform, NothingLeavesTheBoundsOfASprite) {
    std::mt19937 random(11);
    std::normal_distribution<float> any;
    for (int i = 0; i < 2000; ++i) {
        Deform deform;
        deform.kind = i % 2 == 0 ? DeformKind::AutoSprite : DeformKind::AutoSprite2;
        const vec3 centre = 100.0f * vec3(any(random), any(random), any(random));
        const vec3 right = glm::normalize(vec3(any(random), any(random), any(random)));
        const vec3 up = glm::normalize(glm::cross(right, vec3(any(random), any(random), any(random))));
        const vec3 x = right * std::abs(20 * any(random)), y = up * std::abs(20 * any(random));
        Batch batch{{makeVertex(centre - x - y), makeVertex(centre + x - y), makeVertex(centre + x + y),
                     makeVertex(centre - x + y)},
                    {0, 1, 2, 0, 2, 3}};
        if (i % 4 >= 2) batch.vertices[0].position += 30.0f * (x + y); // a map may have any four corners
        Bounds box;
        for (const Vertex& vertex : batch.vertices)
            box.add(vertex.position);
        const Bounds bounds = deformedBounds(makeMaterial(deform), box);
        DeformContext context;
        context.viewForward = glm::normalize(vec3(any(random), any(random), any(random)));
        context.viewLeft = glm::normalize(glm::cross(context.viewForward, vec3(any(random), any(random), any(random))));
        context.viewUp = glm::cross(context.viewForward, context.viewLeft);
        deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
        constexpr float kRoundingQu = 1e-3f;
        for (const Vertex& vertex : batch.vertices) {
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(vertex.position, bounds.mins - kRoundingQu)));
            EXPECT_TRUE(glm::all(glm::lessThanEqual(vertex.position, bounds.maxs + kRoundingQu)));
        }
    }
    Deform text;
    text.kind = DeformKind::Text;
    EXPECT_TRUE(deformedBounds(makeMaterial(text), Bounds{vec3(0), vec3(1)}).empty()) << "not known";
}

TEST(Deform, AutoSprite2TurnsAboutTheLongAxisAndObeysIndexOrder) {
    Deform deform;
    deform.kind = DeformKind::AutoSprite2;
    DeformContext context; // looking along y: the strip, edge-on, must turn into the x-z plane
    context.viewForward = {0, 1, 0};
    Batch proper = makeStrip({3, 0, 2, 2, 0, 1});
    deformVertices(makeMaterial(deform), context, proper.vertices, proper.indices);
    for (const Vertex& vertex : proper.vertices) {
        EXPECT_NEAR(std::abs(vertex.position.x), 4, 1e-4f);
        EXPECT_NEAR(vertex.position.y, 0, 1e-4f);
    }
    EXPECT_GT(proper.vertices[0].position.x * proper.vertices[3].position.x, 0) << "left stays on one side";
    Batch crossed = makeStrip({0, 1, 2, 0, 2, 3}); // both ends appear in order: the quad is crossed
    deformVertices(makeMaterial(deform), context, crossed.vertices, crossed.indices);
    EXPECT_LT(crossed.vertices[0].position.x * crossed.vertices[3].position.x, 0);
}

TEST(Deform, TextBecomesOneQuadACharacter) {
    Deform deform;
    deform.kind = DeformKind::Text;
    deform.text = 2;
    std::array<std::string, 8> text;
    text[2] = "A b";
    DeformContext context;
    context.text = &text;
    Batch batch{{makeVertex({0, -16, 8}, {1, 0, 0}), makeVertex({0, 16, 8}, {1, 0, 0}),
                 makeVertex({0, 16, -8}, {1, 0, 0}), makeVertex({0, -16, -8}, {1, 0, 0})},
                {0, 1, 2, 0, 2, 3}};
    deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
    ASSERT_EQ(batch.vertices.size(), 8u) << "the space has no quad";
    EXPECT_EQ(batch.indices.size(), 12u);
    EXPECT_EQ(batch.vertices[0].st, vec2('A' & 15, 'A' >> 4) / 16.0f);
    const auto centre = [&](size_t quad) {
        return (batch.vertices[quad * 4].position + batch.vertices[quad * 4 + 2].position) * 0.5f;
    };
    EXPECT_NEAR(glm::distance(centre(0), centre(1)), 2 * 2 * 0.75f * 8, 1e-3f) << "two character widths apart";
    EXPECT_NEAR(glm::length(centre(0) + centre(1)), 0, 1e-3f) << "centred on the quad";
}

TEST(Deform, ProjectionShadowFlattensAlongTheLight) {
    Deform deform;
    deform.kind = DeformKind::ProjectionShadow;
    DeformContext context;
    context.lightDirection = glm::normalize(vec3(1, 0, 1));
    context.heightAboveShadowPlane = 10; // the plane lies at z = -10 of the model
    Batch batch{{makeVertex({0, 0, 0}), makeVertex({5, 5, 20})}, {}};
    deformVertices(makeMaterial(deform), context, batch.vertices, batch.indices);
    EXPECT_NEAR(batch.vertices[0].position.z, -10, 1e-4f);
    EXPECT_NEAR(batch.vertices[1].position.z, -10, 1e-4f);
    EXPECT_NEAR(batch.vertices[1].position.x, 5 - 30, 1e-4f);
}

} // namespace
} // namespace q3rt::test
