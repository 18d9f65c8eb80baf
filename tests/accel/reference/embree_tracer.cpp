#include "accel/reference/embree_tracer.hpp"

#include <algorithm>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace q3rt::test {

namespace {

RTCRay makeRay(const vec3& o, const vec3& d, float tMax) {
    return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, tMax, 0xffffffffu, 0, 0};
}

} // namespace

struct EmbreeTracer::Handles {
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene scene = rtcNewScene(device);
    ~Handles() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
};

EmbreeTracer::EmbreeTracer(std::span<const vec3> positions)
    : m_handles(std::make_unique<Handles>()) {
    RTCScene scene = m_handles->scene;
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(m_handles->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                sizeof(vec3), positions.size()));
    std::copy(positions.begin(), positions.end(), vertices);
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), positions.size() / 3));
    for (uint32_t i = 0; i < positions.size(); ++i)
        indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
}

EmbreeTracer::~EmbreeTracer() = default;

EmbreeHit EmbreeTracer::closest(const vec3& origin, const vec3& direction, float tMax) const {
    RTCRayHit ray{};
    ray.ray = makeRay(origin, direction, tMax);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if __has_include(<embree4/rtcore.h>)
    rtcIntersect1(m_handles->scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(m_handles->scene, &context, &ray);
#endif
    return {ray.hit.geomID != RTC_INVALID_GEOMETRY_ID, ray.ray.tfar, ray.hit.primID};
}

bool EmbreeTracer::occluded(const vec3& origin, const vec3& direction, float tMax) const {
    RTCRay ray = makeRay(origin, direction, tMax);
#if __has_include(<embree4/rtcore.h>)
    rtcOccluded1(m_handles->scene, &ray);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(m_handles->scene, &context, &ray);
#endif
    return ray.tfar < 0;
}

} // namespace q3rt::test
