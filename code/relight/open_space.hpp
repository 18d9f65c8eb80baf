#pragma once
// Places in the open: points that can be reached in straight lines from where the game puts its entities. What they
// don't see nobody sees: cavities between brushes, the outside of the map.

#include <vector>

#include "relight/point_grid.hpp"
#include "scene/light_occluders.hpp"

namespace q3rt {

class OpenSpace {
  public:
    /// About `count` points, as even as the map's shape lets them be.
    OpenSpace(const World& world, const LightOccluders& occluders, size_t count);

    const std::vector<vec3>& points() const { return m_points; }
    /// Does any of the points near see this one, on its lit side?
    bool sees(const vec3& position, const vec3& normal) const;

  private:
    const LightOccluders& m_occluders;
    std::vector<vec3> m_points;
    PointGrid m_grid;

    std::vector<uint32_t> nearest(const vec3& place, size_t count) const;
    bool seenByAnother(const vec3& point, const vec3& from) const;
};

} // namespace q3rt
