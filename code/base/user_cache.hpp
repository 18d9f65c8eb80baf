#pragma once
// The folder of everything that can be made again: ${XDG_CACHE_HOME:-~/.cache}/q3rt. scripts/lavapipe.sh has the same
// rule.

#include <filesystem>

namespace q3rt {

/// Empty if neither XDG_CACHE_HOME nor HOME is set. Doesn't make it.
std::filesystem::path userCacheFolder();

} // namespace q3rt
