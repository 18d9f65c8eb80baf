#pragma once
// Working state of one view while its draw list is made; shared by the parts of DrawListBuilder.

#include "renderer_vk/draw_list.hpp"
#include "scene/busy_frame.hpp"

namespace q3rt {

/// Lists of one view, kept for their memory.
struct DrawListBuilder::ViewMemory {
    VisibleWorld visible;
    ViewGeometry geometry;
    std::vector<Item> items;
    std::vector<int> entityIndices; ///< by geometry entity: index in out.entities, -1 not yet
    std::vector<int> fogIndices;    ///< by fog number, -1 not yet
    std::vector<CullResult> entityCull;
    std::vector<ViewFlare> flares;
    std::vector<int> deformedSurface; ///< by world surface: index in geometry.surfaces, -1 drawn as it is

    void reserve(size_t worldSurfaceCount) {
        visible.surfaces.reserve(worldSurfaceCount);
        visible.surfaceLeaf.reserve(worldSurfaceCount);
        deformedSurface.reserve(worldSurfaceCount);
        items.reserve(worldSurfaceCount + busyFrame::kSurfaces);
        geometry.reserve();
        entityIndices.reserve(busyFrame::kEntities);
        entityCull.reserve(busyFrame::kEntities);
        fogIndices.reserve(busyFrame::kSmall);
        flares.reserve(busyFrame::kSmall);
    }
};

struct DrawListBuilder::ViewWork {
    ViewWork(const FrameCommands& frameCommands, const DrawListSettings& listSettings, const RasterView& rasterView,
             ViewMemory& memory, FrameDrawData& data)
        : frame(frameCommands)
        , settings(listSettings)
        , view(rasterView)
        , out(data)
        , visible(memory.visible)
        , geometry(memory.geometry)
        , items(memory.items)
        , entityIndices(memory.entityIndices)
        , fogIndices(memory.fogIndices)
        , entityCull(memory.entityCull)
        , flares(memory.flares)
        , deformedSurface(memory.deformedSurface) {
        items.clear();
    }

    const FrameCommands& frame;
    const DrawListSettings& settings;
    RasterView view;
    FrameDrawData& out;
    VisibleWorld& visible;
    ViewGeometry& geometry;
    std::vector<Item>& items;
    std::vector<int>&entityIndices, &fogIndices;
    std::vector<CullResult>& entityCull;
    std::vector<ViewFlare>& flares;
    std::vector<int>& deformedSurface;
    bool skyDrawn = false;
    uint32_t vertexBase = 0; ///< of geometry.vertices in out.vertices

    bool hasWorld() const { return (view.scene->flags & viewFlag::kNoWorldModel) == 0; }
    std::span<const SceneLight> lights() const {
        return std::span(frame.lights).subspan(view.scene->firstLight, view.scene->lightCount);
    }
    std::span<const SceneEntity> entities() const {
        return std::span(frame.entities).subspan(view.scene->firstEntity, view.scene->entityCount);
    }
};

} // namespace q3rt
