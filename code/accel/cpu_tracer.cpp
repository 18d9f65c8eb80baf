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
    bool found;
};

BvhNode loadBvhNode(BVH_TABLE table, uint index) { return reinterpret_cast<const BvhNode*>(table)[index]; }
BvhTriangle loadBvhTriangle(BVH_TABLE table, uint index) { return reinterpret_cast<const BvhTriangle*>(table)[index]; }
BvhInstance loadBvhInstance(BvhQuery& query, uint) { return *query.instance; }

bool onBvhTriangle(BvhQuery& query, const BvhInstance&, const BvhTriangle& triangle, const TriangleHit& test) {
    if (triangle.opaque == 0 && query.tracer->accept && !query.tracer->accept(triangle.number, test.barycentric))
        return false;
    query.hit = {test.t, triangle.number, test.barycentric, test.frontFace};
    query.found = true;
    return true;
}

#include "trace/bvh_traverse.glsl"

uint64_t addressOf(const BvhNode& node) { return reinterpret_cast<uint64_t>(&node); }

} // namespace

CpuTracer::CpuTracer(std::span<const vec3> positions, std::span<const uint8_t> opaque, const BvhBuildSettings& settings)
    : m_bvh(buildSah(triangleBounds(positions), settings))
    , m_triangles(leafTriangles(m_bvh, positions, opaque)) {
    m_instance.modelFromWorld[0] = {1, 0, 0, 0};
    m_instance.modelFromWorld[1] = {0, 1, 0, 0};
    m_instance.modelFromWorld[2] = {0, 0, 1, 0};
    m_instance.nodes = reinterpret_cast<uint64_t>(m_bvh.nodes.data());
    m_instance.triangles = reinterpret_cast<uint64_t>(m_triangles.data());
    m_instance.mask = 1;
    m_sceneRoot.leftMins = m_bvh.bounds.mins;
    m_sceneRoot.leftMaxs = m_bvh.bounds.maxs;
    m_sceneRoot.left = kBvhLeafBit;
    m_sceneRoot.leftCount = m_bvh.order.empty() ? 0 : 1;
    m_sceneRoot.rightMins = vec3(std::numeric_limits<float>::max());
    m_sceneRoot.rightMaxs = -m_sceneRoot.rightMins;
    m_sceneRoot.right = kBvhLeafBit;
}

bool CpuTracer::closest(const vec3& origin, const vec3& direction, float tMin, float tMax, CpuHit& hit) const {
    BvhQuery query{&m_instance, this, {}, false};
    traverseBvh(addressOf(m_sceneRoot), origin, direction, tMin, tMax, 1, false, query);
    hit = query.hit;
    return query.found;
}

bool CpuTracer::occluded(const vec3& origin, const vec3& direction, float tMax) const {
    BvhQuery query{&m_instance, this, {}, false};
    traverseBvh(addressOf(m_sceneRoot), origin, direction, 0, tMax, 1, true, query);
    return query.found;
}

} // namespace q3rt
