// 16 overlapping layers of add and alpha blends, sent in shuffled order, against the same layers sorted by distance and
// blended from back to front in double precision: at most 1/255 apart on every pixel.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 64, kHeight = 48; ///< pixels
constexpr size_t kLayerCount = 16;
const Camera kCamera{.eye = {-250, 3, 120}};
/// Layers nearer to each other than this along a ray, or rays nearer to an edge, are no question of order, qu.
constexpr double kClear = 0.05;

struct Layer {
    bool adds = false;
    vec3 corner[4];
    byte color[4] = {}; ///< alpha counts for blends
};

/// Quadrilaterals that face the eye more or less, each larger than a good part of the view.
std::vector<Layer> makeLayers(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::uniform_int_distribution<int> level(8, 40), alpha(40, 160), bright(30, 220);
    std::vector<Layer> layers;
    for (size_t i = 0; i < kLayerCount; ++i) {
        Layer layer;
        layer.adds = i % 2 == 0;
        const vec3 middle(-150.0f + 20.0f * static_cast<float>(i), 40 * uniform(random), 120 + 40 * uniform(random));
        const vec3 right = glm::normalize(vec3(0.6f * uniform(random), -1, 0.2f * uniform(random)));
        const vec3 up = glm::normalize(vec3(0.6f * uniform(random), 0.2f * uniform(random), 1));
        const float size = 60 + 5 * static_cast<float>(i);
        layer.corner[0] = middle - size * right + size * up;
        layer.corner[1] = middle + size * right + size * up;
        layer.corner[2] = middle + size * right - size * up;
        layer.corner[3] = middle - size * right - size * up;
        for (int c = 0; c < 3; ++c)
            layer.color[c] = static_cast<byte>(layer.adds ? level(random) : bright(random));
        layer.color[3] = static_cast<byte>(alpha(random));
        layers.push_back(layer);
    }
    return layers;
}

struct LayerHit {
    double t = 0;
    const Layer* layer = nullptr;
};

/// Distance of a ray to the two triangles that the engine makes of the quadrilateral; `nearEdge` if it is a close call.
std::optional<double> meetLayer(const Layer& layer, const dvec3& origin, const dvec3& direction, bool& nearEdge) {
    std::optional<double> found;
    for (const int second : {1, 2}) {
        const dvec3 a(layer.corner[0]), edge1 = dvec3(layer.corner[second]) - a,
                                        edge2 = dvec3(layer.corner[second + 1]) - a;
        const dvec3 normal = glm::cross(edge1, edge2);
        const double t = glm::dot(a - origin, normal) / glm::dot(direction, normal);
        const dvec3 p = origin + direction * t - a;
        const double area = glm::dot(normal, normal);
        const double u = glm::dot(glm::cross(p, edge2), normal) / area,
                     v = glm::dot(glm::cross(edge1, p), normal) / area;
        const double least =
            std::min({u, v, 1 - u - v}) * std::sqrt(area) / std::max(glm::length(edge1), glm::length(edge2));
        if (std::abs(least) < kClear) nearEdge = true;
        if (least >= 0 && t > 0) found = t;
    }
    return found;
}

/// Distance of the room's walls, for eyes inside.
double meetWall(const dvec3& origin, const dvec3& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double wall = (direction[axis] > 0 ? squareLightRoom::kRoom.maxs : squareLightRoom::kRoom.mins)[axis];
        if (direction[axis] != 0) nearest = std::min(nearest, (wall - origin[axis]) / direction[axis]);
    }
    return nearest;
}

/// The layers over what is behind them; nullopt where the order is a close call.
std::optional<dvec3> blendSorted(const std::vector<Layer>& layers, const dvec3& direction, const dvec3& behind,
                                 size_t& count) {
    std::vector<LayerHit> hits;
    bool nearEdge = false;
    const double wall = meetWall(dvec3(kCamera.eye), direction);
    for (const Layer& layer : layers) {
        const auto t = meetLayer(layer, dvec3(kCamera.eye), direction, nearEdge);
        if (t && std::abs(*t - wall) < kClear) return std::nullopt;
        if (t && *t < wall) hits.push_back({*t, &layer});
    }
    if (nearEdge) return std::nullopt;
    std::sort(hits.begin(), hits.end(), [](const LayerHit& a, const LayerHit& b) { return a.t > b.t; });
    for (size_t i = 1; i < hits.size(); ++i)
        if (hits[i - 1].t - hits[i].t < kClear) return std::nullopt;
    count = hits.size();
    dvec3 color = behind;
    for (const LayerHit& hit : hits) {
        const dvec3 own = dvec3(hit.layer->color[0], hit.layer->color[1], hit.layer->color[2]) / 255.0;
        const double alpha = hit.layer->color[3] / 255.0;
        color = hit.layer->adds ? color + own : color * (1 - alpha) + own * alpha;
    }
    return color;
}

class LayersTest : public testing::Test {
  protected:
    LayersTest() {
        m_game.addText("scripts/layers.shader", "layers/add\n{\n\tcull none\n\t{\n\t\tmap $whiteimage\n"
                                                "\t\tblendFunc add\n\t\trgbGen exactVertex\n\t}\n}\n"
                                                "layers/blend\n{\n\tcull none\n\t{\n\t\tmap $whiteimage\n"
                                                "\t\tblendFunc blend\n\t\trgbGen exactVertex\n\t\talphaGen vertex\n"
                                                "\t}\n}\n");
    }

    FloatImage draw(TraceHarness& harness, const std::vector<Layer>& layers) const {
        std::vector<TraceHarness::Quad> quads;
        for (const Layer& layer : layers) {
            TraceHarness::Quad quad{.shader = layer.adds ? m_add : m_blend};
            for (size_t k = 0; k < 4; ++k) {
                for (int axis = 0; axis < 3; ++axis)
                    quad.vertices[k].xyz[axis] = layer.corner[k][axis];
                std::copy(layer.color, layer.color + 4, quad.vertices[k].modulate);
            }
            quads.push_back(quad);
        }
        harness.setQuads(std::move(quads));
        return harness.radiance(kCamera, 1);
    }

    TestGame m_game;
    qhandle_t m_add = 0, m_blend = 0;
};

TEST_F(LayersTest, AnyOrderGivesTheSortedPicture) {
    TraceHarness harness(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    prepareHarness(harness, squareLightRoom::kName,
                   {{"rt_illumination", "0"}, {"rt_accumulate", "0"}, {"rt_taa", "0"}});
    harness.engine().enter([this](const refexport_t& module) {
        m_add = module.RegisterShader("layers/add");
        m_blend = module.RegisterShader("layers/blend");
    });
    ASSERT_TRUE(m_add > 0 && m_blend > 0);
    const FloatImage behind = draw(harness, {});
    size_t compared = 0, deepest = 0, threeOrMore = 0;
    double worst = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        std::vector<Layer> layers = makeLayers(seed);
        std::shuffle(layers.begin(), layers.end(), std::mt19937(seed));
        const FloatImage image = draw(harness, layers);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto p = 3 * static_cast<size_t>(y * kWidth + x);
                const dvec3 back(behind.rgb[p], behind.rgb[p + 1], behind.rgb[p + 2]);
                size_t count = 0;
                const auto expected =
                    blendSorted(layers, rayDirection(kCamera, kWidth, kHeight, x + 0.5, y + 0.5), back, count);
                if (!expected) continue;
                ++compared;
                deepest = std::max(deepest, count);
                if (count >= 3) ++threeOrMore;
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs((*expected)[c] - double(image.rgb[p + static_cast<size_t>(c)])));
            }
    }
    std::printf("%zu pixels of 8 pictures compared, %zu with three layers or more, the deepest %zu; worst difference "
                "%.4f / 255\n",
                compared, threeOrMore, deepest, 255 * worst);
    EXPECT_GT(compared, size_t{8 * kWidth * kHeight * 3 / 4});
    EXPECT_GE(deepest, 12u);
    EXPECT_LE(worst, 1.0 / 255);
}

} // namespace
} // namespace q3rt::test
