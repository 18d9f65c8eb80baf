#pragma once
// The entities, polys and deformed world surfaces of one view as triangles: animated, deformed, lit, with materials
// chosen. Both renderers draw the result; only the rasteriser has it culled by its view.

#include <span>
#include <vector>

#include "scene/box_shows.hpp"
#include "scene/deform.hpp"
#include "scene/model.hpp"
#include "scene/scene_types.hpp"
#include "scene/stage_table.hpp"
#include "scene/triangle_cull.hpp"
#include "scene/world.hpp"

namespace q3rt {

/// One entity resolved for drawing. Number 0 of ViewGeometry::entities is the world itself.
struct EntityRecord {
    mat4 worldFromModel{1.0f};
    EntityLight light;
    StageInputs stage;
    vec3 eyeInModel{0};   ///< view origin in model space (spec of models 2.1)
    uint32_t flags = 0;   ///< entityFlag bits
    int sceneIndex = -1;  ///< index in the view's entities, -1 the world
    Bounds worldBounds;   ///< for culling; empty where unknown (never culled)
    int inlineModel = -1; ///< BSP submodel to draw with this transform (its surfaces are not copied here), -1 none
};

/// A run of triangles of one material.
struct EntitySurface {
    MaterialId material = 0;
    uint32_t entity = 0; ///< in ViewGeometry::entities
    int fog = 0;
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t firstIndex = 0, indexCount = 0; ///< in ViewGeometry::indices, absolute vertex numbers
    bool isPoly = false;                     ///< sorts as the world
    int worldSurface = -1; ///< the deformed world surface it replaces (draw this, not that one), -1 none
    /// Model surface it came from, for caching; stays valid as long as its ModelLibrary, registrations included.
    const ModelSurface* source = nullptr;
    int frame = 0, oldFrame = 0; ///< of `source`, valid frame numbers
    float backLerp = 0;          ///< weight of oldFrame; 0 when the frames are equal
    bool singleFrame = false;    ///< of a model with one frame: `source` alone says what it looks like, if not deformed
    bool castsVolume = false;    ///< Shadows::Volume
    bool deformed = false;       ///< vertices are not those of `source` at these frames: don't cache
    bool partly = false;         ///< of `source` only what may show: nor those
};

struct ViewGeometry {
    std::vector<EntityRecord> entities;
    std::vector<EntitySurface> surfaces;
    std::vector<Vertex> vertices; ///< model space of their entity (world space for entity 0, sprites, rails, polys)
    std::vector<uint32_t> indices;
    void reserve(); ///< room for a busy view
    void clear();   ///< keeps the memory

    // Work space of the builder, kept from frame to frame so that a steady frame allocates nothing.
    std::vector<Vertex> batchVertices;
    std::vector<uint32_t> batchIndices;
    std::vector<Affine> bones;           ///< of the mesh that is being added
    std::vector<Float4> positions;       ///< of its surface
    std::vector<uint32_t> shownNumbers;  ///< of the surface's vertices that may show
    std::vector<uint32_t> numberInShown; ///< the other way round, by the surface's vertex
    TriangleCuller culler;
    std::vector<uint32_t> recordOfInlineModel; ///< by BSP submodel; 0 not in the view
};

/// What models cast (cg_shadows); a blob below them is the game's own.
enum class Shadows : uint8_t { None, Volume, Projected };

struct ViewGeometrySettings {
    float identityLight = 1;
    float ambientScale = 0.6f, directedScale = 1.0f;
    float lodScale = 5;
    int lodBias = 0;
    int railWidth = 16, railCoreWidth = 6, railSegmentLength = 32;
    bool drawEntities = true;
    bool isPortalView = false, mirrored = false;
    /// Mesh models wholly behind one of these planes (normals inward) get a record and no geometry. Empty: none.
    std::span<const Plane> cullPlanes;
    PictureOfView picture; ///< polys, and surfaces and triangles of mesh models, that no pixel of it shows are left out
    /// By world surface: 0 where no deformed copy is needed. Empty: all are. Not asked for those of submodels.
    std::span<const uint8_t> visibleSurfaces;
    Shadows shadows = Shadows::None;
    MaterialId projectionShadow = 0; ///< what Shadows::Projected draws models with once more
    bool deformWorld = true;         ///< append deformed copies of world surfaces whose material has deforms
    /// Keep first-person and third-person entities alike (EntityRecord::flags tells them apart): for a tracer whose
    /// camera rays and mirror rays see different ones by instance mask.
    bool keepHiddenEntities = false;
    /// Unlit, white image times vertex colour: drawn for entities without a usable model (axes) and for beams. 0:
    /// default.
    MaterialId solidMaterial = 0;
};

/// `world` may be null (menus). `frame` holds the lists that `view` has ranges in; `eye` is the view's own, or a
/// portal's.
void buildViewGeometry(const FrameCommands& frame, const SceneView& view, const Orientation& eye, const World* world,
                       const ModelLibrary& models, const MaterialLibrary& materials,
                       const ViewGeometrySettings& settings, ViewGeometry& out);

/// Lighting of a point for an entity (spec of models 2.9, steps 1 to 6).
EntityLight computeEntityLight(const World* world, const vec3& sunDirection, const SceneEntity& entity,
                               const FrameCommands& frame, const SceneView& view, const ViewGeometrySettings& settings);

} // namespace q3rt
