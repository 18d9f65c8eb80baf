#pragma once
// The engine's cvars as a module sees them: C structs whose addresses stay valid, flags with the engine's meaning.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "abi/ref_types.h"

namespace q3rt {

class CvarTable {
  public:
    CvarTable();
    ~CvarTable();
    CvarTable(const CvarTable&) = delete;
    CvarTable& operator=(const CvarTable&) = delete;

    /// What Cvar_Get does: finds or makes it, sets its reset value, lets a latched value become current.
    cvar_t* get(std::string_view name, std::string_view defaultValue, int flags);
    /// What Cvar_Set does for a renderer: read-only cvars may be set, latched ones wait for the next get().
    void set(std::string_view name, std::string_view value);
    /// The host's own choice: in force at once and for every later get(), whatever the flags.
    void preset(std::string_view name, std::string_view value);
    void setRange(cvar_t* cvar, float minimum, float maximum, bool integral);
    void describe(cvar_t* cvar, std::string_view text);
    /// Null if there is none.
    cvar_t* find(std::string_view name) const;
    std::string value(std::string_view name) const;
    /// Why the value last given to it is not in force: nobody declared it, or its range refused the value; else "".
    std::string complaint(std::string_view name) const;
    /// Of all cvars, in lower case and in their order.
    std::vector<std::string> names() const;

  private:
    struct Entry;
    void assign(Entry& entry, std::string value);
    std::map<std::string, std::unique_ptr<Entry>> m_entries; ///< by lower-case name
};

} // namespace q3rt
