#pragma once
// Which world surfaces a view may see: leafs marked by the cluster's PVS row and the area mask, then a walk of the tree
// with the frustum (spec of world 3.1 to 3.4).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer_vk/view_setup.hpp"
#include "scene/world.hpp"

namespace q3rt {

struct VisibilitySettings {
    bool noVis = false, lockPvs = false, noCull = false;
};

struct VisibleWorld {
    std::vector<uint32_t> surfaces; ///< in walk order, each once
    std::vector<int> surfaceLeaf;   ///< the first leaf that reached it, parallel to `surfaces`
    Bounds bounds;                  ///< of the visible leafs' boxes
    size_t leafCount = 0;
};

class WorldVisibility {
  public:
    explicit WorldVisibility(const World& world);
    void findVisible(const RasterView& view, const VisibilitySettings& settings, VisibleWorld& out);
    /// By world surface: was it found? 0 or 1.
    std::span<const uint8_t> visibleSurfaces() const { return m_surfaceVisible; }
    int cluster() const { return m_cluster; }

  private:
    void markLeafs(const RasterView& view, const VisibilitySettings& settings);
    void walk(int node, const RasterView& view, unsigned planes, VisibleWorld& out);
    void addLeaf(int leaf, VisibleWorld& out);

    const World& m_world;
    std::vector<int> m_nodeParent, m_leafParent;
    std::vector<uint8_t> m_nodeMarked, m_leafMarked;
    std::vector<uint8_t> m_surfaceVisible;
    bool m_marked = false;
    bool m_markedAll = false;
    int m_cluster = -1;
    std::array<uint8_t, 32> m_areaMask{};
};

} // namespace q3rt
