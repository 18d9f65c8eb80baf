#pragma once
// The traversal shader itself, compiled as C++: what the tests check is the text that the device runs.

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "accel/bvh.hpp"

namespace q3rt {

/// Trees and instances as the device has them.
struct TestScene {
    /// No ray visits more nodes: each of the scene's, and of each instance's, at most once.
    uint64_t mostVisits() const;
    struct Model {
        std::vector<BvhNode> nodes;
        std::vector<BvhTriangle> triangles;
    };
    std::deque<Model> models; ///< addresses stay: instances point into them
    std::vector<BvhInstance> instances;
    std::vector<BvhNode> sceneNodes;
    std::vector<uint32_t> sceneOrder;                                    ///< leaf item of the scene tree -> instance
    std::function<bool(uint32_t customIndex, uint32_t triangle)> accept; ///< asked for triangles that are not opaque

    /// Returns an instance of the tree without a transform.
    BvhInstance addModel(const Bvh& bvh, std::span<const vec3> positions, std::span<const TriangleLabel> labels = {});
    /// Builds the scene tree over the instances (their world bounds in the same order).
    void buildScene(const std::vector<Bounds>& worldBounds);
};

struct TestHit {
    bool hit = false;
    float t = 0;
    uint32_t customIndex = 0, triangle = 0;
    vec2 barycentric{0};
    bool frontFace = false;
    uint64_t visitCount = 0; ///< of nodes of both levels
    uint64_t testCount = 0;  ///< of triangles
};

TestHit traceShader(const TestScene& scene, const vec3& origin, const vec3& direction, float tMin, float tMax,
                    uint32_t mask = 0xff, bool anyHit = false, uint32_t groups = kBvhSolidGroup);

} // namespace q3rt
