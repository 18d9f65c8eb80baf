#pragma once
// Where content comes from: the engine's file system, or the headless host's own search path.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace q3rt {

class FileSource {
  public:
    virtual ~FileSource() = default;
    /// Whole file by game path ("textures/a/b.tga", any case), or nullopt if no archive or folder has it.
    virtual std::optional<std::vector<std::byte>> read(std::string_view name) = 0;
    /// Names (without `directory`) that end in `extension`, highest-priority archive first, archive order inside.
    virtual std::vector<std::string> list(std::string_view directory, std::string_view extension) = 0;
};

} // namespace q3rt
