#pragma once
// Bounding volume hierarchies over boxes: the builders of our own trees (static parts and models once at load, the
// scene over instances each frame). All give the same nodes of four children (shaders/shared/bvh.h), collapsed from a
// binary tree (bvh_collapse.hpp); they differ in time and quality.
//
//   buildSah      binned surface-area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//                 Hierarchies")
//   buildMorton   sort by 30-bit Morton code, split at the highest differing bit (Lauterbach et al. 2009, "Fast BVH
//                 Construction on GPUs")
//   buildPairing  plain closest-centroid pairing (Park and Baek 2021, "A Shader-Based Ray Tracing Engine", section
//                 3.1): the benchmark's baseline only
//
// Items whose box is not finite, or reaches beyond kBvhFarthest, are left out of the tree and counted. Every path is at
// most kBvhMaxDepth long.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vector.hpp"
#include "shaders/shared/bvh.h"

namespace q3rt {

/// qu. Far beyond any content, and so near that no slab of a ray overflows (shaders/lib/intersect.glsl).
inline constexpr float kBvhFarthest = 1e12f;

struct Bvh {
    std::vector<BvhNode> nodes;  ///< [0] the root; never empty; a parent stands before its children
    std::vector<uint32_t> order; ///< leaf item -> input item
    Bounds bounds;               ///< of all items in the tree; empty if none
    uint32_t rejectedCount = 0;
    float builtCost = 0; ///< surfaceAreaCost() when it was built
};

struct BvhBuildSettings {
    uint32_t maxLeafItems = 4; ///< at most kBvhMostLeafItems
    /// Cost of a node visit in units of one item test; measured by the benchmark `bvh_build`.
    float traversalCost = 1.0f;
    unsigned threadCount = 1;
    /// buildSah: moves subtrees to better places (bvh_reinsert.hpp). Twice the time, an eighth fewer nodes a ray.
    bool reinsert = false;
    /// kBvhSolidGroup and kBvhOtherGroup bits of each item; empty: all are in both.
    std::span<const uint8_t> groups;
};

/// Items per second matters here: boxes are given once, no callbacks.
Bvh buildSah(std::span<const Bounds> items, const BvhBuildSettings& settings = {});
Bvh buildMorton(std::span<const Bounds> items, const BvhBuildSettings& settings = {});
/// O(n^2) a level.
Bvh buildPairing(std::span<const Bounds> items);

/// Recomputes all boxes for triangles that moved, same topology. `triangles` in leaf order (leafTriangles()). Returns
/// the surface-area cost now / when it was built: a caller rebuilds when it has grown too much. Nothing if a corner is
/// not finite or beyond kBvhFarthest: only a builder can leave triangles out.
std::optional<float> refit(Bvh& bvh, std::span<const BvhTriangle> triangles);

/// Expected cost of a random ray that hits the root: sum over children of area(child) / area(root) x (visit or item
/// tests).
float surfaceAreaCost(const Bvh& bvh, float traversalCost = 1.0f);
/// Longest path from the root to a leaf, counted in nodes.
uint32_t depthOf(const Bvh& bvh);
/// Box of a child, rounded outwards; empty if there is none.
Bounds childBounds(const BvhNode& node, uint32_t slot);

/// Boxes of triangles; positions 3 a triangle.
std::vector<Bounds> triangleBounds(std::span<const vec3> positions);

/// What a hit of a triangle tells.
struct TriangleLabel {
    uint32_t number = 0;
    uint32_t flags = kBvhTriangleOpaque; ///< kBvhTriangle*, part << kBvhPartShift
};
/// Triangles in leaf order as the shaders read them. `labels`: one a triangle; empty: their own numbers, all opaque.
std::vector<BvhTriangle> leafTriangles(const Bvh& bvh, std::span<const vec3> positions,
                                       std::span<const TriangleLabel> labels = {});

/// A tree whose model space is the world's, as rays of any of `mask` meet all its parts.
BvhInstance instanceInPlace(uint64_t nodes, uint64_t triangles, uint32_t mask);

} // namespace q3rt
