#pragma once
// The back end `compute`: our own trees in place of the driver's structures. Trees of the map and its inline models are
// built once; what moves has moving_trees.hpp; a small tree over all instances is built each frame. One tree holds
// everything that moves as one, of all surface classes: its parts stand for the driver's structures.

#include <array>
#include <vector>

#include "accel/bvh.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/uploader.hpp"
#include "renderer_rt/surface_class.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

static_assert(kSurfaceClassCount <= kBvhMostParts);

/// A tree on the GPU.
struct TreeAddress {
    VkDeviceAddress nodes = 0, triangles = 0;
    Bounds bounds; ///< model space
};

/// A tree on the CPU; bounds in model space.
struct TreeData {
    Bvh bvh;
    std::vector<BvhTriangle> triangles; ///< in leaf order
};

/// Triangles of one class: what the driver's back ends have a structure for. Triangle i of a part keeps that number.
struct TreePart {
    std::span<const Vertex> vertices;
    std::span<const uint32_t> indices; ///< absolute in `vertices`
    SurfaceClass surfaceClass = SurfaceClass::Solid;
};
/// A lasting tree is better and takes longer. At most kBvhMostParts parts.
TreeData buildTree(std::span<const TreePart> parts, bool lasting);

/// A tree for this frame only.
TreeAddress sendTree(GrowingBuffer& stream, const TreeData& tree);

/// Trees that stay: gathered, then uploaded at once.
class StaticTrees {
  public:
    /// Returns the tree's number.
    size_t add(std::span<const TreePart> parts);
    void upload(Device& device, Uploader& uploader);
    const TreeAddress& get(size_t tree) const { return m_trees[tree]; }
    uint32_t rejectedCount() const { return m_rejectedCount; }
    VkDeviceSize bytes() const { return m_nodes.size() + m_triangles.size(); }

  private:
    std::vector<BvhNode> m_nodeList;
    std::vector<BvhTriangle> m_triangleList;
    std::vector<TreeAddress> m_trees; ///< offsets in bytes until upload()
    uint32_t m_rejectedCount = 0;
    Buffer m_nodes, m_triangles;
};

/// One placed tree.
struct TreeInstance {
    TreeAddress tree;
    mat4 worldFromModel{1.0f};
    uint32_t customIndex = 0; ///< of part 0; the others follow
    std::array<uint8_t, kBvhMostParts> masks{};
};

/// On the CPU.
struct SceneTreeData {
    std::vector<BvhNode> nodes;
    std::vector<BvhInstance> instances; ///< in leaf order
};
/// Instances whose transform has no inverse show nothing and are left out.
SceneTreeData buildSceneTree(std::span<const TreeInstance> instances);

struct SceneTree {
    VkDeviceAddress nodes = 0, instances = 0;
};
SceneTree sendSceneTree(GrowingBuffer& stream, std::span<const TreeInstance> instances);

} // namespace q3rt
