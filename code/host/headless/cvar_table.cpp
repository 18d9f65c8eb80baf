#include "host/headless/cvar_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "host/headless/nearest_name.hpp"

namespace q3rt {
namespace {

constexpr int kLatch = 0x20, kUserCreated = 0x80;

/// `text` if the cvar's range holds it, else the nearest value that it holds; `reset` for what is no number.
std::string withinRange(const cvar_t& cvar, const std::string& text, const std::string& reset) {
    char* end = nullptr;
    const float number = std::strtof(text.c_str(), &end);
    if (end == text.c_str() || *end != 0 || std::isnan(number)) return reset;
    float limited = std::clamp(number, cvar.min, cvar.max);
    if (cvar.integral) limited = std::trunc(limited);
    if (limited == number) return text;
    return cvar.integral ? std::to_string(static_cast<int>(limited)) : formatText("%g", limited);
}

} // namespace

/// The struct that modules hold, and the strings that it points to.
struct CvarTable::Entry {
    cvar_t cvar{};
    std::string name, value, reset, description;
    std::string latched;
    std::optional<std::string> refused; ///< what was given last, if the range did not let it in
    bool hasLatched = false;
};

CvarTable::CvarTable() = default;
CvarTable::~CvarTable() = default;

void CvarTable::assign(Entry& entry, std::string value) {
    cvar_t& cvar = entry.cvar;
    if (cvar.validate) {
        std::string accepted = withinRange(cvar, value, entry.reset);
        entry.refused.reset();
        if (accepted != value) entry.refused = value;
        value = std::move(accepted);
    }
    const float number = std::strtof(value.c_str(), nullptr);
    const bool changed = value != entry.value || cvar.modificationCount == 0;
    entry.value = std::move(value);
    entry.hasLatched = false;
    cvar.name = entry.name.data();
    cvar.string = entry.value.data();
    cvar.resetString = entry.reset.data();
    cvar.latchedString = nullptr;
    cvar.value = number;
    cvar.integer = static_cast<int32_t>(std::strtol(entry.value.c_str(), nullptr, 10));
    if (!changed) return;
    cvar.modified = 1;
    ++cvar.modificationCount;
}

cvar_t* CvarTable::get(std::string_view name, std::string_view defaultValue, int flags) {
    std::unique_ptr<Entry>& slot = m_entries[toLowerAscii(name)];
    if (!slot) {
        slot = std::make_unique<Entry>();
        slot->name = name;
        slot->reset = defaultValue;
        slot->cvar.flags = flags;
        assign(*slot, std::string(defaultValue));
        return &slot->cvar;
    }
    slot->cvar.flags = (slot->cvar.flags & ~kUserCreated) | flags;
    slot->reset = defaultValue;
    slot->cvar.resetString = slot->reset.data();
    if (slot->hasLatched) assign(*slot, slot->latched);
    return &slot->cvar;
}

void CvarTable::set(std::string_view name, std::string_view value) {
    std::unique_ptr<Entry>& slot = m_entries[toLowerAscii(name)];
    if (!slot) {
        preset(name, value);
        return;
    }
    if (!(slot->cvar.flags & kLatch)) return assign(*slot, std::string(value));
    slot->latched = value;
    slot->hasLatched = true;
    slot->cvar.latchedString = slot->latched.data();
    slot->cvar.modified = 1;
}

void CvarTable::preset(std::string_view name, std::string_view value) {
    std::unique_ptr<Entry>& slot = m_entries[toLowerAscii(name)];
    if (!slot) {
        slot = std::make_unique<Entry>();
        slot->name = name;
        slot->cvar.flags = kUserCreated;
    }
    assign(*slot, std::string(value));
}

void CvarTable::setRange(cvar_t* cvar, float minimum, float maximum, bool integral) {
    Entry& entry = *m_entries.at(toLowerAscii(cvar->name));
    cvar->validate = 1;
    cvar->min = minimum;
    cvar->max = maximum;
    cvar->integral = integral;
    assign(entry, entry.value);
}

void CvarTable::describe(cvar_t* cvar, std::string_view text) {
    Entry& entry = *m_entries.at(toLowerAscii(cvar->name));
    entry.description = text;
    cvar->description = entry.description.data();
}

cvar_t* CvarTable::find(std::string_view name) const {
    const auto found = m_entries.find(toLowerAscii(name));
    return found == m_entries.end() ? nullptr : &found->second->cvar;
}

std::string CvarTable::value(std::string_view name) const {
    const cvar_t* cvar = find(name);
    return cvar ? cvar->string : "";
}

std::string CvarTable::complaint(std::string_view name) const {
    const auto found = m_entries.find(toLowerAscii(name));
    if (found == m_entries.end() || found->second->cvar.flags & kUserCreated) {
        std::vector<std::string> declared;
        for (const auto& [key, entry] : m_entries)
            if (!(entry->cvar.flags & kUserCreated)) declared.push_back(entry->name);
        const std::string given(name);
        return formatText("no setting of this renderer is called %s", given.c_str()) + hintAtNearest(given, declared);
    }
    const Entry& entry = *found->second;
    if (!entry.refused) return "";
    return formatText("%s takes %s from %g to %g, not '%s'", entry.name.c_str(),
                      entry.cvar.integral ? "whole numbers" : "numbers", entry.cvar.min, entry.cvar.max,
                      entry.refused->c_str());
}

std::vector<std::string> CvarTable::names() const {
    std::vector<std::string> names;
    for (const auto& [name, entry] : m_entries)
        names.push_back(name);
    return names;
}

} // namespace q3rt
