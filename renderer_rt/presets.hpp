#pragma once
// Presets and the levels of rt_targetMs: points of a measured front, from presets.def.h, and what they make of the
// settings.

#include <span>
#include <string_view>

#include "renderer_rt/trace_settings.hpp"

namespace q3rt {

/// As measured; settings: "name value name value ...".
struct Preset {
    std::string_view name;
    double ms = 0, ssim = 0;
    std::string_view settings;
};
struct PaceLevel {
    double ms = 0, ssim = 0;
    std::string_view settings;
};
std::span<const Preset> presets();
/// By rising time and likeness.
std::span<const PaceLevel> paceLevels();

/// nullptr: there is none of this name; "custom" is none.
const Preset* findPreset(std::string_view name);

/// Sets what `settings` names. False: it names a setting that there is not, or gives one no number.
bool applySettings(std::string_view settings, TraceSettings& values);

} // namespace q3rt
