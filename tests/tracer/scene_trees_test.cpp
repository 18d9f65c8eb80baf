// Trees of bad input: what has no place is left out, whatever else is there is kept.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "renderer_rt/scene_trees.hpp"

namespace q3rt {
namespace {

TreeInstance placedAt(float x) {
    TreeInstance instance;
    instance.tree.bounds = {vec3(-1), vec3(1)};
    instance.worldFromModel[3].x = x;
    instance.customIndex = static_cast<uint32_t>(x);
    instance.masks[0] = 1;
    return instance;
}

TEST(SceneTrees, InstancesWithoutAPlaceAreLeftOut) {
    std::vector<TreeInstance> instances(6, placedAt(7));
    instances[0].worldFromModel[2] = vec4(0); // flat
    instances[1].worldFromModel = mat4(0.0f); // a point, and no affine map
    instances[2].worldFromModel[0].x = NAN;
    instances[3].worldFromModel[3].y = INFINITY; // at no place
    instances[4].tree.bounds = {};               // an empty model
    const SceneTreeData tree = buildSceneTree(instances);
    ASSERT_EQ(tree.instances.size(), 1u);
    EXPECT_EQ(tree.instances[0].customIndex, 7u);
    EXPECT_TRUE(buildSceneTree({}).instances.empty());
}

TEST(SceneTrees, FiveThousandInstancesAreAllThere) {
    std::vector<TreeInstance> instances;
    for (int i = 0; i < 5000; ++i)
        instances.push_back(placedAt(static_cast<float>(i)));
    const SceneTreeData tree = buildSceneTree(instances);
    std::vector<bool> seen(instances.size(), false);
    for (const BvhInstance& instance : tree.instances)
        seen[instance.customIndex] = true;
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 5000);
}

TEST(SceneTrees, ModelsOfNothingOneTriangleAndNoNumbers) {
    EXPECT_TRUE(buildTree({}, true).bvh.bounds.empty());
    std::vector<Vertex> vertices(6);
    vertices[1].position = {1, 0, 0};
    vertices[2].position = {0, 1, 0};
    vertices[4].position = vec3(NAN);
    const std::vector<uint32_t> one{0, 1, 2}, two{0, 1, 2, 3, 4, 5};
    for (const bool lasting : {true, false}) {
        const TreePart good{vertices, one, SurfaceClass::Solid}, odd{vertices, two, SurfaceClass::Solid};
        EXPECT_EQ(buildTree({&good, 1}, lasting).triangles.size(), 1u);
        const TreeData tree = buildTree({&odd, 1}, lasting);
        EXPECT_EQ(tree.triangles.size(), 1u);
        EXPECT_EQ(tree.bvh.rejectedCount, 1u);
    }
}

} // namespace
} // namespace q3rt
