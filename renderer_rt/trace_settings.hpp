#pragma once
// Settings of the ray tracer, from settings.def.h.

#include "engine/settings.hpp"

namespace q3rt {

struct TraceSettings {
#define SETTING Q3RT_SETTING_MEMBER
#include "renderer_rt/settings.def.h"
#undef SETTING
};
void bindTraceSettings(SettingsBinding& binding, TraceSettings& values);

} // namespace q3rt
