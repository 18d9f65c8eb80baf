#include "gpu/software_driver.hpp"

#include <cstdlib>

#include "base/user_cache.hpp"

namespace q3rt {

std::filesystem::path findFetchedDriver() {
    const std::filesystem::path cache = userCacheFolder();
    if (cache.empty()) return {};
    std::filesystem::path icd = std::filesystem::absolute(cache / "lavapipe" / "lvp_icd.json");
    std::error_code ignored;
    return std::filesystem::exists(icd, ignored) ? icd : std::filesystem::path();
}

const char* variableNamingDrivers() {
    // VK_ICD_FILENAMES is the older name of VK_DRIVER_FILES.
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"})
        if (const char* value = std::getenv(name); value && *value) return name;
    return nullptr;
}

void offerFetchedDriver() {
    if (variableNamingDrivers()) return;
    const std::filesystem::path icd = findFetchedDriver();
    if (!icd.empty()) setenv("VK_ADD_DRIVER_FILES", icd.c_str(), 1);
}

} // namespace q3rt
