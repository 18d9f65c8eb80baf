#include "base/user_cache.hpp"

#include <cstdlib>

namespace q3rt {

std::filesystem::path userCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "q3rt";
    if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "q3rt";
    return {};
}

} // namespace q3rt
