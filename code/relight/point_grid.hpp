#pragma once
// Points in space by cell, to find those near a place without looking at all.

#include <unordered_map>
#include <vector>

#include "math/vector.hpp"
#include "relight/sampling.hpp"

namespace q3rt {

class PointGrid {
  public:
    explicit PointGrid(float cellQu)
        : m_cellQu(cellQu) {}
    /// Points are numbered in the order in which they are added.
    void add(const vec3& point) { m_cells[cellOf(point)].push_back(m_count++); }
    /// Numbers of the points in the cells within `rings` cells of the place's own, in no special order.
    std::vector<uint32_t> near(const vec3& place, int rings) const;

  private:
    struct Hash {
        size_t operator()(const glm::ivec3& c) const {
            return hashOf(static_cast<uint32_t>(c.x) +
                          hashOf(static_cast<uint32_t>(c.y) + hashOf(static_cast<uint32_t>(c.z))));
        }
    };
    glm::ivec3 cellOf(const vec3& point) const { return glm::ivec3(glm::floor(point / m_cellQu)); }
    float m_cellQu;
    uint32_t m_count = 0;
    std::unordered_map<glm::ivec3, std::vector<uint32_t>, Hash> m_cells;
};

inline std::vector<uint32_t> PointGrid::near(const vec3& place, int rings) const {
    std::vector<uint32_t> found;
    const glm::ivec3 centre = cellOf(place);
    for (int z = -rings; z <= rings; ++z)
        for (int y = -rings; y <= rings; ++y)
            for (int x = -rings; x <= rings; ++x) {
                const auto cell = m_cells.find(centre + glm::ivec3(x, y, z));
                if (cell != m_cells.end()) found.insert(found.end(), cell->second.begin(), cell->second.end());
            }
    return found;
}

} // namespace q3rt
