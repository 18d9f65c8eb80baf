#pragma once
// Settings of window and rasteriser, from settings.def.h.

#include "engine/settings.hpp"

namespace q3rt {

struct RasterSettings {
#define SETTING Q3RT_SETTING_MEMBER
#include "renderer_vk/settings.def.h"
#undef SETTING
};
void bindRasterSettings(SettingsBinding& binding, RasterSettings& values);

} // namespace q3rt
