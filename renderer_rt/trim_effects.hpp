#pragma once
// Blood, smoke and glow as rays see them: squares only where something of them shows. Pure CPU.

#include "renderer_rt/traced_view.hpp"
#include "scene/effect_trim.hpp"

namespace q3rt {

/// Says of the view's blended squares where they show, and moves their corners to the borders of that; their triangles
/// stay, if without area. `camera`: what rays and textures' detail depend on. `textureParts` by texture.
void trimEffects(const RtFrame& camera, std::span<const StageState> stages, std::span<const TextureParts> textureParts,
                 ViewTables& tables, ViewGeometry& geometry);

} // namespace q3rt
