#pragma once
// A map with its light tables as the ray tracer uploads them, fixed points of its surfaces, and its shadows.

#include <memory>
#include <string>
#include <vector>

#include "accel/cpu_tracer.hpp"
#include "base/file_source.hpp"
#include "direct_shader.hpp"
#include "renderer_rt/world_lights.hpp"

namespace q3rt::test {

class MapLights {
  public:
    MapLights(FileSource& files, const std::string& map);

    /// `count` points, uniform over the area of what takes light, the same each time.
    std::vector<RtPixel> pickPoints(size_t count) const;
    /// Is (0, 1) of the way free of solid surfaces and skies of the world? Alpha-tested ones let all light pass.
    bool isVisible(const vec3& origin, const vec3& direction) const;
    /// Is the first of them on the way a sky?
    bool reachesSky(const vec3& origin, const vec3& direction) const;
    /// Frame whose tables are this map's.
    RtFrame describeFrame() const;
    const LightTables& tables() const { return m_tables; }
    uint clusterCount() const { return static_cast<uint>(m_world->bsp.clusterCount); }

  private:
    TextureLibrary m_textures;
    MaterialLibrary m_materials;
    std::unique_ptr<World> m_world;
    LightTables m_tables;
    std::unique_ptr<CpuTracer> m_tracer;
    std::vector<vec3> m_colors;
    std::vector<char> m_isSky;          ///< by triangle
    std::vector<uint32_t> m_firstIndex; ///< of the triangles of solid surfaces, in World::indices
    float m_farQu = 0;
};

} // namespace q3rt::test
