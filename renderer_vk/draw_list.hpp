#pragma once
// From a scene to batches in the original's order: visible world surfaces, polys and entities, sorted by shader rank,
// entity, fog and light (spec of world section 3), portals first. Pure CPU.

#include <memory>
#include <string>

#include "renderer_vk/draw_data.hpp"
#include "renderer_vk/portal.hpp"
#include "renderer_vk/raster_settings.hpp"
#include "renderer_vk/shadow_volume.hpp"
#include "renderer_vk/sky.hpp"
#include "renderer_vk/surface_lights.hpp"
#include "renderer_vk/visibility.hpp"
#include "scene/effect_trim.hpp"
#include "scene/entity_geometry.hpp"
#include "scene/triangle_cull.hpp"

namespace q3rt {

/// The part of the front end's settings that a list needs.
struct DrawListSettings {
    RasterSettings raster;
    ViewGeometrySettings geometry;
    MaterialId sun = 0, flare = 0;
    bool fastSky = false, drawWorld = true;
    bool dynamicLights = true;
    bool cullTriangles = false;                 ///< leave out those that no pixel shows
    std::span<const TextureParts> textureParts; ///< by texture
};

/// 64-bit key, ascending: shader rank, entity, fog, lit. The world and polys come after all entities.
uint64_t makeSortKey(uint32_t rank, int sceneIndex, int fog, bool lit);

class DrawListBuilder {
  public:
    DrawListBuilder(const MaterialLibrary& materials, const ModelLibrary& models, StageTable& stages,
                    const World* world);
    ~DrawListBuilder();
    void beginFrame(uint64_t frame);
    /// What an earlier frame found out of its flares.
    FlareFades& fades() { return m_fades; }
    /// Appends the views of one RenderScene: the portal's first, then its own.
    void addScene(const FrameCommands& frame, const SceneView& scene, const DrawListSettings& settings,
                  FrameDrawData& out);
    /// A line for people of what the frame's views hold: r_speeds. They count only if it is set.
    std::string describeCounts(int kind, const FrameDrawData& data) const;

  private:
    struct Item {
        uint64_t key;
        uint32_t surface;    ///< world surface, or index in ViewGeometry::surfaces
        uint32_t entity;     ///< in ViewGeometry::entities
        MaterialId material; ///< as registered, not remapped
        int fog;
        bool fromWorld; ///< world vertices
        bool lit;
        uint32_t order; ///< of submission: it decides between equal keys
    };
    /// A flare on the screen.
    struct ViewFlare {
        FlareKey key;
        FlarePlace place;
        vec3 color{0};
        float fogKeep = 1;
    };
    /// Of a surface that may be a portal.
    struct Corners {
        std::vector<vec3> positions, normals;
        std::vector<uint32_t> indices;
    };
    struct ViewWork; // of one view, in view_work.hpp
    struct ViewMemory;

    void buildView(ViewWork& work);
    void findDeformed(ViewWork& work);
    void addWorld(ViewWork& work);
    /// `touch` says which lights touch the surface, if it is drawn; true if any.
    template <typename Touch>
    void addWorldSurface(ViewWork& work, uint32_t surface, uint32_t entity, const Touch& touch);
    void addEntities(ViewWork& work);
    void addBrushModel(ViewWork& work, uint32_t entity);
    bool surfaceCulled(const ViewWork& work, const WorldSurface& surface, const EntityRecord& entity,
                       bool isWorld) const;
    bool addPortalView(ViewWork& work);
    ViewMemory& memoryOf(int portalDepth);
    void makeBatches(ViewWork& work);
    void appendDepthClear(ViewWork& work, ViewDraw& draw);
    void appendBatch(ViewWork& work, size_t firstItem, size_t lastItem);
    void findSkyCoverage(ViewWork& work, size_t firstItem, size_t lastItem);
    TriangleView triangleView(const ViewWork& work, const DrawBatch& batch) const;
    const std::vector<Vertex>& verticesOf(const ViewWork& work, const DrawBatch& batch) const;
    void trimEffects(ViewWork& work, DrawBatch& batch, size_t firstItem, size_t lastItem);
    bool appendTrimmed(ViewWork& work, const DrawBatch& batch, uint32_t stage, const Item& item);
    void cullTriangles(ViewWork& work, const DrawBatch& batch, CullMode cull, size_t firstIndex);
    void appendSky(ViewWork& work, const Material& material, MaterialId id, size_t firstItem, size_t lastItem);
    void appendShadowVolumes(ViewWork& work);
    void appendShadowShade(ViewWork& work);
    void appendSun(ViewWork& work);
    void appendNormals(ViewWork& work, const DrawBatch& of);
    void countView(const ViewWork& work);
    void findFlares(ViewWork& work);
    void appendFlares(ViewWork& work, ViewDraw& draw);
    uint32_t screenEntity(ViewWork& work);
    void appendScreenSquare(ViewWork& work, const vec2& from, const vec2& to, float depth, uint32_t color);
    void appendItemIndices(ViewWork& work, const Item& item);
    uint32_t entityIndex(ViewWork& work, uint32_t entity);
    int fogIndex(ViewWork& work, int fog);
    bool touchWorldLights(const ViewWork& work, size_t place);
    void appendLights(ViewWork& work, DrawBatch& batch, size_t firstItem, size_t lastItem);
    LightDraw findLitPart(ViewWork& work, const DrawBatch& batch, const RasterLight& light);
    MaterialId drawnId(MaterialId id) const;

    const MaterialLibrary& m_materials;
    const ModelLibrary& m_models;
    StageTable& m_stages;
    const World* m_world;
    std::unique_ptr<WorldVisibility> m_visibility;
    std::unique_ptr<SurfaceLights> m_lights;
    ShadowVolumeBuilder m_shadowVolumes;
    TriangleCuller m_culler;
    Corners m_portalCorners;
    SkyCoverage m_skyCoverage;                         ///< of the batch at hand
    std::vector<std::unique_ptr<ViewMemory>> m_memory; ///< of the view, of the portal's in it, and so on
    std::vector<uint32_t> m_surfaceLights;             ///< of the surface at hand
    std::vector<uint32_t> m_batchLights;               ///< of the batch at hand
    std::vector<uint32_t> m_handled;                   ///< stamp by world surface: once a view, also by brush models
    uint32_t m_stamp = 0;
    FlareFades m_fades;
    uint32_t m_sceneNumber = 0; ///< in its frame
    ViewCounts m_counts;
};

} // namespace q3rt
