// Vertices of an MD3 mesh, all at once and a few of them, are the same.

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "scene/animated_mesh.hpp"

namespace q3rt::test {
namespace {

Md3 makeRandomMd3(size_t frames, size_t vertices) {
    std::mt19937 random(3);
    const auto number = [&](int least, int greatest) { return std::uniform_int_distribution(least, greatest)(random); };
    Md3 model;
    model.frames.resize(frames);
    Md3Surface& surface = model.surfaces.emplace_back();
    surface.vertexCount = vertices;
    for (size_t i = 0; i < vertices; ++i)
        surface.st.emplace_back(number(0, 100), number(0, 100));
    for (size_t i = 0; i < frames * vertices; ++i) {
        Md3Vertex& vertex = surface.vertices.emplace_back();
        for (int16_t& step : vertex.steps)
            step = static_cast<int16_t>(number(-32768, 32767));
        vertex.normalCode = static_cast<uint16_t>(number(0, 65535));
    }
    return model;
}

TEST(Md3Mesh, SomeVerticesAreThoseOfAll) {
    constexpr size_t kVertices = 37;
    const auto mesh = makeMd3Mesh(makeRandomMd3(2, kVertices));
    for (const FramePair& frames : {FramePair{1, 1, 0}, FramePair{1, 0, 0.3f}, FramePair{0, 1, 1.5f}}) {
        std::vector<Vertex> all, some;
        mesh->appendVertices(0, frames, {}, all);
        std::vector<Float4> positions;
        ASSERT_TRUE(mesh->findPositions(0, frames, positions));
        ASSERT_EQ(positions.size(), kVertices);
        const std::vector<uint32_t> numbers = {36, 0, 17, 17, 5};
        mesh->appendSome(0, frames, numbers, some);
        ASSERT_EQ(some.size(), numbers.size());
        for (size_t i = 0; i < kVertices; ++i)
            EXPECT_EQ(all[i].position, vec3(positions[i][0], positions[i][1], positions[i][2]));
        for (size_t i = 0; i < numbers.size(); ++i)
            EXPECT_EQ(std::memcmp(&some[i], &all[numbers[i]], sizeof(Vertex)), 0);
    }
}

} // namespace
} // namespace q3rt::test
