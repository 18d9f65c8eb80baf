#include "scene/scene_types.hpp"

#include "scene/busy_frame.hpp"

namespace q3rt {

void FrameCommands::reserve() {
    commands.reserve(busyFrame::kPictures);
    entities.reserve(busyFrame::kEntities);
    polys.reserve(busyFrame::kPolys);
    polyVertices.reserve(busyFrame::kPolys * 4);
    lights.reserve(busyFrame::kLights);
}

void FrameCommands::clear() {
    commands.clear();
    entities.clear();
    polys.clear();
    polyVertices.clear();
    lights.clear();
}

} // namespace q3rt
