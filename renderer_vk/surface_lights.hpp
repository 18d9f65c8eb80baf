#pragma once
// Which dynamic lights touch which visible surface (spec of world 7.4, 7.5). Any number of lights.

#include <span>
#include <utility>
#include <vector>

#include "renderer_vk/visibility.hpp"
#include "scene/entity_geometry.hpp"

namespace q3rt {

/// A surface (position in a caller's list) and a light (index in the view's lights), sorted by surface, then light.
using SurfaceLight = std::pair<uint32_t, uint32_t>;

/// Lights of world surfaces: `visible` as the walk found it.
void findWorldLights(const World& world, const VisibleWorld& visible, std::span<const SceneLight> lights,
                     std::vector<SurfaceLight>& out);

/// May light 0 draw on surfaces of this brush model? The original moves all lights into the model's space to decide
/// whether any touches the box, but then tests each surface with light 0 alone, where it stands in the world.
bool brushModelLit(const BspModel& model, const EntityRecord& entity, std::span<const SceneLight> lights);
bool lightTouchesSurface(const WorldSurface& surface, const SceneLight& light);

} // namespace q3rt
