#include "engine/settings.hpp"

#include <algorithm>

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

std::vector<SettingInfo> SettingsBinding::list() const {
    std::vector<SettingInfo> infos;
    for (const Entry& entry : m_entries)
        infos.push_back(entry.info);
    return infos;
}

std::string settingDefaultText(int value) { return formatText("%d", value); }
std::string settingDefaultText(float value) { return formatText("%g", static_cast<double>(value)); }
std::string settingDefaultText(const std::string& value) { return value; }

std::string formatSettingsTable(std::span<const SettingInfo> settings) {
    std::vector<SettingInfo> sorted(settings.begin(), settings.end());
    std::ranges::sort(sorted, {}, [](const SettingInfo& info) { return std::string(info.name); });
    std::string text = "| cvar | default | range | unit | flags | meaning |\n|---|---|---|---|---|---|\n";
    for (const SettingInfo& info : sorted) {
        std::string range = "any";
        if (info.minimum != info.maximum)
            range = formatText("%g to %g", static_cast<double>(info.minimum), static_cast<double>(info.maximum));
        std::string flags;
        if (info.flags & cvarFlag::kArchive) flags += "archived ";
        if (info.flags & cvarFlag::kLatch) flags += "vid_restart ";
        if (info.flags & cvarFlag::kCheat) flags += "cheat ";
        if (info.flags & cvarFlag::kReadOnly) flags += "read-only ";
        if (!flags.empty()) flags.pop_back();
        text += formatText("| `%s` | %s | %s | %s | %s | %s |\n", info.name, info.defaultText.c_str(), range.c_str(),
                           info.unit, flags.c_str(), info.meaning);
    }
    return text;
}

} // namespace q3rt
