#include "renderer_vk/raster_settings.hpp"

namespace q3rt {

void bindRasterSettings(SettingsBinding& binding, RasterSettings& values) {
#define SETTING Q3RT_SETTING_BIND
#include "renderer_vk/settings.def.h"
#undef SETTING
}

} // namespace q3rt
