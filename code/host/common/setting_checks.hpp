#pragma once
// Mistakes in --set and --axis. A setting that does nothing, or not what was asked, would make every figure of the run
// a lie: such a run ends as bad arguments do. What the engine and the game know is not known before they run, so in
// their runs only our renderers' settings are checked beforehand; of others the engine is asked (engine_process.cpp).

#include "host/common/session.hpp"
#include "host/headless/cvar_table.hpp"

namespace q3rt {

/// What is wrong with the value of a text setting of ours, whichever renderer runs: --set and --axis ask it at once,
/// for of words the table of cvars knows nothing. Empty: nothing, or it is no such setting.
std::string complainOfText(const std::string& name, const std::string& value);
/// Once the renderer has declared its own: throws CLI::ValidationError for the first setting that it doesn't have, or
/// whose value it doesn't take.
void requireSettings(const CvarTable& cvars, const CvarList& settings);
/// Before any renderer runs: the same for settings of our renderers and for names that could only be theirs (rt_...).
/// Returns the others, which only the engine and the game may know.
CvarList requireKnownSettings(const CvarList& settings);

} // namespace q3rt
