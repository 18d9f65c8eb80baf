#include "engine/settings.hpp"

#include "base/error.hpp"

namespace q3rt {

void SettingsBinding::bind(SettingInfo info, Target target) { m_entries.push_back({std::move(info), target, nullptr}); }

void SettingsBinding::registerAll(EngineServices& engine) {
    for (Entry& entry : m_entries) {
        const SettingInfo& info = entry.info;
        entry.cvar = &engine.cvar(info.name, info.defaultText, info.flags);
        if (info.minimum != info.maximum)
            engine.limitCvar(info.name, info.minimum, info.maximum, std::holds_alternative<int*>(entry.target));
        engine.describeCvar(info.name, info.meaning);
    }
    refresh();
}

void SettingsBinding::refresh() {
    for (Entry& entry : m_entries) {
        if (!entry.cvar) continue;
        if (auto number = std::get_if<int*>(&entry.target))
            **number = entry.cvar->integer();
        else if (auto real = std::get_if<float*>(&entry.target))
            **real = entry.cvar->value();
        else
            *std::get<std::string*>(entry.target) = entry.cvar->string();
    }
}

std::string settingDefaultText(int value) { return formatText("%d", value); }
std::string settingDefaultText(float value) { return formatText("%g", static_cast<double>(value)); }
std::string settingDefaultText(const std::string& value) { return value; }

} // namespace q3rt
