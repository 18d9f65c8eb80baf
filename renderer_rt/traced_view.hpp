#pragma once
// One view's scene as tables and instances, on the CPU: pure but for the structures that instances point to.

#include <compare>
#include <span>
#include <tuple>
#include <vector>

#include "gpu/acceleration_structure.hpp"
#include "renderer_rt/class_counts.hpp"
#include "renderer_rt/model_geometry.hpp"
#include "renderer_rt/static_geometry.hpp"
#include "renderer_rt/view_portals.hpp"
#include "scene/entity_geometry.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

/// A run of one entity's triangles of one class: what becomes a structure of this frame.
struct DynamicPart {
    uint32_t entity = 0;
    SurfaceClass surfaceClass = SurfaceClass::Solid;
    StructureClass structureClass = StructureClass::DynamicEntity;
    bool isPoly = false; ///< scene polys are apart: they come and go, the world's deformed surfaces stay
    bool castsShadow = true;
    uint32_t firstSurface = 0, surfaceCount = 0; ///< in ViewTables::surfacesOfParts
    uint32_t firstIndex = 0, triangleCount = 0;  ///< in ViewTables::indices; relative to firstVertex
    uint32_t firstVertex = 0, vertexCount = 0;   ///< in ViewGeometry::vertices
};

struct ViewTables {
    std::vector<RtInstance> instances; ///< addresses are offsets in bytes until resolved for dynamic parts
    std::vector<RtSurface> surfaces;
    std::vector<RtEntity> entities;
    std::vector<uint32_t> indices;           ///< of dynamic parts
    std::vector<uint32_t> surfaceOfTriangle; ///< of dynamic parts, parallel to indices / 3
    std::vector<uint32_t> surfacesOfParts;   ///< in ViewGeometry::surfaces
    std::vector<DynamicPart> parts;
    /// What instance i is made of: one of the three.
    struct Source {
        int staticPart = -1, dynamicPart = -1;
        const ModelPart* modelPart = nullptr;
        uint32_t entity = 0;
        SurfaceClass surfaceClass = SurfaceClass::Solid;
        uint8_t mask = 0;
    };
    std::vector<Source> sources;
    std::vector<RtSky> skies;
    std::vector<RtPortal> portals;
    bool hasLayers = false, hasNear = false, hasStagedCover = false;
    uint32_t layerOrderCount = 0;
    ClassCounts counts{};
    std::span<const uint32_t> surfacesOf(const DynamicPart& part) const {
        return std::span(surfacesOfParts).subspan(part.firstSurface, part.surfaceCount);
    }
    void clear();
};

/// What a surface is made of anew in each frame: a number for each model and world surface; 0 for what has no such
/// source.
uint64_t sourceKey(const EntitySurface& surface);

/// Remembers the good order of triangles of each model and world surface: it does not change with animation.
class TriangleOrderCache {
  public:
    /// `indices` absolute in `vertices`. `source`: sourceKey(); 0: no memory.
    const std::vector<uint32_t>& find(uint64_t source, std::span<const Vertex> vertices,
                                      std::span<const uint32_t> indices);
    void clear() { m_orders.clear(); }

  private:
    std::unordered_map<uint64_t, std::vector<uint32_t>> m_orders;
    std::vector<uint32_t> m_scratch;
};

class ViewTableBuilder {
  public:
    ViewTableBuilder(const MaterialLibrary& materials, StageTable& stages)
        : m_materials(materials)
        , m_stages(stages) {}
    /// `statics` may be null (no world).
    void build(const World* world, const StaticGeometry* statics, const ViewGeometry& geometry,
               const PortalScene& portals, ModelGeometry& models, ViewTables& out);
    const MaterialLibrary& materials() const { return m_materials; }

  private:
    void addStaticParts(const World& world, const StaticGeometry& statics, const ViewGeometry& geometry,
                        uint32_t entity, int model, ViewTables& out);
    /// A surface of what moves; sorted, those of a part follow one another.
    struct MovingSurface {
        std::tuple<uint32_t, SurfaceClass, bool, bool> group; ///< entity, class, scene poly, casts shadows
        uint32_t surface = 0;                                 ///< in ViewGeometry::surfaces
        auto operator<=>(const MovingSurface&) const = default;
    };
    /// Fills m_moving; models with a single frame go to `out` at once.
    void sortMovingSurfaces(const ViewGeometry& geometry, ModelGeometry& models, ViewTables& out);
    void addDynamicPart(const World* world, const ViewGeometry& geometry, std::span<const MovingSurface> moving,
                        ViewTables& out);
    void addDynamicParts(const World* world, const ViewGeometry& geometry, ModelGeometry& models, ViewTables& out);
    void addModelPart(const ViewGeometry& geometry, const EntitySurface& surface, SurfaceClass surfaceClass,
                      ModelGeometry& models, ViewTables& out);
    void appendTriangles(const ViewGeometry& geometry, DynamicPart& part, ViewTables& out);
    RtSurface makeSurface(MaterialId material, SurfaceClass surfaceClass, int fog, const StageInputs& inputs,
                          ViewTables& out);
    uint32_t skyIndex(const Material& material, MaterialId id, const StageInputs& inputs, ViewTables& out);
    void orderLayers(ViewTables& out);

    const MaterialLibrary& m_materials;
    StageTable& m_stages;
    TriangleOrderCache m_orders;
    std::vector<MovingSurface> m_moving;
    std::vector<std::pair<uint32_t, uint32_t>> m_layers; ///< sort rank, surface table index
    std::vector<std::pair<MaterialId, uint32_t>> m_skies;
    ViewPortals m_portals;
};

/// Who sees an entity with these renderfx flags.
Visibility visibilityOf(uint32_t entityFlags);

} // namespace q3rt
