#pragma once
// What the engine's console says to whoever started it.

#include <filesystem>
#include <string>
#include <vector>

#include "host/common/session.hpp"

namespace q3rt {

std::string readConsole(const std::filesystem::path& file);
/// About the engine's end, without ornaments; empty: nothing.
std::string findLastError(const std::string& console);
/// What there is to say of settings that the user gave: lines of the renderer that begin with such a name; and the
/// settings that nobody has declared, if the console has the engine's list of cvars (kWatchCvars).
std::vector<std::string> listComplaints(const std::string& console, const CvarList& settings);

} // namespace q3rt
