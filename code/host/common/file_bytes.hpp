#pragma once
// Whole files in and out, for the program's commands. Errors name the file and the system's reason.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace q3rt {

std::vector<std::byte> readFileBytes(const std::filesystem::path& path);
/// All at once (host/common/output_file.hpp): nobody ever sees half a file. Makes missing folders.
void writeFileBytes(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace q3rt
