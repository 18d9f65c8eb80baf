#include "baseq3-test/box_tree.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace q3rt {

namespace {

constexpr int kWallThicknessQu = 16; ///< of the solid shell around all air

struct Split {
    int axis = 0, at = 0;
};

class TreeBuilder {
  public:
    TreeBuilder(const BoxMap& map, const std::vector<BoxFace>& faces, int solidShader, Bsp& bsp)
        : m_map(map)
        , m_faces(faces)
        , m_solidShader(solidShader)
        , m_bsp(bsp) {}

    /// Returns a child number: a node, or -1 - leaf.
    int build(const IntBox& region) {
        const std::optional<Split> split = chooseSplit(region);
        if (!split) return -1 - addLeaf(region);
        const int node = static_cast<int>(m_bsp.nodes.size());
        m_bsp.nodes.push_back({findPlane(split->axis, split->at), {0, 0}, region.mins, region.maxs});
        IntBox front = region, back = region;
        front.mins[split->axis] = back.maxs[split->axis] = split->at;
        const int frontChild = build(front), backChild = build(back);
        m_bsp.nodes[static_cast<size_t>(node)].children[0] = frontChild;
        m_bsp.nodes[static_cast<size_t>(node)].children[1] = backChild;
        return node;
    }

  private:
    static bool overlaps(const IntBox& a, const IntBox& b) {
        return glm::all(glm::lessThan(glm::max(a.mins, b.mins), glm::min(a.maxs, b.maxs)));
    }

    /// The side that cuts the fewest boxes, then the one nearest to halving them; none where all is one kind.
    std::optional<Split> chooseSplit(const IntBox& region) const {
        std::optional<Split> best;
        int bestCost = std::numeric_limits<int>::max();
        for (const AirBox& air : m_map.air) {
            if (!overlaps(air.box, region)) continue;
            for (int axis = 0; axis < 3; ++axis)
                for (const int at : {air.box.mins[axis], air.box.maxs[axis]}) {
                    if (at <= region.mins[axis] || at >= region.maxs[axis]) continue;
                    const int cost = computeCost(region, {axis, at});
                    if (cost < bestCost) bestCost = cost, best = Split{axis, at};
                }
        }
        return best;
    }

    int computeCost(const IntBox& region, const Split& split) const {
        int cut = 0, below = 0, above = 0;
        for (const AirBox& air : m_map.air) {
            if (!overlaps(air.box, region)) continue;
            const bool reachesBelow =
                air.box.mins[split.axis]<split.at, reachesAbove = air.box.maxs[split.axis]> split.at;
            cut += reachesBelow && reachesAbove;
            below += reachesBelow;
            above += reachesAbove;
        }
        return cut * 1024 + std::abs(below - above);
    }

    /// Planes stand in pairs: the even one looks along the positive axis.
    int findPlane(int axis, int at) {
        Plane plane;
        plane.normal[axis] = 1.0f;
        plane.distance = static_cast<float>(at);
        for (size_t i = 0; i < m_bsp.planes.size(); i += 2)
            if (m_bsp.planes[i].normal == plane.normal && m_bsp.planes[i].distance == plane.distance)
                return static_cast<int>(i);
        m_bsp.planes.push_back(plane);
        m_bsp.planes.push_back({-plane.normal, -plane.distance});
        return static_cast<int>(m_bsp.planes.size()) - 2;
    }

    int addLeaf(const IntBox& region) {
        BspLeaf leaf;
        leaf.mins = region.mins, leaf.maxs = region.maxs;
        leaf.area = -1;
        leaf.firstLeafSurface = static_cast<int>(m_bsp.leafSurfaces.size());
        leaf.firstLeafBrush = static_cast<int>(m_bsp.leafBrushes.size());
        const auto air = std::find_if(m_map.air.begin(), m_map.air.end(),
                                      [&](const AirBox& candidate) { return overlaps(candidate.box, region); });
        if (air != m_map.air.end()) {
            leaf.cluster = air->cluster;
            leaf.area = 0;
            for (size_t face = 0; face < m_faces.size(); ++face)
                if (m_faces[face].airBox == static_cast<size_t>(air - m_map.air.begin()) &&
                    m_faces[face].rectangle.touches(region))
                    m_bsp.leafSurfaces.push_back(static_cast<int>(face));
        } else {
            m_bsp.leafBrushes.push_back(addBrush(region));
        }
        leaf.leafSurfaceCount = static_cast<int>(m_bsp.leafSurfaces.size()) - leaf.firstLeafSurface;
        leaf.leafBrushCount = static_cast<int>(m_bsp.leafBrushes.size()) - leaf.firstLeafBrush;
        m_bsp.leafs.push_back(leaf);
        return static_cast<int>(m_bsp.leafs.size()) - 1;
    }

    int addBrush(const IntBox& region) {
        m_bsp.brushes.push_back({static_cast<int>(m_bsp.brushSides.size()), 6, m_solidShader});
        for (int axis = 0; axis < 3; ++axis) {
            m_bsp.brushSides.push_back({findPlane(axis, region.mins[axis]) + 1, m_solidShader});
            m_bsp.brushSides.push_back({findPlane(axis, region.maxs[axis]), m_solidShader});
        }
        return static_cast<int>(m_bsp.brushes.size()) - 1;
    }

    const BoxMap& m_map;
    const std::vector<BoxFace>& m_faces;
    const int m_solidShader;
    Bsp& m_bsp;
};

} // namespace

void buildBoxTree(const BoxMap& map, const std::vector<BoxFace>& faces, int solidShader, Bsp& bsp) {
    IntBox all = map.air.front().box;
    for (const AirBox& air : map.air) {
        all.mins = glm::min(all.mins, air.box.mins);
        all.maxs = glm::max(all.maxs, air.box.maxs);
    }
    all.mins -= kWallThicknessQu;
    all.maxs += kWallThicknessQu;
    TreeBuilder(map, faces, solidShader, bsp).build(all);
}

} // namespace q3rt
