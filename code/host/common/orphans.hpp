#pragma once
// What runs leave that were killed: files and folders named after their process.

#include <filesystem>
#include <string>
#include <vector>

namespace q3rt {

/// PREFIX and the number of this process, to which more may be added.
std::string nameOfProcess(const std::string& prefix);
/// Those so named in the folder whose processes are gone.
std::vector<std::filesystem::path> listOrphans(const std::filesystem::path& folder, const std::string& prefix);

} // namespace q3rt
