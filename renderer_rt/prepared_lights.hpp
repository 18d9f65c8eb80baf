#pragma once
// A map's lights and the tables made of them, before they go to a device: made once for all back ends.

#include "base/file_source.hpp"
#include "renderer_rt/world_lights.hpp"

namespace q3rt {

/// What a map says of its lights beside what its scripts say.
enum class LightSource { Scripts, RecoveredOrEstimated };

/// `files`: of lights/MAP.ent. Without one strengths are estimated (baked_strengths.hpp).
PreparedLights prepareLights(FileSource& files, const World& world, const MaterialLibrary& materials,
                             const TextureLibrary& textures, LightSource source, const ModelLightScale& scale);

} // namespace q3rt
