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
/// What there is to say of settings that the user gave: lines of the renderer that begin with such a name.
std::vector<std::string> listComplaints(const std::string& console, const CvarList& settings);
/// The settings that nobody has declared, by the interposer's list of cvars (WatchMessage::kCvars).
std::vector<std::string> listUndeclared(const std::string& cvars, const CvarList& settings);

} // namespace q3rt
