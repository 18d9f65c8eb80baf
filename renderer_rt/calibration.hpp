#pragma once
// The choice of a back end by measurement: what it depends on, and the view that is drawn for it.

#include <string>

#include "gpu/vulkan_api.hpp"
#include "scene/scene_types.hpp"
#include "scene/world.hpp"

namespace q3rt {

struct Capabilities;

/// Device, driver and the shaders of this build.
std::string calibrationKey(const Capabilities& capabilities);

/// What a player sees at the first start of the map; from its middle where there is none.
SceneView stillOf(const World& world, VkExtent2D extent);

} // namespace q3rt
