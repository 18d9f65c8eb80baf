#include "renderer_vk/draw_data.hpp"

namespace q3rt {

StageState colorStage(const vec4& color) {
    StageState state{};
    state.unit[0].texture = state.unit[1].texture = builtinTexture::kWhite;
    state.color = color;
    return state;
}

void FrameDrawData::clear() {
    vertices.clear();
    indices.clear();
    entities.clear();
    lights.clear();
    lightAdditive.clear();
    fogs.clear();
    ownStages.clear();
    batches.clear();
    views.clear();
    flareTests.clear();
}

} // namespace q3rt
