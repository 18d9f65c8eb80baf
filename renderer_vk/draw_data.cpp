#include "renderer_vk/draw_data.hpp"

namespace q3rt {

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
}

} // namespace q3rt
