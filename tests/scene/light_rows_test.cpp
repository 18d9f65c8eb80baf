// The table of lights by cluster and normal: nothing that can give light is left out, and what is drawn at random has
// the probability that its weight says.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "scene/alias_table.hpp"
#include "scene/bsp_clip.hpp"
#include "scene/light_rows.hpp"
#include "scene_fixture.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

TEST(AliasTable, HasTheGivenProbabilities) {
    std::mt19937 random(3);
    std::lognormal_distribution<double> size(0, 4);
    size_t checked = 0;
    for (size_t count = 1; count <= 300; count += 7) {
        std::vector<double> weights(count);
        for (double& weight : weights)
            weight = random() % 5 == 0 ? 0 : size(random);
        weights[count / 2] = 1;
        double sum = 0;
        for (const double weight : weights)
            sum += weight;
        const std::vector<AliasColumn> columns = buildAliasTable(weights);
        const std::vector<double> probability = aliasProbabilities(columns);
        for (size_t i = 0; i < count; ++i, ++checked) {
            ASSERT_NEAR(probability[i], weights[i] / sum, 1e-6);
            ASSERT_LT(columns[i].other, count);
            ASSERT_EQ(probability[i] == 0, weights[i] == 0);
        }
    }
    EXPECT_GT(checked, 5000u);
}

TEST(BspClip, BoxesHoldEveryPointOfTheirCluster) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    TinyImageFiles tiny(*files);
    SceneLibraries libraries(tiny);
    const auto world = loadWorld(tiny, "maps/oa_spirit3.bsp", libraries.materials, WorldSettings{});
    const std::vector<Bounds> boxes = boundClusters(world->bsp);
    std::mt19937 random(4);
    const auto inside = [&](int axis) {
        return std::uniform_real_distribution<float>(world->bounds.mins[axis], world->bounds.maxs[axis])(random);
    };
    size_t found = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 point(inside(0), inside(1), inside(2));
        const int cluster = world->clusterOf(point);
        if (cluster < 0) continue;
        ++found;
        const Bounds& box = boxes[static_cast<size_t>(cluster)];
        ASSERT_TRUE(glm::all(glm::lessThanEqual(box.mins, point)) && glm::all(glm::lessThanEqual(point, box.maxs)));
    }
    EXPECT_GT(found, 1000u);
}

/// Clusters of random points of a light, each moved off its plane both ways: what a wrong table would miss.
std::set<int> sampleClusters(const World& world, const TriangleLight& light, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    std::set<int> clusters;
    for (int i = 0; i < 64; ++i) {
        const float root = std::sqrt(unit(random)), v = unit(random);
        const vec3 point =
            light.corner[0] * (1 - root) + light.corner[1] * (root * (1 - v)) + light.corner[2] * (root * v);
        for (const float off : {-0.05f, 0.0f, 0.05f}) {
            const int cluster = world.clusterOf(point + light.normal * off);
            if (cluster >= 0) clusters.insert(cluster);
        }
    }
    return clusters;
}

/// Checks every pair of light and row of a map; returns the share of all pairs that the table lists.
double checkTable(FileSource& files, const std::string& map) {
    SceneLibraries libraries(files);
    const auto world = loadWorld(files, "maps/" + map + ".bsp", libraries.materials, WorldSettings{});
    const LightSet lights = extractLights(*world, libraries.materials);
    const LightRows table =
        buildLightRows(*world, libraries.materials, describeRowLights(lights.triangles, lights.points));
    const auto clusters = static_cast<size_t>(world->bsp.clusterCount);
    EXPECT_EQ(table.rows.size(), clusters * kNormalClassCount + 1);
    EXPECT_EQ(table.outside().count, lights.triangles.size() + lights.points.size()) << "outside sees all";
    std::vector<std::set<uint32_t>> listed(clusters);
    size_t pairs = 0, facing = 0;
    for (size_t row = 0; row < clusters; ++row) {
        const RtLightRow& of = table.ofCluster(row);
        for (uint32_t i = 0; i < of.count; ++i)
            listed[row].insert(table.entries[of.first + i].light);
        pairs += of.count;
        facing += of.facing;
    }
    constexpr unsigned kSeed = 1;
    std::mt19937 random(kSeed);
    size_t required = 0, missing = 0;
    for (uint32_t i = 0; i < lights.triangles.size(); ++i) {
        const std::set<int> touched = sampleClusters(*world, lights.triangles[i], random);
        for (size_t row = 0; row < clusters; ++row) {
            const bool seen = std::any_of(touched.begin(), touched.end(), [&](int cluster) {
                return world->bsp.clusterVisible(static_cast<int>(row), cluster);
            });
            required += seen;
            missing += seen && !listed[row].contains(i);
        }
    }
    EXPECT_EQ(missing, 0u) << map << ", seed " << kSeed;
    EXPECT_GT(required, 1000u);
    const size_t all = lights.triangles.size() * clusters;
    std::printf("%s: %zu lights, %zu clusters; %zu pairs of light and row must be listed, %zu of %zu are, %zu of them "
                "face; %zu entries\n",
                map.c_str(), lights.triangles.size(), clusters, required, pairs, all, facing, table.entries.size());
    return static_cast<double>(pairs) / static_cast<double>(all);
}

TEST(LightRows, NeverMissALightThatARowCanSee) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    TinyImageFiles tiny(*files);
    checkTable(tiny, "fan");
    EXPECT_LT(checkTable(tiny, "oa_spirit3"), 0.5) << "on a map of many rooms the table culls";
}

/// Two clusters left and right of x = 0 that see themselves only, and a third one nowhere.
class SmallWorld : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    World m_world;
    SmallWorld() {
        m_libraries = std::make_unique<SceneLibraries>(m_files);
        m_world.bsp.planes.push_back({vec3(1, 0, 0), 0});
        m_world.bsp.nodes.push_back({.plane = 0, .children = {-1, -2}});
        m_world.bsp.leafs.resize(2);
        m_world.bsp.leafs[0].cluster = 0;
        m_world.bsp.leafs[1].cluster = 1;
        m_world.bsp.clusterCount = 3;
        m_world.bsp.clusterRowBytes = 1;
        m_world.bsp.visibility = {1, 2, 4};
    }
    static TriangleLight makeLight(const vec3& at, const vec3& normal) {
        TriangleLight light;
        const vec3 side = glm::cross(vec3(0, 0, 1), normal);
        light.corner[0] = at;
        light.corner[1] = at + vec3(0, 0, 8);
        light.corner[2] = at + side * 8.0f;
        light.radiance = vec3(1);
        EXPECT_TRUE(measureTriangle(light));
        EXPECT_EQ(light.normal, normal);
        return light;
    }
    LightRows build(const std::vector<TriangleLight>& lights) const {
        return buildLightRows(m_world, m_libraries->materials, describeRowLights(lights, {}));
    }
};

TEST_F(SmallWorld, LightsAreListedWhereTheyAre) {
    const LightRows rows = build({makeLight({20, 0, 0}, {0, 1, 0}), makeLight({-20, 0, 0}, {0, 1, 0})});
    EXPECT_EQ(rows.ofCluster(0).count, 1u);
    EXPECT_EQ(rows.ofCluster(1).count, 1u);
    EXPECT_EQ(rows.ofCluster(2).count, 0u);
    EXPECT_EQ(rows.outside().count, 2u);
    EXPECT_EQ(rows.entries[rows.ofCluster(1).first].light, 1u);
}

TEST_F(SmallWorld, ALightThatTurnsItsBackDoesNotFace) {
    // Both touch the dividing plane, hence both clusters; one shines to the right, one to the left.
    const LightRows rows = build({makeLight({0, 0, 0}, {1, 0, 0}), makeLight({0, 0, 0}, {-1, 0, 0})});
    for (const size_t cluster : {0u, 1u}) {
        EXPECT_EQ(rows.ofCluster(cluster).count, 2u);
        ASSERT_EQ(rows.ofCluster(cluster).facing, 1u);
        EXPECT_EQ(rows.entries[rows.ofCluster(cluster).first].light, cluster);
        EXPECT_EQ(rows.entries[rows.ofCluster(cluster).first].weight, 1.0f);
    }
    EXPECT_EQ(rows.outside().facing, 2u);
}

TEST_F(SmallWorld, ALightThatIsTooFaintByThenDoesNotFace) {
    m_world.bsp.visibility = {3, 3, 4};
    PointLight light;
    light.origin = vec3(20, 0, 0);
    light.intensity = vec3(100, 400, 0);
    for (const auto& [faintest, faces] : {std::pair(0.0f, 1u), {0.9f, 1u}, {1.1f, 0u}}) { // 400 / 20^2 = 1 at the plane
        light.faintest = faintest;
        const LightRows rows =
            buildLightRows(m_world, m_libraries->materials, describeRowLights({}, std::span(&light, 1)));
        EXPECT_EQ(rows.ofCluster(0).facing, 1u);
        EXPECT_EQ(rows.ofCluster(1).count, 1u);
        EXPECT_EQ(rows.ofCluster(1).facing, faces) << faintest;
    }
}

TEST_F(SmallWorld, ATriangleThatIsTooFaintByThenDoesNotFace) {
    m_world.bsp.visibility = {3, 3, 4};
    TriangleLight light = makeLight({100, 0, 0}, {-1, 0, 0});
    light.radiance = vec3(100, 10, 1);
    const float at = glm::dot(light.corner[0] + light.corner[1] + light.corner[2], vec3(1, 0, 0)) / 3;
    const float atPlane = 100 * light.areaQu2 / (at * at); // along its normal
    for (const auto& [share, faces] : {std::pair(0.0f, 1u), {0.9f, 1u}, {1.1f, 0u}}) {
        light.faintest = share * atPlane;
        const LightRows rows = build({light});
        EXPECT_EQ(rows.ofCluster(0).facing, 1u);
        EXPECT_EQ(rows.ofCluster(1).facing, faces) << share;
        light.reachQu = 50;
        EXPECT_EQ(build({light}).ofCluster(1).facing, 1u) << "it waves";
        light.reachQu = 0;
    }
}

TEST_F(SmallWorld, WhatMovesIsEverywhere) {
    TriangleLight mover = makeLight({20, 0, 0}, {0, 1, 0}), lava = makeLight({20, 0, 0}, {0, 1, 0});
    mover.bspModel = 1;
    lava.reachQu = 30;
    const LightRows rows = build({mover, lava});
    EXPECT_EQ(rows.ofCluster(0).facing, 2u);
    EXPECT_EQ(rows.ofCluster(1).facing, 2u) << "the lava's waves reach over the plane";
    EXPECT_EQ(rows.ofCluster(2).facing, 1u);
}

} // namespace
} // namespace q3rt::test
