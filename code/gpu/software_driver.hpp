#pragma once
// The software driver with ray tracing that scripts/lavapipe.sh unpacks into the user's cache, where the Vulkan loader
// would not look by itself.

#include <filesystem>

namespace q3rt {

/// Its ICD file; empty if it was never fetched.
std::filesystem::path findFetchedDriver();

/// The environment variable that names drivers for the Vulkan loader; null if none does.
const char* variableNamingDrivers();

/// Offers the fetched driver to the loader beside the machine's own ones, unless the environment names drivers: whoever
/// chose is obeyed. Changes this process's environment, so it comes before anything asks the loader (SDL does too).
void offerFetchedDriver();

} // namespace q3rt
