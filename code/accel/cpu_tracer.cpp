#include "accel/cpu_tracer.hpp"

namespace q3rt {
namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/intersect.glsl"

struct BvhQuery {
    const BvhInstance* instance;
    const CpuTracer* tracer;
    CpuHit hit;
    bool anyHit;
    bool found;
};

const vec4& loadBvhPlane(BVH_TABLE table, uint index, uint plane) {
    return reinterpret_cast<const BvhNode*>(table)[index].bounds[plane];
}
uint loadBvhChild(BVH_TABLE table, uint index, uint slot) {
    return reinterpret_cast<const BvhNode*>(table)[index].child[slot];
}
uint loadBvhGroups(BVH_TABLE table, uint index) { return reinterpret_cast<const BvhNode*>(table)[index].groups; }
float loadBvhReach(BVH_TABLE table) { return reinterpret_cast<const BvhNode*>(table)->reach; }
float loadBvhCoordinate(BVH_TABLE table, uint index, uint corner, uint axis) {
    return (&reinterpret_cast<const BvhTriangle*>(table)[index].corner0.x)[kBvhCornerWords * corner + axis];
}
BvhInstance loadBvhInstance(BvhQuery& query, uint) { return *query.instance; }

float onBvhTriangle(BvhQuery& query, uint, BVH_TABLE table, uint index, const TriangleHit& test, float tMax) {
    const BvhTriangle& triangle = reinterpret_cast<const BvhTriangle*>(table)[index];
    if ((triangle.flags & kBvhTriangleOpaque) == 0 && query.tracer->accept &&
        !query.tracer->accept(triangle.number, test.barycentric))
        return tMax;
    query.hit = {test.t, triangle.number, test.barycentric, test.frontFace};
    query.found = true;
    return query.anyHit ? kBvhFound : test.t;
}

constexpr bool kBvhDescends = false;
#include "trace/bvh_traverse.glsl"

uint64_t addressOf(const BvhNode& node) { return reinterpret_cast<uint64_t>(&node); }

} // namespace

CpuTracer::CpuTracer(std::span<const vec3> positions, std::span<const uint8_t> opaque, const BvhBuildSettings& settings)
    : m_bvh(buildSah(triangleBounds(positions), settings)) {
    std::vector<TriangleLabel> labels;
    for (uint32_t i = 0; i < opaque.size(); ++i)
        labels.push_back({i, opaque[i] ? kBvhTriangleOpaque : 0});
    m_triangles = leafTriangles(m_bvh, positions, labels);
    m_instance = instanceInPlace(reinterpret_cast<uint64_t>(m_bvh.nodes.data()),
                                 reinterpret_cast<uint64_t>(m_triangles.data()), 1);
    m_scene = buildSah({&m_bvh.bounds, 1}, {.maxLeafItems = 1});
}

bool CpuTracer::closest(const vec3& origin, const vec3& direction, float tMin, float tMax, CpuHit& hit) const {
    BvhQuery query{&m_instance, this, {}, false, false};
    traverseBvh(addressOf(m_scene.nodes[0]), origin, direction, tMin, tMax, 1, kBvhSolidGroup, query);
    hit = query.hit;
    return query.found;
}

bool CpuTracer::occluded(const vec3& origin, const vec3& direction, float tMax) const {
    BvhQuery query{&m_instance, this, {}, true, false};
    traverseBvh(addressOf(m_scene.nodes[0]), origin, direction, 0, tMax, 1, kBvhSolidGroup, query);
    return query.found;
}

} // namespace q3rt
