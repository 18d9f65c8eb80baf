// Buffers of a raster frame. Set 0: what uploadFrame() sent; set 1: all textures.
#include "shared/stage.h"
#include "shared/raster.h"

layout(set = 0, binding = 0, scalar) readonly buffer Stages { StageState stages[]; };
layout(set = 0, binding = 1, scalar) readonly buffer Entities { RasterEntity entities[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Lights { RasterLight lights[]; };
layout(set = 0, binding = 3, scalar) readonly buffer Fogs { RasterFog fogs[]; };
layout(push_constant, scalar) uniform Push { RasterDraw draw; };

layout(constant_id = 0) const uint kPass = 0u;      // kPass*
layout(constant_id = 1) const uint kCombine = 0u;   // kCombine*
layout(constant_id = 2) const uint kAlphaTest = 0u; // kTest*
layout(constant_id = 3) const uint kClipped = 0u;   // 1: portal view
layout(constant_id = 5) const uint kLayers = 1u;    // stages in this pass
