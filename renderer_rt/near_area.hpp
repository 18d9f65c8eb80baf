#pragma once
// Where on the picture the near depth range (the view weapon) can be seen: camera rays elsewhere need not look for it.

#include "scene/entity_geometry.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

/// Pixels, upper left corner then lower right one; may lie beyond the picture, and is turned inside out if there is
/// nothing. Every point of a near entity that the camera of `frame` sees is inside.
vec4 findNearArea(const ViewGeometry& geometry, const RtFrame& frame);

} // namespace q3rt
