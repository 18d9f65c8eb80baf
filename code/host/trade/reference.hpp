#pragma once
// Reference pictures in q3rt's cache folder: a PNG file each, named by the hash of a text that says all that the
// picture depends on, with that text beside it, and below it how the picture came out.

#include <filesystem>
#include <optional>
#include <string>

#include "host/common/session.hpp"

namespace q3rt {

struct ReferencePicture {
    HostFrame picture;
    int frames = 0; ///< that it is the mean of
    /// 1 - SSIM to what more frames would make of it, as the renderer says; nothing: it doesn't.
    std::optional<double> error;
};

class ReferenceCache {
  public:
    explicit ReferenceCache(std::filesystem::path folder)
        : m_folder(std::move(folder)) {}
    /// Nullopt if there is none for exactly this text, of this size.
    std::optional<ReferencePicture> load(const std::string& dependsOn, const PictureSize& size) const;
    void store(const std::string& dependsOn, const ReferencePicture& reference) const;

  private:
    std::filesystem::path pathOf(const std::string& dependsOn, const char* extension) const;
    std::filesystem::path m_folder;
};

} // namespace q3rt
