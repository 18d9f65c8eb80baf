#pragma once
// Level of detail of a patch at draw time: which rows and columns are kept (spec of world 2.10).

#include <vector>

#include "renderer_vk/view_setup.hpp"
#include "scene/world.hpp"

namespace q3rt {

/// Appends the triangles of a patch as absolute vertex numbers. `worldFromModel` places brush models; `curveError` is
/// r_lodCurveError (qu of deviation at distance 1).
void appendPatchIndices(const WorldSurface& surface, const PatchGrid& grid, const RasterView& view,
                        const mat4& worldFromModel, float curveError, std::vector<uint32_t>& out);

} // namespace q3rt
