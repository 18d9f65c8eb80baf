#include "accel/shader_traversal.hpp"

namespace q3rt {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/intersect.glsl"

struct BvhQuery {
    const TestScene* scene;
    TestHit hit;
};

BvhNode loadBvhNode(BVH_TABLE table, uint index) { return reinterpret_cast<const BvhNode*>(table)[index]; }
BvhTriangle loadBvhTriangle(BVH_TABLE table, uint index) { return reinterpret_cast<const BvhTriangle*>(table)[index]; }
BvhInstance loadBvhInstance(BvhQuery& query, uint item) {
    return query.scene->instances[query.scene->sceneOrder[item]];
}

bool onBvhTriangle(BvhQuery& query, const BvhInstance& instance, const BvhTriangle& triangle, const TriangleHit& test) {
    if (triangle.opaque == 0 && query.scene->accept && !query.scene->accept(instance.customIndex, triangle.number))
        return false;
    query.hit = {true, test.t, instance.customIndex, triangle.number, test.barycentric, test.frontFace};
    return true;
}

#include "trace/bvh_traverse.glsl"

} // namespace

BvhInstance TestScene::addModel(const Bvh& bvh, std::span<const vec3> positions, std::span<const uint8_t> opaque) {
    models.push_back({bvh.nodes, leafTriangles(bvh, positions, opaque)});
    BvhInstance instance{};
    instance.modelFromWorld[0] = {1, 0, 0, 0};
    instance.modelFromWorld[1] = {0, 1, 0, 0};
    instance.modelFromWorld[2] = {0, 0, 1, 0};
    instance.nodes = reinterpret_cast<uint64_t>(models.back().nodes.data());
    instance.triangles = reinterpret_cast<uint64_t>(models.back().triangles.data());
    instance.mask = 0xff;
    return instance;
}

void TestScene::buildScene(const std::vector<Bounds>& worldBounds) {
    const Bvh scene = buildSah(worldBounds, {.maxLeafItems = 1});
    sceneNodes = scene.nodes;
    sceneOrder = scene.order;
}

TestHit traceShader(const TestScene& scene, const vec3& origin, const vec3& direction, float tMin, float tMax,
                    uint32_t mask, bool anyHit) {
    BvhQuery query{&scene, {}};
    traverseBvh(reinterpret_cast<uint64_t>(scene.sceneNodes.data()), origin, direction, tMin, tMax, mask, anyHit,
                query);
    return query.hit;
}

} // namespace q3rt
