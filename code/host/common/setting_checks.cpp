#include "host/common/setting_checks.hpp"

#include <CLI/CLI.hpp>

#include "engine/setting_words.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

constexpr const char* kTracerPrefix = "rt_";

struct KnownSetting {
    const char *name, *type, *standard;
    float least, most;
    const char* unit; ///< of a text its words
    bool isText() const { return std::string_view(type) == "Text"; }
};
#define SETTING(name, type, standard, minimum, maximum, flags, unit, meaning)                                          \
    {#name, #type, #standard, minimum, maximum, unit},
constexpr KnownSetting kKnownSettings[] = {
#include "code/engine/front_end_settings.def.h"
#include "renderer_rt/settings.def.h"
#include "renderer_vk/settings.def.h"
};
#undef SETTING

[[noreturn]] void refuse(const std::string& name, const std::string& value, const std::string& complaint) {
    throw CLI::ValidationError(name + "=" + value, complaint);
}

} // namespace

std::string complainOfText(const std::string& name, const std::string& value) {
    for (const KnownSetting& setting : kKnownSettings)
        if (setting.isText() && equalsIgnoringCase(setting.name, name))
            return complainOfWord(setting.name, setting.unit, value);
    return "";
}

void requireSettings(const CvarTable& cvars, const CvarList& settings) {
    for (const auto& [name, value] : settings)
        if (const std::string complaint = cvars.complaint(name); !complaint.empty()) refuse(name, value, complaint);
}

CvarList requireKnownSettings(const CvarList& settings) {
    CvarTable known;
    for (const KnownSetting& setting : kKnownSettings) {
        cvar_t* cvar = known.get(setting.name, setting.standard, 0);
        if (setting.least < setting.most)
            known.setRange(cvar, setting.least, setting.most, std::string_view(setting.type) == "Int");
    }
    CvarList ours, others;
    for (const auto& setting : settings) {
        const bool isOurs = known.find(setting.first) || toLowerAscii(setting.first).starts_with(kTracerPrefix);
        (isOurs ? ours : others).push_back(setting);
    }
    for (const auto& [name, value] : ours)
        known.preset(name, value);
    requireSettings(known, ours);
    return others;
}

} // namespace q3rt
