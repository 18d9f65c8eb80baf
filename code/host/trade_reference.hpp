#pragma once
// Reference pictures in q3rt's cache folder: a PNG file each, named by the hash of a text that says all that the
// picture depends on, with that text beside it.

#include <filesystem>
#include <optional>
#include <string>

#include "host/session.hpp"

namespace q3rt {

class ReferenceCache {
  public:
    explicit ReferenceCache(std::filesystem::path folder)
        : m_folder(std::move(folder)) {}
    /// Nullopt if there is none for exactly this text, of this size.
    std::optional<HostFrame> load(const std::string& dependsOn, const PictureSize& size) const;
    void store(const std::string& dependsOn, const HostFrame& picture) const;

  private:
    std::filesystem::path pathOf(const std::string& dependsOn, const char* extension) const;
    std::filesystem::path m_folder;
};

} // namespace q3rt
