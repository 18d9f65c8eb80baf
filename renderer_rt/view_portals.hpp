#pragma once
// Where the mirrors and portals of one view lead. Pure CPU.

#include <span>
#include <vector>

#include "scene/entity_geometry.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

/// What a view says about its portals.
struct PortalScene {
    std::span<const SceneEntity> entities; ///< of the view
    int timeMs = 0;
};

class ViewPortals {
  public:
    void begin(const PortalScene& scene);
    /// 1 + index in table() of the map of a portal-sorted surface, 0 if it leads nowhere.
    uint32_t findStatic(const World& world, const WorldSurface& surface, const Material& material,
                        const EntityRecord& record);
    /// The same for a surface of the view's geometry.
    uint32_t findMoving(const World* world, const ViewGeometry& geometry, const EntitySurface& surface,
                        const Material& material);
    const std::vector<RtPortal>& table() const { return m_table; }

  private:
    uint32_t add(const Plane& modelPlane, const Material& material, const EntityRecord& record);

    PortalScene m_scene;
    std::vector<RtPortal> m_table;
};

} // namespace q3rt
