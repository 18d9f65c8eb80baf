#include "accel/shader_traversal.hpp"

namespace q3rt {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/intersect.glsl"

// By the ray under way.
uint64_t visitCount = 0; // of nodes
uint64_t coordinateCount = 0;
constexpr uint64_t kCoordinatesOfTest = 9;

struct BvhQuery {
    const TestScene* scene;
    bool anyHit;
    TestHit hit;
};

const vec4& loadBvhPlane(BVH_TABLE table, uint index, uint plane) {
    return reinterpret_cast<const BvhNode*>(table)[index].bounds[plane];
}
uint loadBvhChild(BVH_TABLE table, uint index, uint slot) {
    return reinterpret_cast<const BvhNode*>(table)[index].child[slot];
}
uint loadBvhGroups(BVH_TABLE table, uint index) {
    ++visitCount;
    return reinterpret_cast<const BvhNode*>(table)[index].groups;
}
float loadBvhReach(BVH_TABLE table) { return reinterpret_cast<const BvhNode*>(table)->reach; }
float loadBvhCoordinate(BVH_TABLE table, uint index, uint corner, uint axis) {
    ++coordinateCount;
    return (&reinterpret_cast<const BvhTriangle*>(table)[index].corner0.x)[kBvhCornerWords * corner + axis];
}
BvhInstance loadBvhInstance(BvhQuery& query, uint item) {
    return query.scene->instances[query.scene->sceneOrder[item]];
}

float onBvhTriangle(BvhQuery& query, uint item, BVH_TABLE table, uint index, const TriangleHit& test, float tMax) {
    const BvhTriangle& triangle = reinterpret_cast<const BvhTriangle*>(table)[index];
    const BvhInstance& instance = query.scene->instances[query.scene->sceneOrder[item]];
    if ((triangle.flags & kBvhTriangleOpaque) == 0 && query.scene->accept &&
        !query.scene->accept(instance.customIndex, triangle.number))
        return tMax;
    query.hit = {true, test.t, instance.customIndex, triangle.number, test.barycentric, test.frontFace};
    return query.anyHit ? kBvhFound : test.t;
}

constexpr bool kBvhDescends = false;
#include "trace/bvh_traverse.glsl"

} // namespace

BvhInstance TestScene::addModel(const Bvh& bvh, std::span<const vec3> positions,
                                std::span<const TriangleLabel> labels) {
    models.push_back({bvh.nodes, leafTriangles(bvh, positions, labels)});
    BvhInstance instance = instanceInPlace(reinterpret_cast<uint64_t>(models.back().nodes.data()),
                                           reinterpret_cast<uint64_t>(models.back().triangles.data()), 0xff);
    instance.mask &= ~kBvhInPlace; // tests move it
    return instance;
}

uint64_t TestScene::mostVisits() const {
    uint64_t sum = sceneNodes.size();
    for (const BvhInstance& instance : instances)
        for (const Model& model : models)
            if (reinterpret_cast<uint64_t>(model.nodes.data()) == instance.nodes) sum += model.nodes.size();
    return sum;
}

void TestScene::buildScene(const std::vector<Bounds>& worldBounds) {
    const Bvh scene = buildSah(worldBounds, {.maxLeafItems = 1});
    sceneNodes = scene.nodes;
    sceneOrder = scene.order;
}

TestHit traceShader(const TestScene& scene, const vec3& origin, const vec3& direction, float tMin, float tMax,
                    uint32_t mask, bool anyHit, uint32_t groups) {
    BvhQuery query{&scene, anyHit, {}};
    visitCount = 0;
    coordinateCount = 0;
    traverseBvh(reinterpret_cast<uint64_t>(scene.sceneNodes.data()), origin, direction, tMin, tMax, mask, groups,
                query);
    query.hit.visitCount = visitCount;
    query.hit.testCount = coordinateCount / kCoordinatesOfTest;
    return query.hit;
}

} // namespace q3rt
