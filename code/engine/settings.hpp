#pragma once
// One line in a settings.def.h declares a setting: it makes the cvar, the member of the settings struct and the row in
// docs/settings.md. A list file holds lines of
//     SETTING(name, type, default, minimum, maximum, flags, unit, "meaning")
// type: Int, Float or Text; minimum == maximum: any value; flags: a letter group of settingFlag; a Text's unit: words.

#include <string>
#include <variant>
#include <vector>

#include "engine/services.hpp"

namespace q3rt {

namespace settingType {
using Int = int;
using Float = float;
using Text = std::string;
} // namespace settingType

/// A archived, L latched (takes effect at vid_restart or the next map), C cheat.
namespace settingFlag {
inline constexpr int none = 0, A = cvarFlag::kArchive, L = cvarFlag::kLatch, C = cvarFlag::kCheat, AL = A | L,
                     AC = A | C, LC = L | C, R = cvarFlag::kReadOnly;
}

struct SettingInfo {
    const char* name = "";
    std::string defaultText;
    float minimum = 0, maximum = 0; ///< equal: not limited
    int flags = 0;
    const char* unit = "";
    const char* meaning = "";
};

/// Ties the members of settings structs to cvars.
class SettingsBinding {
  public:
    using Target = std::variant<int*, float*, std::string*>;
    void bind(SettingInfo info, Target target);
    /// Registers every cvar; latched values become current, as at the engine's own registration.
    void registerAll(EngineServices& engine);
    /// Copies the cvars' values into the structs; of a text that is no word, the default. Not before registerAll().
    void refresh();

  private:
    struct Entry {
        SettingInfo info;
        Target target;
        Cvar* cvar = nullptr;
    };
    std::vector<Entry> m_entries;
};

std::string settingDefaultText(int value);
std::string settingDefaultText(float value);
std::string settingDefaultText(const std::string& value);

} // namespace q3rt

// Meanings of SETTING: a member, or a call that binds member `values.name` to `binding`.
#define Q3RT_SETTING_MEMBER(name, type, defaultValue, minimum, maximum, flags, unit, meaning)                          \
    ::q3rt::settingType::type name = defaultValue;
#define Q3RT_SETTING_BIND(name, type, defaultValue, minimum, maximum, flags, unit, meaning)                            \
    binding.bind({#name, ::q3rt::settingDefaultText(::q3rt::settingType::type(defaultValue)), minimum, maximum,        \
                  ::q3rt::settingFlag::flags, unit, meaning},                                                          \
                 &values.name);
