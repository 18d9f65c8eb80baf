#include "renderer_rt/presets.hpp"

#include <algorithm>
#include <charconv>

namespace q3rt {

namespace {

#define PRESET(name, ms, ssim, settings) {name, ms, ssim, settings},
#define LEVEL(ms, ssim, settings)
constexpr Preset kPresets[] = {
#include "renderer_rt/presets.def.h"
};
#undef PRESET
#undef LEVEL
#define PRESET(name, ms, ssim, settings)
#define LEVEL(ms, ssim, settings) {ms, ssim, settings},
constexpr PaceLevel kLevels[] = {
#include "renderer_rt/presets.def.h"
};
#undef PRESET
#undef LEVEL

template <typename Number>
bool parse(std::string_view text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
}

bool parse(std::string_view text, std::string& value) {
    value = text;
    return true;
}

bool setByName(std::string_view name, std::string_view value, TraceSettings& values) {
#define SETTING(member, ...)                                                                                           \
    if (name == #member) return parse(value, values.member);
#include "renderer_rt/settings.def.h"
#undef SETTING
    return false;
}

std::string_view takeWord(std::string_view& text) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    return word;
}

} // namespace

std::span<const Preset> presets() { return kPresets; }
std::span<const PaceLevel> paceLevels() { return kLevels; }

const Preset* findPreset(std::string_view name) {
    const auto found = std::find_if(std::begin(kPresets), std::end(kPresets),
                                    [&](const Preset& preset) { return preset.name == name; });
    return found == std::end(kPresets) ? nullptr : found;
}

bool applySettings(std::string_view settings, TraceSettings& values) {
    while (!settings.empty()) {
        const std::string_view name = takeWord(settings), value = takeWord(settings);
        if (!setByName(name, value, values)) return false;
    }
    return true;
}

} // namespace q3rt
