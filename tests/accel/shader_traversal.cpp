#include "accel/shader_traversal.hpp"

namespace q3rt {
namespace {

const TestScene* currentScene = nullptr;

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

BvhNode loadBvhNode(uint index) { return currentScene->nodes[index]; }
BvhTriangle loadBvhTriangle(uint index) { return currentScene->triangles[index]; }
BvhInstance loadBvhInstance(uint index) { return currentScene->instances[index]; }
uint loadBvhInstanceIndex(uint item) { return currentScene->instanceOrder[item]; }
bool acceptHit(uint, uint geometry, uint primitive, vec2, float) {
    return !currentScene->accept || currentScene->accept(geometry, primitive);
}

#include "lib/intersect.glsl"
#include "trace/bvh_traverse.glsl"

} // namespace

BvhInstance TestScene::addModel(const Bvh& bvh, const TriangleSource& source) {
    BvhInstance instance{};
    instance.modelFromWorld[0] = {1, 0, 0, 0};
    instance.modelFromWorld[1] = {0, 1, 0, 0};
    instance.modelFromWorld[2] = {0, 0, 1, 0};
    instance.root = static_cast<uint32_t>(nodes.size());
    instance.firstTriangle = static_cast<uint32_t>(triangles.size());
    instance.mask = 0xff;
    for (BvhNode node : bvh.nodes) {
        if (!(node.left & kBvhLeafBit)) node.left += instance.root;
        if (!(node.right & kBvhLeafBit)) node.right += instance.root;
        nodes.push_back(node);
    }
    for (const BvhTriangle& triangle : leafTriangles(bvh, source))
        triangles.push_back(triangle);
    return instance;
}

void TestScene::buildScene(const std::vector<Bounds>& worldBounds) {
    const Bvh scene = buildSah(worldBounds, {.maxLeafItems = 1});
    root = static_cast<uint32_t>(nodes.size());
    for (BvhNode node : scene.nodes) {
        if (!(node.left & kBvhLeafBit)) node.left += root;
        if (!(node.right & kBvhLeafBit)) node.right += root;
        nodes.push_back(node);
    }
    instanceOrder = scene.order;
}

TestHit traceShader(const TestScene& scene, const vec3& origin, const vec3& direction, float tMin, float tMax,
                    uint32_t mask, bool anyHit) {
    currentScene = &scene;
    const BvhHit hit = traverseBvh(scene.root, origin, direction, tMin, tMax, mask, anyHit);
    return {hit.instance != kBvhNoInstance,
            hit.t,
            hit.customIndex,
            hit.geometry,
            hit.primitive,
            hit.barycentric,
            hit.frontFace};
}

} // namespace q3rt
