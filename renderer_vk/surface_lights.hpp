#pragma once
// Which dynamic lights touch which visible surface (spec of world 7.4, 7.5). Any number of lights.

#include <span>
#include <utility>
#include <vector>

#include "renderer_vk/visibility.hpp"
#include "scene/entity_geometry.hpp"

namespace q3rt {

/// Which lights reach the leafs of visible surfaces, and which lights each surface was last found to be touched by.
///
/// A surface whose leaf no light reaches any more keeps its lights, as numbers: the lights that then have these numbers
/// are drawn on it if it lies near enough. The original does so, and a floor lit through its neighbours shows it.
class SurfaceLights {
  public:
    SurfaceLights(size_t surfaceCount, size_t leafCount);
    /// For `visible` as the walk found it.
    void findReached(const World& world, const VisibleWorld& visible, std::span<const SceneLight> lights);
    /// (place, light) of one place in `visible`, lights ascending.
    std::span<const std::pair<uint32_t, uint32_t>> reaching(size_t place) const;
    /// Which lights touch a surface now, ascending; kept until it is said again.
    void setTouching(uint32_t surface, std::span<const uint32_t> lights);
    std::span<const uint32_t> touching(uint32_t surface) const {
        return std::span(m_lists).subspan(m_touching[surface].first, m_touching[surface].count);
    }

  private:
    std::vector<uint8_t> m_leafs;                         ///< of the light at hand
    std::vector<std::pair<uint32_t, uint32_t>> m_reached; ///< sorted
    void packLists();
    struct List {
        uint32_t first = 0, count = 0; ///< in m_lists
    };
    std::vector<List> m_touching;  ///< by world surface
    std::vector<uint32_t> m_lists; ///< replaced lists stay in it until it is packed into the other
    std::vector<uint32_t> m_packed;
    size_t m_listedCount = 0; ///< of lights in lists that are not replaced
};

/// May light 0 draw on surfaces of this brush model? The original moves all lights into the model's space to decide
/// whether any touches the box, but then tests each surface with light 0 alone, where it stands in the world.
bool brushModelLit(const BspModel& model, const EntityRecord& entity, std::span<const SceneLight> lights);
bool lightTouchesSurface(const WorldSurface& surface, const SceneLight& light);

} // namespace q3rt
