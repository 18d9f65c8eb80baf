#pragma once
// What one frame sends to the GPU, gathered on the CPU. No Vulkan here.

#include <array>
#include <cstdint>
#include <vector>

#include "renderer_vk/flares.hpp"
#include "renderer_vk/lit_region.hpp"
#include "scene/material.hpp"
#include "scene/stage_table.hpp"
#include "shaders/shared/raster.h"
#include "shaders/shared/stage.h"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Which vertex buffer a batch indexes.
enum class VertexSource : uint8_t { World, Dynamic };

/// Stages made by the renderer itself (sky box, cinematics) are numbered from here; see FrameDrawData::ownStages.
inline constexpr uint32_t kOwnStageBit = 0x80000000u;

/// Depth range of a batch in the window (spec of world 3.7).
enum class DepthRange : uint8_t { Normal, Weapon, Far, Near };

/// Draws whose state is no material's.
enum class OwnDraw : uint8_t {
    None,
    SkyBox,       ///< opaque, no depth write
    Overlay,      ///< alpha blend, no depth
    ShadowVolume, ///< counts in the stencil: sides toward the eye up, then the others down
    ShadowShade,  ///< darkens where the count is not 0
    Flares,       ///< a material's stages without depth
    Normals       ///< lines, over everything
};

struct IndexRange {
    uint32_t first = 0, count = 0;
};

/// Triangles of one material, entity and fog, drawn stage by stage.
struct DrawBatch {
    MaterialId material = 0;     ///< the one that is drawn (remapped)
    StageRange stages;           ///< first may have kOwnStageBit
    OwnDraw own = OwnDraw::None; ///< draw with this state, not with the material's stages
    StageRange clouds;           ///< laid over a sky box in its pass
    bool nearest = false;        ///< opaque, and nothing is nearer: it may be drawn before everything else
    bool depthFirst = false;     ///< its depth may be drawn before everything else of the view
    bool erasesShadows = false;  ///< each pass counts down in the stencil
    VertexSource source = VertexSource::World;
    DepthRange depthRange = DepthRange::Normal;
    uint32_t entity = 0; ///< in FrameDrawData::entities
    uint32_t firstIndex = 0, indexCount = 0;
    int firstStageRange = -1; ///< in FrameDrawData::stageRanges: what a stage shows of the batch; -1 all
    uint32_t firstOccluder = 0,
             occluderCount = 0;              ///< in FrameDrawData::occluders: if its depth is drawn first, of this
    uint32_t firstLight = 0, lightCount = 0; ///< in FrameDrawData::lightDraws
    int fog = -1;                            ///< in FrameDrawData::fogs, -1 none
};

/// A dynamic light over a batch.
struct LightDraw {
    bool additive = false;
    uint32_t firstIndex = 0, indexCount = 0; ///< what it brightens of the batch
    PixelBox box;                            ///< where
};

/// One view (or the portal view before it) as batches.
struct ViewDraw {
    int x = 0, y = 0, width = 0, height = 0; ///< pixels, top-left origin
    bool mirrored = false, clipped = false;
    bool clearDepth = true;
    bool clearColor = false;
    float clearGrey = 0; ///< [0, 1]
    uint32_t firstBatch = 0, batchCount = 0;
    uint32_t firstFlareTest = 0, flareTestCount = 0; ///< in FrameDrawData::flareTests
    uint32_t flareEntity = 0;                        ///< of their pixels
    IndexRange depthClear;                           ///< if any, these clear its depth
    uint32_t clearEntity = 0;                        ///< of their vertices
};

/// A pixel that is drawn to nothing: does it lie before what is drawn?
struct FlareTest {
    FlareKey key;
    uint32_t firstIndex = 0; ///< of six
};

/// A stage of one colour and the white picture.
StageState colorStage(const vec4& color);

/// Of a frame's views together, for r_speeds.
struct ViewCounts {
    size_t leafs = 0, surfaces = 0, vertices = 0, litSurfaces = 0;
    std::array<size_t, 3> models{}; ///< by CullResult
    size_t flares = 0, flaresFading = 0;
    int cluster = -1; ///< of the last
    float farQu = 0;
};

struct FrameDrawData {
    std::vector<Vertex> vertices; ///< VertexSource::Dynamic
    std::vector<uint32_t> indices;
    std::vector<uint32_t> occluders; ///< indices too; on the GPU they follow them
    std::vector<RasterEntity> entities;
    std::vector<RasterLight> lights;
    std::vector<LightDraw> lightDraws; ///< parallel to lights
    std::vector<RasterFog> fogs;
    std::vector<StageState> ownStages;
    std::vector<IndexRange> stageRanges;
    std::vector<DrawBatch> batches;
    std::vector<ViewDraw> views;
    std::vector<FlareTest> flareTests;
    void reserve(); ///< room for a busy frame
    void clear();
};

} // namespace q3rt
