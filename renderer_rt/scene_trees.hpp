#pragma once
// The back end `compute`: our own trees in place of the driver's structures. Trees of the map and its inline models are
// built once; what moves gets a quick tree each frame; a small tree over all instances is built each frame.

#include <vector>

#include "accel/bvh.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/uploader.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// A tree on the GPU.
struct TreeAddress {
    VkDeviceAddress nodes = 0, triangles = 0;
    Bounds bounds; ///< model space
};

/// A tree on the CPU.
struct TreeData {
    std::vector<BvhNode> nodes;
    std::vector<BvhTriangle> triangles;
    Bounds bounds; ///< model space
};
/// `indices` absolute in `vertices`; triangles keep their numbers. A lasting tree is better and takes longer.
TreeData buildTree(std::span<const Vertex> vertices, std::span<const uint32_t> indices, bool opaque, bool lasting);

/// Trees that stay: gathered, then uploaded at once.
class StaticTrees {
  public:
    /// `indices` absolute in `vertices`; triangles keep their numbers. Returns the tree's number.
    size_t add(std::span<const Vertex> vertices, std::span<const uint32_t> indices, bool opaque);
    void upload(Device& device, Uploader& uploader);
    const TreeAddress& get(size_t tree) const { return m_trees[tree]; }
    VkDeviceSize bytes() const { return m_nodes.size() + m_triangles.size(); }

  private:
    std::vector<BvhNode> m_nodeList;
    std::vector<BvhTriangle> m_triangleList;
    std::vector<TreeAddress> m_trees; ///< offsets in bytes until upload()
    Buffer m_nodes, m_triangles;
};

/// A tree for this frame only.
TreeAddress sendMovingTree(GrowingBuffer& stream, std::span<const Vertex> vertices, std::span<const uint32_t> indices,
                           bool opaque);

/// One placed tree.
struct TreeInstance {
    TreeAddress tree;
    mat4 worldFromModel{1.0f};
    uint32_t customIndex = 0;
    uint8_t mask = 0;
    bool cullBack = false;
};

struct SceneTree {
    VkDeviceAddress nodes = 0, instances = 0;
};
/// Instances whose transform has no inverse show nothing and are left out.
SceneTree sendSceneTree(GrowingBuffer& stream, std::span<const TreeInstance> instances);

} // namespace q3rt
