#pragma once
// What rays meet in a map, for tests and benchmarks: the world's drawn triangles, and points where a player can be.

#include <memory>
#include <string>
#include <vector>

#include "base/file_source.hpp"
#include "scene/world.hpp"

namespace q3rt::test {

class WorldTriangles {
  public:
    WorldTriangles(FileSource& files, const std::string& map);
    /// 3 a triangle, of the world model's drawn surfaces but the sky.
    const std::vector<vec3>& positions() const { return m_positions; }
    size_t count() const { return m_positions.size() / 3; }
    /// `count` points spread evenly over the empty space inside the map.
    std::vector<vec3> pointsInside(size_t count, uint32_t seed) const;
    /// Where the eyes of the map's first player start are.
    vec3 playerStart() const;
    /// Longer than any line inside the map, qu.
    float farQu() const;

  private:
    TextureLibrary m_textures;
    MaterialLibrary m_materials;
    std::unique_ptr<World> m_world;
    std::vector<vec3> m_positions;
};

/// Uniform over the sphere, unit.
std::vector<vec3> unitDirections(size_t count, uint32_t seed);

} // namespace q3rt::test
