#pragma once
// Between the engine's structs and ours. What the game may get wrong is checked here, once: kinds, sizes, NaN.

#include <optional>
#include <span>
#include <vector>

#include "abi/ref_types.h"
#include "engine/renderer.hpp"

namespace q3rt {

vec3 vectorFrom(const float* xyz);
void storeVector(const vec3& from, float* xyz);
/// nullopt: the entity's place is not a number, so it can't be drawn. Throws UsageError for an unknown kind.
std::optional<SceneEntity> entityFrom(const refEntity_t& entity);
void storePolyVertices(std::span<const polyVert_t> from, std::vector<PolyVertex>& to);
SceneView viewFrom(const refdef_t& view);
void storeDisplay(const DisplayInfo& display, glconfig_t& config);
void storeOrientation(const Orientation& from, orientation_t& to);
void storeFont(const RegisteredFont& font, fontInfo_t& out);

} // namespace q3rt
