#include "scene/scene_types.hpp"

namespace q3rt {

void FrameCommands::clear() {
    commands.clear();
    entities.clear();
    polys.clear();
    polyVertices.clear();
    lights.clear();
}

} // namespace q3rt
