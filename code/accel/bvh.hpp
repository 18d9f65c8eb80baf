#pragma once
// Bounding volume hierarchies over boxes: the builders of our own trees (static parts and models once at load, the
// scene over instances each frame). All give the same child-pair nodes (shaders/shared/bvh.h); they differ in time and
// quality.
//
//   buildSah      binned surface-area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//   Hierarchies") buildMorton   sort by 30-bit Morton code, split at the highest differing bit (Lauterbach et al. 2009,
//   Karras 2012) buildPairing  plain closest-centroid pairing (Park and Baek 2021, section 3.1): the benchmark's
//   baseline only
//
// Items whose box is not finite are left out of the tree and counted. Every path is at most kBvhMaxDepth long.

#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.hpp"
#include "shaders/shared/bvh.h"

namespace q3rt {

struct Bvh {
    std::vector<BvhNode> nodes;  ///< [0] the root; never empty
    std::vector<uint32_t> order; ///< leaf item -> input item
    Bounds bounds;               ///< of all items in the tree; empty if none
    uint32_t rejectedCount = 0;  ///< items with a non-finite box
};

struct BvhBuildSettings {
    uint32_t maxLeafItems = 4;
    /// Cost of a node visit in units of one item test; measured by the benchmark `bvh_build`.
    float traversalCost = 1.0f;
    unsigned threadCount = 1;
};

/// Items per second matters here: boxes are given once, no callbacks.
Bvh buildSah(std::span<const Bounds> items, const BvhBuildSettings& settings = {});
Bvh buildMorton(std::span<const Bounds> items, const BvhBuildSettings& settings = {});
/// O(n^2) a level.
Bvh buildPairing(std::span<const Bounds> items);

/// Recomputes all boxes for moved items, same topology. Returns the surface-area cost after / before: a caller rebuilds
/// when it has grown too much. `items` is in input order and must have the size the tree was built with.
float refit(Bvh& bvh, std::span<const Bounds> items);

/// Expected cost of a random ray that hits the root: sum over nodes of area(child) / area(root) x (visit or item
/// tests).
float surfaceAreaCost(const Bvh& bvh, float traversalCost = 1.0f);
/// Longest path from the root to a leaf, counted in nodes.
uint32_t depthOf(const Bvh& bvh);

/// Boxes of triangles; positions 3 a triangle.
std::vector<Bounds> triangleBounds(std::span<const vec3> positions);

/// Triangles in leaf order as the shaders read them. `opaque` has one entry a triangle; empty: all are.
std::vector<BvhTriangle> leafTriangles(const Bvh& bvh, std::span<const vec3> positions,
                                       std::span<const uint8_t> opaque = {});

} // namespace q3rt
