#include "renderer_rt/trace_settings.hpp"

namespace q3rt {

void bindTraceSettings(SettingsBinding& binding, TraceSettings& values) {
#define SETTING Q3RT_SETTING_BIND
#include "renderer_rt/settings.def.h"
#undef SETTING
}

} // namespace q3rt
