#include "host/trade/reference.hpp"

#include <cstdio>
#include <span>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/image.hpp"
#include "host/common/file_bytes.hpp"
#include "host/trade/points.hpp"

namespace q3rt {

namespace fs = std::filesystem;

namespace {

/// The lines below what a picture depends on.
std::string describeOutcome(const ReferencePicture& reference) {
    return formatText("made of %d frames\nerror %.9g\n", reference.frames, reference.error.value_or(-1));
}

bool parseOutcome(const std::string& text, ReferencePicture& reference) {
    double error = 0;
    if (std::sscanf(text.c_str(), "made of %d frames\nerror %lf", &reference.frames, &error) != 2) return false;
    if (error >= 0) reference.error = error;
    return true;
}

} // namespace

fs::path ReferenceCache::pathOf(const std::string& dependsOn, const char* extension) const {
    return m_folder / (hashText(dependsOn) + extension);
}

std::optional<ReferencePicture> ReferenceCache::load(const std::string& dependsOn, const PictureSize& size) const {
    const fs::path picturePath = pathOf(dependsOn, ".png"), textPath = pathOf(dependsOn, ".txt");
    std::error_code error;
    if (!fs::exists(picturePath, error) || !fs::exists(textPath, error)) return std::nullopt;
    const std::vector<std::byte> bytes = readFileBytes(textPath);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    ReferencePicture reference;
    if (!text.starts_with(dependsOn) || !parseOutcome(text.substr(dependsOn.size()), reference)) return std::nullopt;
    try {
        const Image image = decodeImage(readFileBytes(picturePath), picturePath.string());
        if (image.width != size.width || image.height != size.height) return std::nullopt;
        reference.picture = {image.width, image.height, {}};
        std::vector<uint8_t>& rgb = reference.picture.rgb;
        rgb.reserve(image.rgba.size() / 4 * 3);
        for (size_t i = 0; i < image.rgba.size(); i += 4)
            rgb.insert(rgb.end(), &image.rgba[i], &image.rgba[i] + 3);
        return reference;
    } catch (const ContentError& damage) {
        logLine(LogLevel::Warning, "%s; the reference is made again", damage.what());
        return std::nullopt;
    }
}

void ReferenceCache::store(const std::string& dependsOn, const ReferencePicture& reference) const {
    const std::string text = dependsOn + describeOutcome(reference);
    writePng(pathOf(dependsOn, ".png"), reference.picture);
    writeFileBytes(pathOf(dependsOn, ".txt"), std::as_bytes(std::span(text)));
}

} // namespace q3rt
