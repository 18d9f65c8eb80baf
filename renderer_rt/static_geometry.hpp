#pragma once
// The world and its inline models in bottom-level structures: one a model and surface class, built once at load, never
// culled by the view. Surfaces with deforms are left out: they come with each view's geometry.

#include <vector>

#include "gpu/acceleration_structure.hpp"
#include "gpu/uploader.hpp"
#include "renderer_rt/backend.hpp"
#include "renderer_rt/scene_trees.hpp"
#include "renderer_rt/surface_class.hpp"
#include "scene/world.hpp"

namespace q3rt {

/// Triangles of one structure. Triangle i shows surfaces[surfaceOfTriangle[i]].
struct StaticPart {
    int model = 0; ///< BSP model; 0 the world
    SurfaceClass surfaceClass = SurfaceClass::Solid;
    std::vector<uint32_t> surfaces; ///< world surface numbers
    uint32_t triangleCount = 0;
    VkDeviceAddress indices = 0, surfaceOfTriangle = 0;
    AccelerationStructure structure; ///< back ends of the driver
    size_t tree = 0;                 ///< back end `compute`: in StaticGeometry::tree()
    size_t partOfTree = 0;
};

class StaticGeometry {
  public:
    StaticGeometry(Device& device, Uploader& uploader, const World& world, const MaterialLibrary& materials,
                   Backend backend);
    /// Those of one model stand together.
    const std::vector<StaticPart>& parts() const { return m_parts; }
    const TreeAddress& tree(size_t number) const { return m_trees.get(number); }
    VkDeviceAddress vertices() const { return m_vertices.address(); }
    uint32_t triangleCount() const { return m_triangleCount; }
    VkDeviceSize bytes() const;

  private:
    struct PartTriangles;
    void gather(const World& world, const MaterialLibrary& materials, std::vector<PartTriangles>& gathered);
    void buildStructures(Device& device, uint32_t vertexCount);
    void buildTrees(Device& device, Uploader& uploader, const World& world, std::span<const uint32_t> indices);

    Buffer m_vertices, m_indices, m_surfaceOfTriangle;
    StaticTrees m_trees;
    std::vector<StaticPart> m_parts;
    uint32_t m_triangleCount = 0;
};

} // namespace q3rt
