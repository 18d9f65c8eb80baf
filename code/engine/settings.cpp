#include "engine/settings.hpp"

#include <cmath>
#include <cstdlib>

#include "base/error.hpp"
#include "base/log.hpp"
#include "engine/setting_words.hpp"

namespace q3rt {

namespace {

/// The engine limits numbers itself, and says so; of words it knows nothing.
void readText(const SettingInfo& info, std::string_view given, std::string& text) {
    const std::string_view words = info.unit, word = words.empty() ? given : findWord(words, given);
    if (words.empty() || !word.empty()) {
        text = word;
        return;
    }
    text = info.defaultText;
    logLineOnce(LogLevel::Warning, "%s; as if it were %s", complainOfWord(info.name, words, given).c_str(),
                text.c_str());
}

/// Also of what is no number at all: the engine's check of ranges lets "nan" through.
void readNumber(const SettingInfo& info, const Cvar& cvar, float& number) {
    number = cvar.value();
    if (!std::isnan(number)) return;
    number = std::strtof(info.defaultText.c_str(), nullptr);
    logLineOnce(LogLevel::Warning, "%s takes numbers from %g to %g, not '%s'; as if it were %s", info.name,
                static_cast<double>(info.minimum), static_cast<double>(info.maximum),
                std::string(cvar.string()).c_str(), info.defaultText.c_str());
}

} // namespace

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
            readNumber(entry.info, *entry.cvar, **real);
        else
            readText(entry.info, entry.cvar->string(), *std::get<std::string*>(entry.target));
    }
}

std::string settingDefaultText(int value) { return formatText("%d", value); }
std::string settingDefaultText(float value) { return formatText("%g", static_cast<double>(value)); }
std::string settingDefaultText(const std::string& value) { return value; }

} // namespace q3rt
