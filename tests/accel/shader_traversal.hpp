#pragma once
// The traversal shader itself, compiled as C++: what the tests check is the text that the device runs.

#include <functional>
#include <vector>

#include "accel/bvh.hpp"

namespace q3rt {

/// Trees and instances as the device has them.
struct TestScene {
    std::vector<BvhNode> nodes;
    std::vector<BvhTriangle> triangles;
    std::vector<BvhInstance> instances;
    std::vector<uint32_t> instanceOrder; ///< leaf item of the scene tree -> instance
    uint32_t root = 0;
    std::function<bool(uint32_t geometry, uint32_t primitive)> accept;

    /// Appends a model's tree; returns an instance of it without a transform.
    BvhInstance addModel(const Bvh& bvh, const TriangleSource& source);
    /// Builds the scene tree over the instances (their model bounds given in the same order).
    void buildScene(const std::vector<Bounds>& worldBounds);
};

struct TestHit {
    bool hit = false;
    float t = 0;
    uint32_t customIndex = 0, geometry = 0, primitive = 0;
    vec2 barycentric{0};
    bool frontFace = false;
};

TestHit traceShader(const TestScene& scene, const vec3& origin, const vec3& direction, float tMin, float tMax,
                    uint32_t mask = 0xff, bool anyHit = false);

} // namespace q3rt
