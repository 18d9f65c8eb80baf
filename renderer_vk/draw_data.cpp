#include "renderer_vk/draw_data.hpp"

#include "scene/busy_frame.hpp"

namespace q3rt {

StageState colorStage(const vec4& color) {
    StageState state{};
    state.unit[0].texture = state.unit[1].texture = builtinTexture::kWhite;
    state.color = color;
    return state;
}

void FrameDrawData::reserve() {
    vertices.reserve(busyFrame::kVertices);
    indices.reserve(busyFrame::kIndices);
    occluders.reserve(busyFrame::kIndices);
    entities.reserve(busyFrame::kEntities);
    lights.reserve(busyFrame::kSurfaces);
    lightDraws.reserve(busyFrame::kSurfaces);
    fogs.reserve(busyFrame::kSmall);
    ownStages.reserve(busyFrame::kSmall);
    stageRanges.reserve(busyFrame::kSurfaces);
    batches.reserve(busyFrame::kSurfaces);
    views.reserve(busyFrame::kSmall);
    flareTests.reserve(busyFrame::kSmall);
}

void FrameDrawData::clear() {
    vertices.clear();
    indices.clear();
    occluders.clear();
    entities.clear();
    lights.clear();
    lightDraws.clear();
    fogs.clear();
    ownStages.clear();
    stageRanges.clear();
    batches.clear();
    views.clear();
    flareTests.clear();
}

} // namespace q3rt
